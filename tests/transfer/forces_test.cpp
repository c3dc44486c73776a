// Internal forces and stiffness: derivatives of the energy, objectivity, stored against on the fly.
#include <gtest/gtest.h>

#include "tensor/spectral.h"
#include "transfer/samples.h"

namespace wisp {
namespace {

using namespace transfer_test;

/// Calls f.template operator()<dim, width>(law) for every basis and law.
template <class F>
void for_each_basis_and_law(F&& f) {
  for_each_basis([&]<int dim, int width>() {
    for (const AnyLaw& law : {AnyLaw(sample_linear()), AnyLaw(sample_hencky()), AnyLaw(sample_von_mises())})
      f.template operator()<dim, width>(law);
  });
}

TEST(InternalForce, StoredIsOnTheFly) {
  for_each_basis_and_law([]<int dim, int width>(const AnyLaw& law) {
    auto s = scene<dim>(law, width);
    StoredStencils<dim> stencils;
    tabulate(*s.space, s.points(), stencils);
    std::vector<double> stored(s.n() * dim, 0.0), none(s.n() * dim, 0.0), sums(s.n() * sums_stride<dim>, 0.0);
    EXPECT_EQ(add_internal_force<dim>(stencils, s.body(), none, 0.1, stored), 0);
    points_to_grid<dim>(*s.space, s.body(), Gather::force, Vec<dim>::Zero(), false, sums);
    const double scale = largest(stored);
    ASSERT_GT(scale, 0.0);
    for (std::size_t i = 0; i < s.n(); ++i)
      for (std::size_t d = 0; d < dim; ++d)
        ASSERT_NEAR(stored[i * dim + d], -sums[i * sums_stride<dim> + 1 + dim + d], 1e-13 * scale);
  });
}

TEST(InternalForce, AnImplicitCommitIsAnExplicitUpdate) {
  for_each_basis_and_law([]<int dim, int width>(const AnyLaw& law) {
    auto s = scene<dim>(law, width), t = scene<dim>(law, width);
    const double dt = 0.5;
    const std::vector<double> u = Random(2).field(s.n() * dim, 0.01);
    StoredStencils<dim> stencils;
    tabulate(*s.space, s.points(), stencils);
    std::vector<double> force(u.size(), 0.0), motion(s.n() * motion_stride<dim>, 0.0);
    ASSERT_EQ(add_internal_force<dim>(stencils, s.body(), u, dt, force), 0);
    commit<dim>(stencils, s.body(), u);
    for (std::size_t i = 0; i < s.n(); ++i)
      for (std::size_t d = 0; d < dim; ++d) motion[i * motion_stride<dim> + d] = u[i * dim + d] / dt;
    PointUpdate update;
    update.dt = dt, update.velocity = update.move = update.strain = true, update.motion = motion;
    grid_to_points<dim>(*t.space, t.body(), update);
    const auto one = stresses(s.body()), two = stresses(t.body());
    for (std::size_t p = 0; p < one.size(); ++p) {
      ASSERT_LT((one[p] - two[p]).norm(), 1e-11);
      ASSERT_LT((s.points().position[p] - t.points().position[p]).norm(), 1e-14);
      ASSERT_LT((s.points().displacement[p] - t.points().displacement[p]).norm(), 1e-14);
      ASSERT_LT((s.points().deformation_gradient[p] - t.points().deformation_gradient[p]).norm(), 1e-13);
      if (width > 2) {
        ASSERT_LT((s.points().half_length[p] - t.points().half_length[p]).norm(), 1e-14);
      }
    }
  });
}

TEST(InternalForce, OfAStressThatHasFollowedAMotionIsThatOfTheImplicitStep) {
  for_each_basis_and_law([]<int dim, int width>(const AnyLaw& law) {
    auto s = scene<dim>(law, width), t = scene<dim>(law, width);
    const double dt = 0.5;
    const std::vector<double> v = Random(2).field(s.n() * dim, 0.1);
    std::vector<double> u(v), force(v.size(), 0.0), sums(s.n() * sums_stride<dim>, 0.0);
    for (double& x : u) x *= dt;
    StoredStencils<dim> stencils;
    tabulate(*s.space, s.points(), stencils);
    ASSERT_EQ(add_internal_force<dim>(stencils, s.body(), u, dt, force), 0);
    PointUpdate update;
    update.dt = dt, update.strain = true, update.domains = false, update.strain_velocity = v;
    grid_to_points<dim>(*t.space, t.body(), update);
    points_to_grid<dim>(*t.space, t.body(), Gather::both, Vec<dim>::Zero(), false, sums, {v, dt});
    for (std::size_t i = 0; i < s.n(); ++i)
      for (std::size_t d = 0; d < dim; ++d)
        ASSERT_NEAR(force[i * dim + d], -sums[i * sums_stride<dim> + 1 + dim + d], 1e-12 * largest(force));
  });
}

TEST(InternalForce, IsTheDerivativeOfTheStrainEnergy) {
  for_each_basis_and_law([]<int dim, int width>(const AnyLaw& law) {
    if (std::holds_alternative<VonMises>(law)) return;  // dissipates
    auto s = scene<dim>(law, width);
    StoredStencils<dim> stencils;
    tabulate(*s.space, s.points(), stencils);
    Random random(9);
    const std::vector<double> u = random.field(s.n() * dim, 0.02), du = random.field(s.n() * dim, 1.0);
    const auto energy_at = [&](double step, std::vector<double>& force) {
      std::vector<double> w(u);
      for (std::size_t k = 0; k < w.size(); ++k) w[k] += step * du[k];
      force.assign(u.size(), 0.0);
      EXPECT_EQ(add_internal_force<dim>(stencils, s.body(), w, 0.0, force), 0);
      return trial_energy(s.body());
    };
    std::vector<double> force, other;
    energy_at(0.0, force);
    const double h = 1e-5;
    const double difference = (energy_at(h, other) - energy_at(-h, other)) / (2 * h);
    EXPECT_NEAR(difference, dot(force, du), 1e-6 * std::sqrt(dot(force, force) * dot(du, du)));
  });
}

TEST(Stiffness, IsTheDerivativeOfTheInternalForce) {
  for_each_basis_and_law([]<int dim, int width>(const AnyLaw& law) {
    if (dim == 3 && width == 5 && !std::holds_alternative<VonMises>(law)) return;  // slow, nothing new
    auto s = scene<dim>(law, width);
    StoredStencils<dim> stencils;
    tabulate(*s.space, s.points(), stencils);
    Random random(10);
    const std::vector<double> u = random.field(s.n() * dim, 0.02), du = random.field(s.n() * dim, 1.0);
    const auto force_at = [&](double step) {
      std::vector<double> w(u), force(u.size(), 0.0);
      for (std::size_t k = 0; k < w.size(); ++k) w[k] += step * du[k];
      EXPECT_EQ(add_internal_force<dim>(stencils, s.body(), w, 0.0, force), 0);
      return force;
    };
    const double h = 1e-6;
    const std::vector<double> up = force_at(h), down = force_at(-h);
    force_at(0.0);  // leaves the trial states that the tangent belongs to
    BlockMatrix stiffness(dim);
    stiffness.begin_pattern(s.space->n_functions());
    add_point_pattern(*s.space, s.bodies, stiffness);
    stiffness.end_pattern();
    add_stiffness<dim>(stencils, s.body(), u, 0.0, stiffness);
    std::vector<double> product(u.size());
    stiffness.multiply(du, product);
    for (std::size_t k = 0; k < u.size(); ++k)
      ASSERT_NEAR((up[k] - down[k]) / (2 * h), product[k], 2e-6 * largest(product))
          << dim << "D, width " << width;
  });
}

TEST(Stiffness, VonMisesSampleYields) {
  // Without this the tests above would say nothing of plasticity.
  auto s = scene<3>(sample_von_mises(), 3);
  StoredStencils<3> stencils;
  tabulate(*s.space, s.points(), stencils);
  std::vector<double> force(s.n() * 3, 0.0);
  add_internal_force<3>(stencils, s.body(), Random(10).field(s.n() * 3, 0.02), 0.0, force);
  const auto& group = std::get<MaterialStates<VonMises, 3>>(s.body().material);
  int yielding = 0;
  for (std::size_t p = 0; p < group.now.size(); ++p)
    yielding += group.now[p].plastic_strain > group.old[p].plastic_strain;
  EXPECT_GT(yielding, s.points().size() / 4);
}

TEST(Objectivity, RigidMotionRotatesTheStress) {
  for_each_basis_and_law([]<int dim, int width>(const AnyLaw& law) {
    auto s = scene<dim>(law, width);
    StoredStencils<dim> stencils;
    tabulate(*s.space, s.points(), stencils);
    const bool finite = s.body().finite_strain();
    Mat<dim> rotation = Mat<dim>::Identity();
    if (finite) {
      const double angle = 1.1;
      rotation(0, 0) = rotation(1, 1) = std::cos(angle), rotation(1, 0) = std::sin(angle),
                  rotation(0, 1) = -std::sin(angle);
      if constexpr (dim == 3) {
        Mat<3> about_x = Mat<3>::Identity();
        about_x(1, 1) = about_x(2, 2) = std::cos(0.4), about_x(2, 1) = std::sin(0.4),
                   about_x(1, 2) = -std::sin(0.4);
        rotation = about_x * rotation;
      }
    }
    const Vec<dim> shift = Random(1).vector<dim>(3.0);
    const std::vector<double> u =
        s.at_nodes([&](const Vec<dim>& x) { return Vec<dim>(rotation * x - x + shift); });
    std::vector<double> force(u.size(), 0.0), still(u.size(), 0.0), none(u.size(), 0.0);
    add_internal_force<dim>(stencils, s.body(), none, 0.0, still);
    const double energy = trial_energy(s.body());
    ASSERT_EQ(add_internal_force<dim>(stencils, s.body(), u, 0.0, force), 0);
    EXPECT_NEAR(trial_energy(s.body()), energy, 1e-10 * energy);
    const auto before = stresses(s.body()), after = stresses(s.body(), true);
    for (std::size_t p = 0; p < before.size(); ++p)
      ASSERT_LT((after[p] - congruence<dim>(rotation, before[p])).norm(), 1e-10);
    for (std::size_t i = 0; i < s.n(); ++i) {
      const Eigen::Map<const Vec<dim>> f(force.data() + i * dim), f0(still.data() + i * dim);
      ASSERT_LT((f - rotation * f0).norm(), 1e-11 * largest(still));
    }
  });
}

TEST(Objectivity, InvertedPointsAreCountedAndCarryNoForce) {
  auto s = scene<2>(sample_hencky(), 2);
  StoredStencils<2> stencils;
  tabulate(*s.space, s.points(), stencils);
  const std::vector<double> u = s.at_nodes([](const Vec<2>& x) { return Vec<2>(-2.0 * x[0], 0.0); });
  std::vector<double> force(u.size(), 0.0);
  EXPECT_EQ(add_internal_force<2>(stencils, s.body(), u, 0.0, force), s.points().size());
  EXPECT_EQ(largest(force), 0.0);
}

TEST(Domains, FollowTheStretchNotTheRotation) {
  auto s = scene<2>(sample_hencky(), 3);
  auto& points = s.points();
  Mat<2> rotation, stretch;
  rotation << std::cos(0.7), -std::sin(0.7), std::sin(0.7), std::cos(0.7);
  stretch << 1.2, 0.1, 0.1, 0.8;
  for (auto& f : points.deformation_gradient) f = rotation * stretch;
  follow_stretch(s.body());
  for (std::size_t p = 0; p < points.half_length.size(); ++p) {
    EXPECT_NEAR(points.half_length[p][0], 1.2 * points.initial_half_length[p][0], 1e-14);
    EXPECT_NEAR(points.half_length[p][1], 0.8 * points.initial_half_length[p][1], 1e-14);
  }
}

}  // namespace
}  // namespace wisp
