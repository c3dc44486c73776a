// Quasi-static analyses against exact solutions: patches, columns, initial stress, reactions.
#include "analysis/fixtures.h"

namespace wisp {
namespace {

using namespace analysis_test;

QuasiStaticOptions load_steps(int steps, double tolerance = 1e-10) {
  QuasiStaticOptions q;
  q.steps = steps, q.tolerance = tolerance, q.max_iterations = 20;
  return q;
}

/// A block on rollers, pulled at x = 1 by a dead traction.
template <int dim>
ModelOptions pulled_block(const AnyLaw& law, bool gimp, double traction) {
  auto o = on_grid<dim>(Vec<dim>::Zero(), Vec<dim>::Constant(1.5), MultiIndex<dim>::Constant(6), gimp);
  add_box<dim>(o, Vec<dim>::Zero(), Vec<dim>::Ones(), law);
  hold(o, "x", 0.0, "x"), hold(o, "y", 0.0, "y");
  if (dim == 3) hold(o, "z", 0.0, "z");
  TractionOptions t;
  t.label = "pull", t.body = "body 0", t.traction.assign(dim, 0.0), t.traction[0] = traction;
  t.factor = ramp();
  if (dim == 2)
    t.corner = {1, 0}, t.edges = {{0, 1}}, t.points = {8};
  else
    t.corner = {1, 0, 0}, t.edges = {{0, 1, 0}, {0, 0, 1}}, t.points = {8, 8};
  o.loads.push_back(t);
  return o;
}

template <int dim>
void patch_is_uniform(bool gimp, bool ghost) {
  const double E = 1000.0, nu = 0.3, p = 200.0;
  auto o = pulled_block<dim>(Hencky{1.0, E, nu}, gimp, p);
  if (ghost) o.stabilisation = GhostOptions{};
  Model<dim> model(o);
  Implicit<dim> run(model, load_steps(1));
  run.step(1.0);
  // tau_xx = E' eps = p exp(eps): the traction is per initial area, tau = P F^T.
  const double stiffness = dim == 2 ? E / (1 - nu * nu) : E;
  double eps = 0.0;
  for (int k = 0; k < 100; ++k) eps = p * std::exp(eps) / stiffness;
  const double lateral = dim == 2 ? -nu / (1 - nu) * eps : -nu * eps;
  Sym<dim> tau = Sym<dim>::Zero();
  tau[0] = stiffness * eps;
  if (dim == 2) tau[2] = nu * tau[0];
  EXPECT_LT(stress_error(model, [&](const auto&, std::size_t) { return tau; }), 1e-6 * tau[0])
      << dim << gimp << ghost;
  for_each_point(model, [&](const auto& body, std::size_t k) {
    const Vec<dim> start = body.points.position[k] - body.points.displacement[k];
    ASSERT_NEAR(body.points.displacement[k][0], (std::exp(eps) - 1) * start[0], 1e-8);
    ASSERT_NEAR(body.points.displacement[k][1], (std::exp(lateral) - 1) * start[1], 1e-8);
    if (gimp) {
      ASSERT_NEAR(body.points.half_length[k][0], 0.0625 * std::exp(eps), 1e-9);
      ASSERT_NEAR(body.points.half_length[k][1], 0.0625 * std::exp(lateral), 1e-9);
    }
  });
  EXPECT_NEAR(model.reactions[0][0], -p, 1e-7 * p);
  EXPECT_NEAR(model.reactions[1][1], 0.0, 1e-7 * p);
}

TEST(PatchTest, TractionGivesUniformFiniteStrain) {
  for (const bool gimp : {false, true})
    for (const bool ghost : {false, true}) patch_is_uniform<2>(gimp, ghost);
  patch_is_uniform<3>(false, false);
  patch_is_uniform<3>(true, true);
}

TEST(PatchTest, PrescribedDisplacementGivesUniformStress) {
  auto o = on_grid<2>({0, 0}, {1, 1}, {4, 4}, false);
  add_box<2>(o, {0, 0}, {1, 1}, Hencky{1.0, 1000.0, 0.25});
  hold(o, "x", 0.0, "x"), hold(o, "y", 0.0, "y"), hold(o, "y", 1.0, "y");
  hold(o, "x", 1.0, "x").displacement = ramp(-0.1);
  Model<2> model(o);
  Implicit<2> run(model, load_steps(1));
  EnergyRecord record;
  run.step(1.0, &record);
  const double eps = std::log(0.9), lambda = 400.0, mu = 400.0;
  const Sym<2> tau(eps * (lambda + 2 * mu), eps * lambda, eps * lambda, 0.0);
  EXPECT_LT(stress_error(model, [&](const auto&, std::size_t) { return tau; }), 1e-6);
  EXPECT_NEAR(model.reactions[3][0], tau[0] / 0.9, 1e-6)
      << "Kirchhoff stress over stretch is force per initial area";
  EXPECT_NEAR(model.reactions[0][0], -tau[0] / 0.9, 1e-6);
  EXPECT_NEAR(record.strain, 0.5 * (lambda + 2 * mu) * eps * eps, 1e-8);
}

/// The column of Coombs 2023, section 5.4: 50 m high under its own weight.
struct ColumnResult {
  double top, stress;
  ImplicitRecord last;
};
ColumnResult column(int n, int steps) {
  const double E = 1e4, rho = 80.0, g = 10.0, height = 50.0, h = height / n;
  auto o = on_grid<2>({0, 0}, {h, height + h}, {1, n + 1}, true);
  add_box<2>(o, {0, 0}, {h, height}, Hencky{rho, E, 0.0});
  hold(o, "x", 0.0, "x"), hold(o, "x", h, "x"), hold(o, "y", 0.0, "y");
  add_gravity(o, {0.0, -g}, ramp());
  Model<2> model(o);
  Implicit<2> run(model, load_steps(steps, 1e-8));
  ColumnResult result{0.0, 0.0, {}};
  for (int k = 0; k < steps; ++k) result.last = run.step(1.0 / steps);
  EXPECT_NEAR(model.reactions[2][1], rho * g * height * h, 1e-6 * rho * g * height * h)
      << "the ground carries the weight";
  double top = 0.0, volume = 0.0;
  for_each_point(model, [&](const auto& body, std::size_t p) {
    const auto& points = body.points;
    const double start = points.position[p][1] - points.displacement[p][1];
    const double sigma = stress_of(body, p)[1] / points.deformation_gradient[p].determinant();
    result.stress += std::abs(sigma + rho * g * (height - start)) * points.volume[p],
        volume += points.volume[p];
    EXPECT_NEAR(points.half_length[p][1], 0.25 * h * points.deformation_gradient[p](1, 1), 1e-12)
        << "domains follow";
    if (start > top)
      top = start,
      result.top = points.displacement[p][1] + (points.deformation_gradient[p](1, 1) - 1) * 0.25 * h;
  });
  result.stress /= rho * g * height * volume;
  return result;
}

TEST(HenckyColumn, ConvergesToTheExactSolution) {
  const double exact = -25.940354;  // (W(4) + W(4)^2/2) 12.5 - 50
  const auto coarse = column(8, 20), middle = column(16, 20), fine = column(32, 20);
  EXPECT_NEAR(fine.top, exact, 0.1);
  EXPECT_GT(order(coarse.stress, middle.stress), 0.9)
      << coarse.stress << " " << middle.stress << " " << fine.stress;
  EXPECT_GT(order(middle.stress, fine.stress), 0.9);
  EXPECT_GT(order(std::abs(coarse.top - exact), std::abs(middle.top - exact)), 0.9)
      << coarse.top << " " << middle.top << " " << fine.top;
  EXPECT_GT(order(std::abs(middle.top - exact), std::abs(fine.top - exact)), 0.9);
}

/// A wide block of soil between smooth walls, at rest under its K0 stress.
ModelOptions soil(const AnyLaw& law, bool gimp) {
  auto o = on_grid<2>({0, 0}, {2, 1.5}, {8, 6}, gimp);
  auto& body = add_box<2>(o, {0, 0}, {2, 1}, law);
  body.k0 = InitialK0{0.4, 1.0, 10.0};
  hold(o, "x", 0.0, "x"), hold(o, "x", 2.0, "x"), hold(o, "y", 0.0, "y");
  add_gravity(o, {0.0, -10.0});
  return o;
}

TEST(InitialStress, K0IsAtRestUnderItsGravity) {
  for (const bool gimp : {false, true})
    for (const AnyLaw& law : {AnyLaw(LinearElastic{2000.0, 1e6, 0.3}), AnyLaw(Hencky{2000.0, 1e6, 0.3}),
                              AnyLaw(VonMises{2000.0, 1e6, 0.3, 2e4, 0.0})}) {
      Model<2> model(soil(law, gimp));
      Implicit<2> run(model, load_steps(1));
      run.step(1.0);
      for_each_point(model, [&](const auto& body, std::size_t p) {
        ASSERT_LT(body.points.displacement[p].norm(), 1e-9);
      });
      EXPECT_NEAR(model.reactions[2][1], 2000.0 * 10.0 * 2.0, 1e-5);
      // Sums over 2 points a cell and direction see the linear pressure exactly.
      EXPECT_NEAR(model.reactions[0][0], 0.4 * 0.5 * 2000.0 * 10.0, 1e-5);
      EXPECT_NEAR(model.reactions[1][0], -0.4 * 0.5 * 2000.0 * 10.0, 1e-5);
    }
}

TEST(InitialStress, K0StaysAtRestInExplicitSteps) {
  for (const bool gimp : {false, true}) {
    Model<2> model(soil(Hencky{2000.0, 1e6, 0.3}, gimp));
    Explicit<2> run(model, explicit_steps(1e-3));
    for (int k = 0; k < 100; ++k) run.step(1e-3);
    for_each_point(
        model, [&](const auto& body, std::size_t p) { ASSERT_LT(body.points.velocity[p].norm(), 1e-10); });
    EXPECT_NEAR(model.reactions[2][1], 2000.0 * 10.0 * 2.0, 1e-5);
  }
}

TEST(Damping, LocalDampingComesToStatics) {
  const double rho = 1000.0, g = 10.0;
  for (const MassKind kind : {MassKind::lumped, MassKind::ghost}) {
    auto o = on_grid<2>({0, 0}, {0.25, 1.5}, {1, 6}, false);
    add_box<2>(o, {0, 0}, {0.25, 1}, LinearElastic{rho, 1e7, 0.0});
    hold(o, "x", 0.0, "x"), hold(o, "x", 0.25, "x"), hold(o, "y", 0.0, "y");
    add_gravity(o, {0.0, -g});
    const Mass mass = apply(kind, o);
    Model<2> model(o);
    auto options = explicit_steps(5e-4, mass);
    options.damping = 0.6;
    Explicit<2> run(model, options);
    EnergyRecord record;
    double most = 0.0;
    for (int k = 0; k < 800; ++k) run.step(5e-4, &record), most = std::max(most, record.grid_kinetic);
    // The grid comes to rest; points keep the part of their velocity that the grid does not see (FLIP).
    EXPECT_LT(record.grid_kinetic, 1e-9 * most);
    EXPECT_NEAR(model.reactions[2][1], rho * g * 0.25, 1e-3 * rho * g * 0.25);
    // In statics the two points of a cell share the stress of its middle.
    EXPECT_LT(stress_error(model,
                           [&](const auto& body, std::size_t p) {
                             const double y = body.points.position[p][1] - body.points.displacement[p][1];
                             const double middle = (std::floor(4.0 * y) + 0.5) / 4.0;
                             return Sym<2>(0.0, -rho * g * (1.0 - middle), 0.0, 0.0);
                           }),
              1e-3 * rho * g);
  }
}

TEST(PointLoads, AreCarriedByTheWall) {
  auto o = on_grid<2>({0, -1}, {3, 1}, {12, 8}, true);
  add_box<2>(o, {0, -0.25}, {2, 0.25}, Hencky{1.0, 1e5, 0.3});
  hold(o, "x", 0.0, "xy");
  PointLoadOptions load;
  load.label = "tip", load.body = "body 0", load.nearest = {{2.0, 0.1}, {2.0, -0.1}},
  load.force = {0.0, -40.0};
  load.factor = ramp();
  o.loads.push_back(load);
  o.stabilisation = GhostOptions{};
  Model<2> model(o);
  Implicit<2> run(model, load_steps(2));
  for (int k = 0; k < 2; ++k) {
    run.step(0.5);
    EXPECT_NEAR(model.reactions[0][1], 20.0 * (k + 1), 1e-6);
    EXPECT_NEAR(model.reactions[0][0], 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace wisp
