// Inertia by Gauss points of a reconstructed density: mass kept, linear density exact, free fall.
#include "transfer/density.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <memory>
#include <random>

#include "transfer/explicit_transfer.h"
#include "transfer/mass.h"
#include "transfer/reconstruction.h"
#include "transfer/unit_grids.h"

namespace wisp {
namespace {

using namespace transfer_test;

constexpr int n = 5;  // cells a side, of side 1

std::vector<std::unique_ptr<Space<2>>> spaces() {
  std::vector<std::unique_ptr<Space<2>>> list;
  list.push_back(squares(n, LinearOptions{})), list.push_back(squares(n, BSplineOptions{}));
  list.push_back(triangles(n, LinearOptions{}, 2)), list.push_back(triangles(n, PowellSabinOptions{}, 2));
  return list;
}

double density_at(const Vec<2>& x) { return 1.0 + 0.1 * x[0] + 0.2 * x[1]; }

/// m x m points a cell, on a lattice or at random, with equal volumes and the mass of `density_at`.
std::vector<Body<2>> bodies_on(const Space<2>& space, int m, bool random_places) {
  std::vector<Body<2>> bodies;
  bodies.push_back({"body", {}, make_material<2>(AnyLaw(LinearElastic{}))});
  auto& points = bodies[0].points;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0.01, 0.99);
  for (int k = 0; k < n * n * m * m; ++k) {
    const int cell = k / (m * m), q = k % (m * m);
    Vec<2> x((q % m + 0.5) / m, (q / m + 0.5) / m);
    if (random_places) x = Vec<2>((q % m + share(random)) / m, (q / m + share(random)) / m);
    x += Vec<2>(cell % n, cell / n);
    points.position.push_back(x), points.volume.push_back(1.0 / (m * m));
    points.mass.push_back(density_at(x) / (m * m)), points.velocity.push_back(Vec<2>::Zero());
    points.deformation_gradient.push_back(Mat<2>::Identity());
    MultiIndex<2> c(cell % n, cell / n);
    points.cell.push_back(space.structured() ? space.window().cell_index(c)
                                             : space.triangulation().locate(x));
    std::get<MaterialStates<LinearElastic, 2>>(bodies[0].material).old.push_back({});
  }
  return bodies;
}

struct Masses {
  BlockMatrix points{1}, field{1};
  Masses(const Space<2>& space, const std::vector<Body<2>>& bodies) {
    const ActiveCells cells = active_cells(space, bodies);
    points.begin_pattern(space.n_functions());
    add_point_pattern(space, bodies, points);
    add_density_pattern(space, bodies, cells, points);
    points.end_pattern();
    add_consistent_mass(space, bodies, points);
    field.share_pattern(points);
    field.add_matrix(1.0, points);
    exchange_mass(space, bodies, cells, field);
  }
};

std::vector<double> row_sums(const BlockMatrix& m) {
  std::vector<double> sums(static_cast<std::size_t>(m.n_local()));
  m.row_sums(sums);
  return sums;
}

double total(const std::vector<double>& list) {
  double sum = 0.0;
  for (const double v : list) sum += v;
  return sum;
}

TEST(ReconstructedDensity, KeepsTheMassWhateverThePoints) {
  for (const auto& space : spaces()) {
    const auto bodies = bodies_on(*space, 4, true);
    const Masses masses(*space, bodies);
    EXPECT_NEAR(total(row_sums(masses.field)), total(bodies[0].points.mass), 1e-12 * n * n * 10);
    double change = 0.0;
    for (std::size_t k = 0; k < masses.field.values().size(); ++k)
      change = std::max(change, std::abs(masses.field.values()[k] - masses.points.values()[k]));
    EXPECT_GT(change, 1e-3) << "cells are filled";
  }
}

TEST(ReconstructedDensity, IntegratesALinearDensityExactly) {
  // Hats on squares of side 1: the integrals of phi_i^2 and phi_i phi_{i+1} are 4/9 and 1/9, and a linear
  // density has the value of their middle. Lattices have the volume and the centroid of their cell.
  const auto space = squares(n, LinearOptions{});
  const auto bodies = bodies_on(*space, 2, false);
  const Masses masses(*space, bodies);
  for (int j = 1; j < n - 1; ++j)
    for (int i = 1; i < n - 1; ++i) {
      const int a = space->window().node_index({i, j}), b = space->window().node_index({i + 1, j});
      if (i == n - 2) continue;
      EXPECT_NEAR(masses.field.entry(a, 0, a, 0), 4.0 / 9.0 * density_at(Vec<2>(i, j)), 1e-13);
      EXPECT_NEAR(masses.field.entry(a, 0, b, 0), 1.0 / 9.0 * density_at(Vec<2>(i + 0.5, j)), 1e-13);
      EXPECT_GT(std::abs(masses.points.entry(a, 0, a, 0) - masses.field.entry(a, 0, a, 0)), 0.01)
          << "which the points by themselves do not manage";
    }
}

TEST(ReconstructedDensity, GivesFreeFallWithItsWeight) {
  const Vec<2> g(0.7, -9.81);
  for (const auto& space : spaces()) {
    const auto bodies = bodies_on(*space, 4, true);
    const Masses masses(*space, bodies);
    const ActiveCells cells = active_cells(*space, bodies);
    std::vector<double> sums(static_cast<std::size_t>(space->n_functions() * sums_stride<2>), 0.0);
    points_to_grid<2>(*space, bodies[0], Gather::both, g, false, sums);
    exchange_weight<2>(*space, bodies, cells, g, sums);
    const auto mass = row_sums(masses.field);  // M times one
    for (std::size_t i = 0; i < mass.size(); ++i)
      for (int d = 0; d < 2; ++d)
        ASSERT_NEAR(sums[i * sums_stride<2> + 3 + static_cast<std::size_t>(d)], mass[i] * g[d], 1e-12);
  }
}

TEST(ReconstructedDensity, PointsTakeTheMomentumOfTheGrid) {
  // Any acceleration of the functions: the points' increments with the balance have the momenta of
  // M a, with M of the reconstructed density.
  const double dt = 0.1;
  std::mt19937 random(8);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (const auto& space : spaces()) {
    auto bodies = bodies_on(*space, 4, true);
    const Masses masses(*space, bodies);
    const auto functions = static_cast<std::size_t>(space->n_functions());
    std::vector<double> motion(functions * motion_stride<2>, 0.0), a(functions * 2), inertia(functions * 2);
    for (std::size_t k = 0; k < a.size(); ++k)
      a[k] = motion[k / 2 * motion_stride<2> + 2 + k % 2] = any(random);
    masses.field.multiply_columns(a, inertia, 2);
    balance_momentum<2>(*space, bodies, active_cells(*space, bodies), motion, dt);
    Vec<2> expected = Vec<2>::Zero(), found = Vec<2>::Zero();
    double moment = 0.0, found_moment = 0.0;
    for (std::size_t i = 0; i < functions; ++i) {
      const Vec<2> f(inertia[2 * i], inertia[2 * i + 1]), x = space->node_position(static_cast<int>(i));
      expected += dt * f, moment += dt * (x[0] * f[1] - x[1] * f[0]);
    }
    const auto& points = bodies[0].points;
    double correction = 0.0;
    std::visit(
        [&](const auto& basis) {
          for (std::size_t p = 0; p < points.position.size(); ++p) {
            Vec<2> v = points.velocity[p];
            correction = std::max(correction, v.norm());
            const Vec<2>& x = points.position[p];
            basis.tabulate(x, Vec<2>::Zero()).for_each([&](int, int i, double phi, const Vec<2>&) {
              v += dt * phi *
                   Vec<2>(a[static_cast<std::size_t>(2 * i)], a[static_cast<std::size_t>(2 * i + 1)]);
            });
            found += points.mass[p] * v, found_moment += points.mass[p] * (x[0] * v[1] - x[1] * v[0]);
          }
        },
        space->basis());
    EXPECT_LT((found - expected).norm(), 1e-12);
    EXPECT_NEAR(found_moment, moment, 1e-11);
    EXPECT_GT(correction, 1e-6);
    EXPECT_LT(correction, 0.05 * dt) << "of increments up to dt";
  }
}

TEST(ReconstructedDensity, PointsTakeTheMomentumOfTheGridInSpace) {
  const double dt = 0.1;
  std::array<std::vector<double>, 3> lines;
  for (auto& line : lines) line = {0.0, 1.0, 2.0, 3.0};
  const StructuredGrid<3> grid(lines);
  const Space<3> space(grid, BoxPartition<3>(grid.cells()), AnyBasisOptions(LinearOptions{}));
  std::mt19937 random(8);
  std::uniform_real_distribution<double> any(-1.0, 1.0), share(0.01, 0.99);
  std::vector<Body<3>> bodies;
  bodies.push_back({"body", {}, make_material<3>(AnyLaw(LinearElastic{}))});
  auto& points = bodies[0].points;
  for (int k = 0; k < 27 * 27; ++k) {
    const int cell = k / 27;
    const MultiIndex<3> c(cell % 3, cell / 3 % 3, cell / 9);
    points.position.push_back(c.cast<double>() + Vec<3>(share(random), share(random), share(random)));
    points.volume.push_back(1.0 / 27), points.mass.push_back(1.0 + 0.2 * any(random));
    points.velocity.push_back(Vec<3>::Zero()), points.deformation_gradient.push_back(Mat<3>::Identity());
    points.cell.push_back(space.window().cell_index(c));
    std::get<MaterialStates<LinearElastic, 3>>(bodies[0].material).old.push_back({});
  }
  const ActiveCells cells = active_cells(space, bodies);
  BlockMatrix mass{1};
  mass.begin_pattern(space.n_functions());
  add_point_pattern(space, bodies, mass);
  mass.end_pattern();
  add_consistent_mass(space, bodies, mass);
  exchange_mass(space, bodies, cells, mass);
  const auto functions = static_cast<std::size_t>(space.n_functions());
  std::vector<double> motion(functions * motion_stride<3>, 0.0), a(functions * 3), inertia(functions * 3);
  for (std::size_t k = 0; k < a.size(); ++k)
    a[k] = motion[k / 3 * motion_stride<3> + 3 + k % 3] = any(random);
  mass.multiply_columns(a, inertia, 3);
  balance_momentum<3>(space, bodies, cells, motion, dt);
  Vec<3> expected = Vec<3>::Zero(), moment = Vec<3>::Zero(), found = Vec<3>::Zero(), spin = Vec<3>::Zero();
  for (std::size_t i = 0; i < functions; ++i) {
    const Vec<3> f(inertia[3 * i], inertia[3 * i + 1], inertia[3 * i + 2]);
    expected += dt * f, moment += dt * space.node_position(static_cast<int>(i)).cross(f);
  }
  std::visit(
      [&](const auto& basis) {
        if constexpr (!std::decay_t<decltype(basis)>::uses_domains)
          for (std::size_t p = 0; p < points.position.size(); ++p) {
            Vec<3> v = points.velocity[p];
            basis.tabulate(points.position[p], Vec<3>::Zero())
                .for_each([&](int, int i, double phi, const Vec<3>&) {
                  for (int d = 0; d < 3; ++d) v[d] += dt * phi * a[static_cast<std::size_t>(3 * i + d)];
                });
            found += points.mass[p] * v, spin += points.mass[p] * points.position[p].cross(v);
          }
      },
      space.basis());
  EXPECT_GT(points.velocity[0].norm(), 1e-6);
  EXPECT_LT((found - expected).norm(), 1e-10);
  EXPECT_LT((spin - moment).norm(), 1e-9);
}

TEST(Reconstruction, KeepsTrianglesThatLosePointsOnTheirEdges) {
  // 8 x 8 points a block of two triangles lie on the diagonal too. Whichever side they fall on, the same
  // triangles count as filled, so that no force jumps.
  const auto space = triangles(n, PowellSabinOptions{}, 2);
  std::vector<int> smoothed;
  for (const double shift : {1e-9, -1e-9}) {
    auto bodies = bodies_on(*space, 4, false);
    auto& points = bodies[0].points;
    for (std::size_t p = 0; p < points.position.size(); ++p) {
      points.position[p] += Vec<2>(shift, -shift);
      points.volume[p] *= 0.999;  // a little compressed
      points.cell[p] = space->triangulation().locate(points.position[p]);
    }
    const std::vector<double> velocity(static_cast<std::size_t>(2 * space->n_functions()), 0.0);
    std::vector<double> gradients;
    smooth_gradients<2>(*space, bodies, 0, active_cells(*space, bodies), velocity, 2, gradients);
    smoothed.push_back(0);
    for (std::size_t p = 0; p < points.position.size(); ++p) smoothed.back() += !std::isnan(gradients[4 * p]);
    int least = 100;
    std::vector<int> number(static_cast<std::size_t>(space->n_cells()), 0);
    for (const int c : points.cell) ++number[static_cast<std::size_t>(c)];
    for (const int k : number) least = std::min(least, k);
    EXPECT_EQ(least, 6) << "of 8, three quarters";
  }
  EXPECT_EQ(smoothed[0], smoothed[1]);
  EXPECT_EQ(smoothed[0], n * n * 16) << "the body fills the grid";
}

}  // namespace
}  // namespace wisp
