// Mass, momentum and angular momentum through both maps; the mass matrix against its lumped form.
#include <gtest/gtest.h>

#include "transfer/active.h"
#include "transfer/samples.h"

namespace wisp {
namespace {

using namespace transfer_test;

/// x ^ y as an antisymmetric matrix: angular momentum in any dimension.
template <int dim>
Mat<dim> wedge(const Vec<dim>& x, const Vec<dim>& y) {
  return x * y.transpose() - y * x.transpose();
}

/// D = sum_i phi_i (x_i - x_p)(x_i - x_p)^T of a point.
template <int dim>
Mat<dim> moment(const Space<dim>& space, const Particles<dim>& points, std::size_t p) {
  Mat<dim> d = Mat<dim>::Zero();
  std::visit(
      [&](const auto& basis) {
        const Vec<dim> l = points.half_length.empty() ? Vec<dim>::Zero() : points.half_length[p];
        basis.tabulate(points.position[p], l).for_each([&](int, int i, double phi, const Vec<dim>&) {
          const Vec<dim> r = space.node_position(i) - points.position[p];
          d += phi * r * r.transpose();
        });
      },
      space.basis());
  return d;
}

template <int dim>
Mat<dim> angular_momentum(const Space<dim>& space, const Particles<dim>& points, bool affine) {
  Mat<dim> sum = Mat<dim>::Zero();
  for (std::size_t p = 0; p < points.mass.size(); ++p) {
    sum += points.mass[p] * wedge<dim>(points.position[p], points.velocity[p]);
    if (!affine) continue;
    const Mat<dim> b = points.affine[p] * moment(space, points, p);  // sum phi (C r) r^T
    sum += points.mass[p] * (b.transpose() - b);
  }
  return sum;
}

template <int dim>
struct Totals {
  double mass = 0.0;
  Vec<dim> momentum = Vec<dim>::Zero(), force = Vec<dim>::Zero();
  Mat<dim> angular = Mat<dim>::Zero(), moment = Mat<dim>::Zero();
};

template <int dim>
Totals<dim> totals(const Space<dim>& space, std::span<const double> sums) {
  Totals<dim> t;
  for (int i = 0; i < space.n_functions(); ++i) {
    const double* const s = sums.data() + i * sums_stride<dim>;
    const Vec<dim> p = Eigen::Map<const Vec<dim>>(s + 1), f = Eigen::Map<const Vec<dim>>(s + 1 + dim);
    t.mass += s[0], t.momentum += p, t.force += f;
    t.angular += wedge<dim>(space.node_position(i), p), t.moment += wedge<dim>(space.node_position(i), f);
  }
  return t;
}

TEST(PointsToGrid, KeepsMassMomentumAndTotalForce) {
  for_each_basis([]<int dim, int width>() {
    auto s = scene<dim>(sample_hencky(), width);
    const Vec<dim> g = Random(3).vector<dim>(10.0);
    std::vector<double> sums(s.n() * sums_stride<dim>, 0.0);
    points_to_grid<dim>(*s.space, s.body(), Gather::both, g, false, sums);
    const Totals<dim> t = totals<dim>(*s.space, sums);
    double mass = 0.0;
    Vec<dim> momentum = Vec<dim>::Zero(), first = Vec<dim>::Zero();
    for (std::size_t p = 0; p < s.points().mass.size(); ++p) {
      mass += s.points().mass[p], momentum += s.points().mass[p] * s.points().velocity[p];
      first += s.points().mass[p] * s.points().position[p];
    }
    EXPECT_NEAR(t.mass, mass, 1e-13 * mass);
    EXPECT_LT((t.momentum - momentum).norm(), 1e-13 * mass);
    EXPECT_LT((t.force - mass * g).norm(), 1e-12 * mass) << "internal forces must sum to zero";
    EXPECT_LT((t.angular - angular_momentum<dim>(*s.space, s.points(), false)).norm(), 1e-11 * mass);
    EXPECT_LT((t.moment - wedge<dim>(first, g)).norm(), 1e-11 * mass) << "and have no moment";
    // Inertia and forces apart are the same as both at once.
    std::vector<double> apart(sums.size(), 0.0);
    points_to_grid<dim>(*s.space, s.body(), Gather::inertia, g, false, apart);
    points_to_grid<dim>(*s.space, s.body(), Gather::force, g, false, apart);
    for (std::size_t k = 0; k < sums.size(); ++k) ASSERT_NEAR(apart[k], sums[k], 1e-14 * largest(sums));
  });
}

TEST(GridToPoints, ApicKeepsMomentumAndAngularMomentum) {
  for_each_basis([]<int dim, int width>() {
    auto s = scene<dim>(sample_hencky(), width);
    auto& points = s.points();
    Random random(4);
    points.affine.resize(points.position.size());
    for (auto& c : points.affine) c = random.matrix<dim>(3.0);
    std::vector<double> sums(s.n() * sums_stride<dim>, 0.0), motion(s.n() * motion_stride<dim>, 0.0);
    points_to_grid<dim>(*s.space, s.body(), Gather::inertia, Vec<dim>::Zero(), true, sums);
    const Totals<dim> t = totals<dim>(*s.space, sums);
    const Mat<dim> before = angular_momentum<dim>(*s.space, points, true);
    EXPECT_LT((t.angular - before).norm(), 1e-12 * before.norm());
    for (std::size_t i = 0; i < s.n(); ++i)
      if (sums[i * sums_stride<dim>] > 0)
        for (std::size_t d = 0; d < dim; ++d)
          motion[i * motion_stride<dim> + d] =
              sums[i * sums_stride<dim> + 1 + d] / sums[i * sums_stride<dim>];
    PointUpdate update;
    update.dt = 0.1, update.velocity = true, update.flip = 0.0, update.apic = true, update.motion = motion;
    grid_to_points<dim>(*s.space, s.body(), update);
    Vec<dim> momentum = Vec<dim>::Zero();
    for (std::size_t p = 0; p < points.mass.size(); ++p) momentum += points.mass[p] * points.velocity[p];
    EXPECT_LT((momentum - t.momentum).norm(), 1e-12 * t.momentum.norm());
    const Mat<dim> after = angular_momentum<dim>(*s.space, points, true);
    EXPECT_LT((after - before).norm(), 1e-11 * before.norm()) << dim << "D, width " << width;
  });
}

TEST(GridToPoints, BlendsOfFlipAndPicGainWhatTheGridGained) {
  for_each_basis([]<int dim, int width>() {
    for (const double flip : {1.0, 0.97, 0.0}) {
      auto s = scene<dim>(sample_hencky(), width);
      auto& points = s.points();
      Random random(5);
      std::vector<double> sums(s.n() * sums_stride<dim>, 0.0), motion(s.n() * motion_stride<dim>, 0.0);
      points_to_grid<dim>(*s.space, s.body(), Gather::both, Vec<dim>::Zero(), false, sums);
      const double dt = 0.1;
      Vec<dim> start = Vec<dim>::Zero(), impulse = Vec<dim>::Zero(), end = Vec<dim>::Zero();
      for (std::size_t i = 0; i < s.n(); ++i) {
        const double mass = sums[i * sums_stride<dim>];
        if (mass <= 0) continue;
        for (std::size_t d = 0; d < dim; ++d) {
          const double a = random(20.0);
          motion[i * motion_stride<dim> + d] = sums[i * sums_stride<dim> + 1 + d] / mass + dt * a;
          motion[i * motion_stride<dim> + dim + d] = a;
          impulse[static_cast<int>(d)] += dt * mass * a;
        }
      }
      for (std::size_t p = 0; p < points.mass.size(); ++p) start += points.mass[p] * points.velocity[p];
      PointUpdate update;
      update.dt = dt, update.velocity = true, update.flip = flip, update.motion = motion;
      grid_to_points<dim>(*s.space, s.body(), update);
      for (std::size_t p = 0; p < points.mass.size(); ++p) end += points.mass[p] * points.velocity[p];
      EXPECT_LT((end - start - impulse).norm(), 1e-12 * (start.norm() + impulse.norm()));
    }
  });
}

TEST(GridToPoints, LinearFieldsArriveExactlyAtThePoints) {
  for_each_basis([]<int dim, int width>() {
    auto s = scene<dim>(sample_hencky(), width);
    auto& points = s.points();
    points.affine.assign(points.position.size(), Mat<dim>::Zero());
    Random random(6);
    const Vec<dim> v0 = random.vector<dim>(1.0);
    const Mat<dim> gradient = random.matrix<dim>(2.0);
    std::vector<double> motion(s.n() * motion_stride<dim>, 0.0);
    for (int i = 0; i < s.space->n_functions(); ++i)
      Eigen::Map<Vec<dim>>(motion.data() + i * motion_stride<dim>) =
          v0 + gradient * s.space->node_position(i);
    const auto start = points.position;
    PointUpdate update;
    update.dt = 1e-2, update.velocity = update.move = true, update.flip = 0.0, update.apic = true,
    update.motion = motion;
    grid_to_points<dim>(*s.space, s.body(), update);
    for (std::size_t p = 0; p < start.size(); ++p) {
      const Vec<dim> v = v0 + gradient * start[p];
      ASSERT_LT((points.velocity[p] - v).norm(), 1e-12);
      ASSERT_LT((points.position[p] - start[p] - 1e-2 * v).norm(), 1e-14);
      ASSERT_LT((points.affine[p] - gradient).norm(), 1e-10);
    }
  });
}

TEST(ConsistentMass, RowsSumToTheLumpedMassAndTheFormIsTheEnergy) {
  for_each_basis([]<int dim, int width>() {
    auto s = scene<dim>(sample_hencky(), width);
    BlockMatrix mass(1);
    mass.begin_pattern(s.space->n_functions());
    add_point_pattern(*s.space, s.bodies, mass);
    mass.end_pattern();
    add_consistent_mass(*s.space, s.bodies, mass);
    std::vector<double> sums(s.n() * sums_stride<dim>, 0.0), rows(s.n());
    points_to_grid<dim>(*s.space, s.body(), Gather::inertia, Vec<dim>::Zero(), false, sums);
    mass.row_sums(rows);
    for (std::size_t i = 0; i < s.n(); ++i)
      ASSERT_NEAR(rows[i], sums[i * sums_stride<dim>], 1e-13 * largest(rows));
    const std::vector<double> v = Random(8).field(s.n() * dim, 1.0);
    std::vector<double> mv(v.size());
    mass.multiply_columns(v, mv, dim);
    const double energy = grid_kinetic_energy<dim>(*s.space, s.body(), v, dim);
    EXPECT_NEAR(0.5 * dot(v, mv), energy, 1e-13 * energy);
  });
}

TEST(ActiveCells, AreThoseThatDomainsOverlap) {
  const StructuredGrid<2> grid(Vec<2>(0, 0), Vec<2>(5, 5), MultiIndex<2>(5, 5));
  for (const int width : {2, 3, 5}) {
    Space<2> space(grid, BoxPartition<2>(grid.cells()), width > 2);
    if (width > 2) space.set_width(width);
    const auto active = [&](const Vec<2>& x, double l) {
      std::vector<Body<2>> bodies(2);
      for (auto& body : bodies) body.material = make_material<2>(sample_hencky());
      bodies[1].points.position = {x};
      bodies[1].points.half_length = {Vec<2>(l, l)};
      const ActiveCells cells = active_cells(space, bodies);
      int n = 0, functions = 0;
      for (const int bits : cells.bits) n += bits == 2;
      for (const char f : active_functions(space, cells)) functions += f;
      return std::pair(n, functions);
    };
    EXPECT_EQ(active({2.5, 2.5}, 0.5), std::pair(1, 4));
    EXPECT_EQ(active({2.5 + 1e-14, 2.5}, 0.5), std::pair(1, 4));
    EXPECT_EQ(active({2.0, 2.5}, 0.0), std::pair(1, 4));
    EXPECT_EQ(active({0.0, 5.0}, 0.1), std::pair(1, 4));
    if (width > 2) {
      EXPECT_EQ(active({2.4, 2.5}, 0.5), std::pair(2, 6));
    }
    if (width > 2) {
      EXPECT_EQ(active({2.4, 2.6}, 0.5), std::pair(4, 9));
    }
    if (width > 2) {
      EXPECT_EQ(active({2.0, 2.5}, 0.25), std::pair(2, 6));
    }
    if (width == 5) {
      EXPECT_EQ(active({2.5, 2.5}, 1.5), std::pair(9, 16));
    }
    if (width == 5) {
      EXPECT_EQ(active({2.6, 2.5}, 1.5), std::pair(12, 20));
    }
    if (width == 2) {
      EXPECT_EQ(active({2.4, 2.6}, 0.5), std::pair(1, 4));
    }
  }
}

}  // namespace
}  // namespace wisp
