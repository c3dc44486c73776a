// Bodies that nothing holds: translation, rotation, collision.
#include "analysis/fixtures.h"
#include "geometry/ball.h"

namespace wisp {
namespace {

using namespace analysis_test;

template <int dim>
ModelOptions block_in_space(const AnyLaw& law, bool gimp) {
  auto o = on_grid<dim>(Vec<dim>::Constant(-2.0), Vec<dim>::Constant(2.0),
                        MultiIndex<dim>::Constant(dim == 2 ? 16 : 10), gimp);
  add_box<dim>(o, Vec<dim>::Constant(-0.5), Vec<dim>::Constant(0.5), law);
  return o;
}

const Hencky soft{1000.0, 1e4, 0.3};

TEST(FreeFlight, TranslationIsExactAndStressFree) {
  for (const bool gimp : {false, true})
    for (const MassKind kind : all_masses)
      for (const StressUpdate scheme : all_schemes)
        for (const VelocityUpdate update :
             {VelocityUpdate::flip, VelocityUpdate::pic, VelocityUpdate::apic}) {
          auto o = block_in_space<2>(soft, gimp);
          const Mass mass = apply(kind, o);
          const Vec<2> v(3.0, -1.7);
          o.bodies[0].velocity = {v[0], v[1]};
          Model<2> model(o);
          Explicit<2> run(model, explicit_steps(1e-2, mass, scheme, update));
          // Without Ghost no point may leave its cell: see `solvable`.
          if (!solvable(kind, gimp)) continue;
          const double dt = kind == MassKind::consistent ? 5e-4 : 1e-2;
          for (int k = 0; k < 30; ++k) run.step(dt);
          for_each_point(model, [&](const auto& body, std::size_t p) {
            ASSERT_LT((body.points.displacement[p] - 30 * dt * v).norm(), 1e-10) << static_cast<int>(kind);
            ASSERT_LT((body.points.velocity[p] - v).norm(), 1e-9);
            ASSERT_LT(stress_of(body, p).norm(), 1e-5);
          });
        }
}

/// Change of momentum and angular momentum, relative, of a block that spins, flies and deforms.
template <int dim>
Vec<2> momenta_lost(bool gimp, MassKind kind, StressUpdate scheme, double dt, double end,
                    bool updated_gradients = false, Integration integration = Integration::points) {
  auto o = block_in_space<dim>(soft, gimp);
  const Mass mass = apply(kind, o);
  o.bodies[0].velocity.assign(dim, 0.3);
  o.bodies[0].velocity_gradient.assign(dim, std::vector<double>(dim, 0.0));
  o.bodies[0].velocity_gradient[0][1] = -4.0, o.bodies[0].velocity_gradient[1][0] = 5.0;
  if (dim == 3) o.bodies[0].velocity_gradient[2][0] = 1.0;
  Model<dim> model(o);
  ExplicitOptions options = explicit_steps(dt, mass, scheme);
  options.updated_gradients = updated_gradients, options.integration = integration;
  Explicit<dim> run(model, options);
  const Vec<dim> p = momentum(model);
  const Mat<dim> l = angular_momentum(model);
  while (model.time < end - 0.5 * dt) run.step(dt);
  EXPECT_GT(stress_error(model, [](const auto&, std::size_t) { return Sym<dim>(Sym<dim>::Zero()); }), 10.0);
  return {(momentum(model) - p).norm() / p.norm(), (angular_momentum(model) - l).norm() / l.norm()};
}

TEST(FreeFlight, ConsistentMassAndFlipKeepBothMomenta) {
  // FLIP with the symmetric M moves points with the M-projection of their velocities: both momenta stay.
  for (const StressUpdate scheme : {StressUpdate::usf, StressUpdate::usl}) {
    const Vec<2> lost = momenta_lost<2>(false, MassKind::consistent, scheme, 1e-3, 0.02);
    EXPECT_LT(lost[0], 1e-11);
    EXPECT_LT(lost[1], 1e-11);
  }
  EXPECT_LT(momenta_lost<3>(false, MassKind::consistent, StressUpdate::usl, 1e-3, 0.01).maxCoeff(), 1e-11);
}

TEST(FreeFlight, UpdatedGradientsKeepTheMomentumAndAngularMomentumToFirstOrder) {
  // Forces in the moved coordinates have a moment about the points' positions, dt tau : (w x l) a step.
  const auto lost = [](double dt) {
    return momenta_lost<2>(false, MassKind::consistent, StressUpdate::usf, dt, 0.02, true);
  };
  const Vec<2> coarse = lost(1e-3), fine = lost(2.5e-4);
  EXPECT_LT(coarse[0], 1e-11);
  EXPECT_LT(fine[0], 1e-11);
  EXPECT_GT(coarse[1], 1e-9);
  EXPECT_LT(fine[1], 0.4 * coarse[1]);
}

TEST(FreeFlight, GhostMassKeepsTheMomentumAndAngularMomentumToFirstOrder) {
  // The points' own acceleration knows nothing of M_G, which leaves dt^2 w x M_G a a step.
  for (const bool gimp : {false, true}) {
    const Vec<2> coarse = momenta_lost<2>(gimp, MassKind::ghost, StressUpdate::usl, 4e-3, 0.4);
    const Vec<2> fine = momenta_lost<2>(gimp, MassKind::ghost, StressUpdate::usl, 1e-3, 0.4);
    EXPECT_LT(coarse[0], 1e-11);
    EXPECT_LT(fine[0], 1e-11);
    EXPECT_LT(coarse[1], 2e-4);
    EXPECT_LT(fine[1], 0.4 * coarse[1]);
    EXPECT_LT(momenta_lost<3>(gimp, MassKind::ghost, StressUpdate::usl, 5e-3, 0.1)[0], 1e-11);
  }
}

TEST(FreeFlight, TheProjectedStepKeepsBothMomentaWithGhost) {
  // It moves points by the (M + M_G)-projection of their velocities, and M_G does not feel linear fields.
  for (const bool gimp : {false, true}) {
    const Vec<2> lost = momenta_lost<2>(gimp, MassKind::ghost, StressUpdate::projected, 4e-3, 0.4);
    EXPECT_LT(lost[0], 1e-10);
    EXPECT_LT(lost[1], 1e-10);
  }
}

TEST(FreeFlight, TheReconstructedMassKeepsBothMomenta) {
  // Points take the rigid motion that the two masses differ by; of the 4 x 4 cells of the block those inside
  // are filled.
  const Vec<2> lost = momenta_lost<2>(false, MassKind::ghost, StressUpdate::projected, 2e-3, 0.1, false,
                                      Integration::reconstructed_mass);
  EXPECT_LT(lost[0], 1e-11);
  EXPECT_LT(lost[1], 1e-11);
}

TEST(FreeFlight, LumpedMassKeepsTheMomentum) {
  for (const StressUpdate scheme : all_schemes)
    for (const VelocityUpdate update : {VelocityUpdate::flip, VelocityUpdate::pic, VelocityUpdate::apic}) {
      auto o = block_in_space<2>(soft, true);
      o.bodies[0].velocity = {1.0, 0.5};
      o.bodies[0].velocity_gradient = {{1.0, -3.0}, {4.0, 0.0}};
      Model<2> model(o);
      Explicit<2> run(model, explicit_steps(5e-3, Mass::lumped, scheme, update));
      const Vec<2> p = momentum(model);
      for (int k = 0; k < 60; ++k) run.step(5e-3);
      EXPECT_LT((momentum(model) - p).norm(), 1e-12 * p.norm());
    }
}

TEST(FreeFlight, AStressedSpinIsCarriedRound) {
  // A stiff block turns once: every point comes back, and the stress is that of the spin, not of the turn.
  auto o = block_in_space<2>(Hencky{1000.0, 1e6, 0.3}, true);
  const Mass mass = apply(MassKind::ghost, o);
  const double omega = 2.0 * M_PI;
  o.bodies[0].velocity_gradient = {{0.0, -omega}, {omega, 0.0}};
  Model<2> model(o);
  const double dt = 1e-3;
  Explicit<2> run(model, explicit_steps(dt, mass));
  std::vector<Vec<2>> start(static_cast<std::size_t>(model.bodies[0].points.size()));
  for_each_point(model, [&](const auto& b, std::size_t p) {
    start[static_cast<std::size_t>(b.points.id[p])] = b.points.position[p];
  });
  for (int k = 0; k < 1000; ++k) run.step(dt);
  // Euler-Cromer's turn per step is exact to second order; centrifugal strain is rho omega^2 r^2 / E = 1e-2.
  for_each_point(model, [&](const auto& b, std::size_t p) {
    ASSERT_LT((b.points.position[p] - start[static_cast<std::size_t>(b.points.id[p])]).norm(), 0.02);
    ASSERT_LT(stress_of(b, p).norm(), 3.0 * 1000.0 * omega * omega * 0.5);
  });
}

TEST(FreeFlight, FreeFallGainsTheWorkOfGravity) {
  for (const MassKind kind : {MassKind::lumped, MassKind::ghost}) {
    auto o = block_in_space<2>(soft, true);
    const Mass mass = apply(kind, o);
    add_gravity(o, {0.0, -10.0});
    Model<2> model(o);
    Explicit<2> run(model, explicit_steps(2e-3, mass));
    EnergyRecord record;
    for (int k = 0; k < 100; ++k) run.step(2e-3, &record);
    const double m = total_mass(model), v = 10.0 * 0.2;
    EXPECT_NEAR(momentum(model)[1], -m * v, 1e-8 * m * v);
    EXPECT_NEAR(record.kinetic, 0.5 * m * v * v * 0.99 * 0.99, 1e-8 * m) << "start of the last step";
    EXPECT_NEAR(record.strain, 0.0, 1e-8 * m);
    EXPECT_NEAR(model.external_work, m * 10.0 * 10.0 * 2e-3 * 2e-3 * 5050.0, 1e-8 * m) << "force times path";
  }
}

TEST(Collision, OfTwoDiscsKeepsTheMomentumAndTurnsThemBack) {
  for (const MassKind kind : {MassKind::lumped, MassKind::ghost}) {
    auto o = on_grid<2>({0, 0}, {1, 1}, {20, 20}, true);
    const Mass mass = apply(kind, o);
    for (const double s : {-1.0, 1.0}) {
      BodyOptions disc;
      disc.label = s < 0 ? "left" : "right";
      disc.shape = Ball{{0.5 + 0.2 * s, 0.5 + 0.2 * s}, 0.2};
      disc.material = Hencky{1000.0, 1000.0, 0.3};
      disc.velocity = {-0.1 * s, -0.1 * s};
      o.bodies.push_back(disc);
    }
    Model<2> model(o);
    const double dt = 4e-3;
    Explicit<2> run(model, explicit_steps(dt, mass));
    const double m = 0.5 * total_mass(model);
    EnergyRecord first, record;
    run.step(dt, &first);
    double most = 0.0;
    for (int k = 1; k < 700; ++k) {
      run.step(dt, &record);
      most = std::max(most, record.strain);
      ASSERT_LT(momentum(model).norm(), 1e-10 * m) << k;
      ASSERT_LT(record.kinetic + record.strain, 1.02 * first.kinetic);
    }
    EXPECT_NEAR(first.kinetic, m * 0.02, 0.02 * 0.02 * m);
    EXPECT_GT(most, 0.3 * first.kinetic) << "they have met";
    EXPECT_LT(record.strain, 0.25 * first.kinetic) << "and parted";
    Vec<2> left = Vec<2>::Zero();
    const auto& points = model.bodies[0].points;
    for (std::size_t p = 0; p < points.mass.size(); ++p) left += points.mass[p] * points.velocity[p] / m;
    EXPECT_LT(left[0], -0.06);
    EXPECT_LT(left[1], -0.06);
  }
}

}  // namespace
}  // namespace wisp
