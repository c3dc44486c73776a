// Analyses on triangulations: patches, flight, conservation, turned grids, a vibrating bar.
#include <numbers>

#include "analysis/triangle_samples.h"
#include "core/error.h"

namespace wisp {
namespace {

using namespace analysis_test;

const Hencky soft{1000.0, 1e4, 0.3};

ModelOptions& add_rectangle(ModelOptions& o, const Vec<2>& lower, const Vec<2>& upper, const AnyLaw& law,
                            int points = 2) {
  add_box<2>(o, lower, upper, law, points);
  return o;
}

TEST(Triangles, PatchIsUniformOnAnIrregularTriangulation) {
  // The body fills the grid; n² even points integrate the gradients of functions up to degree 2 exactly.
  const double E = 1000.0, nu = 0.3, pull = 1e-3;
  for (const AnyBasisOptions& basis :
       {AnyBasisOptions(LinearOptions{}), AnyBasisOptions(LagrangeQuadraticOptions{})}) {
    auto o = on_triangles({0, 0}, {2, 1}, 0.3, basis);
    add_rectangle(o, {0, 0}, {2, 1}, LinearElastic{1.0, E, nu});
    hold_part(o, "side 4", "x"), hold(o, "y", 0.0, "y");
    hold_part(o, "side 2", "x").displacement = ramp(2.0 * pull);
    Model<2> model(o);
    QuasiStaticOptions q;
    q.steps = 1;
    Implicit<2> run(model, q);
    run.step(1.0);
    Sym<2> sigma = Sym<2>::Zero();
    sigma[0] = E / (1 - nu * nu) * pull, sigma[2] = nu * sigma[0];
    EXPECT_LT(stress_error(model, [&](const auto&, std::size_t) { return sigma; }), 1e-9 * sigma[0]);
    for_each_point(model, [&](const auto& body, std::size_t k) {
      const Vec<2> x = body.points.position[k] - body.points.displacement[k];
      ASSERT_NEAR(body.points.displacement[k][0], pull * x[0], 1e-12);
      ASSERT_NEAR(body.points.displacement[k][1], -nu / (1 - nu) * pull * x[1], 1e-12);
    });
    EXPECT_NEAR(model.reactions[0][0], -sigma[0], 1e-9 * sigma[0]);  // a height of 1
    EXPECT_NEAR(model.reactions[2][0], sigma[0], 1e-9 * sigma[0]);
  }
}

/// A body that fills the triangulation of an outline; nu = 0.3.
ModelOptions filled(const std::vector<std::vector<double>>& outline, const AnyBasisOptions& basis) {
  ModelOptions o;
  DelaunayOptions grid;
  grid.outline.vertices = outline;
  grid.spacing = 0.3;
  o.triangulation = grid;
  o.basis = basis;
  Polygon shape;
  shape.vertices = outline;
  BodyOptions body;
  body.label = "body", body.shape = shape, body.material = LinearElastic{1.0, 1000.0, 0.3};
  body.sampling.points_per_cell = 6;
  o.bodies.push_back(body);
  return o;
}

TEST(Triangles, SplinesAreHeldAlongOneSideOfACornerThatTurnsInwards) {
  // An L is pulled apart in y about the line y = 1, the side of its corner that holds y; the corner's other
  // side, on x = 1, holds x. The exact field is u = (-nu/(1 - nu) b (x - 1), b (y - 1)).
  const double nu = 0.3, b = 1e-3;
  PowellSabinOptions sides;
  sides.control_triangles = ControlTriangleRule::corner_sides;
  ModelOptions o = filled({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, sides);
  hold_part(o, "side 3", "y"), hold_part(o, "side 4", "x");
  hold_part(o, "side 1", "y").displacement = ramp(-b);
  hold_part(o, "side 5", "y").displacement = ramp(b);
  const auto largest_error = [&] {
    Model<2> model(o);
    QuasiStaticOptions q;
    q.steps = 1;
    Implicit<2> run(model, q);
    run.step(1.0);
    double worst = 0.0;
    for_each_point(model, [&](const auto& of, std::size_t k) {
      const Vec<2> u = of.points.displacement[k], x = of.points.position[k] - u;
      worst = std::max(worst, (u - Vec<2>(-nu / (1 - nu) * b * (x[0] - 1), b * (x[1] - 1))).norm());
    });
    return worst;
  };
  EXPECT_LT(largest_error(), 0.02 * b);  // what the sum over the points leaves
  sides.control_triangles = ControlTriangleRule::hull_edges;
  o.basis = sides;
  EXPECT_THROW(largest_error(), InputError);
}

/// A slab, 2 m wide, whose upper side is bent at its middle (1, 1 + rise): side 3 is the right half of it.
ModelOptions bent_slab(double rise, const AnyBasisOptions& basis) {
  return filled({{0, 0}, {2, 0}, {2, 1}, {1, 1 + rise}, {0, 1}}, basis);
}

TEST(Triangles, SplinesAreHeldAlongOneSideOfANearlyStraightKink) {
  // Hung up along one half of a side that is bent by 5.7 degrees outwards or inwards: the reaction is the
  // weight, and the held half stays where it is. Its other half is free.
  for (const AnyBasisOptions& basis :
       {AnyBasisOptions(LagrangeQuadraticOptions{}), AnyBasisOptions(PowellSabinOptions{}),
        AnyBasisOptions(PowellSabinCubicOptions{})}) {
    double straight = 0.0;
    for (const double rise : {0.0, 0.05, -0.05}) {
      auto o = bent_slab(rise, basis);
      hold_part(o, "side 3", "xy");
      add_gravity(o, {0.0, -1.0}, ramp());
      Model<2> model(o);
      QuasiStaticOptions q;
      q.steps = 1;
      Implicit<2> run(model, q);
      run.step(1.0);
      EXPECT_NEAR(model.reactions[0][1], 2.0 + rise, 1e-8);
      EXPECT_NEAR(model.reactions[0][0], 0.0, 1e-8);
      double far = 0.0, near = 0.0;
      for_each_point(model, [&](const auto& body, std::size_t k) {
        const Vec<2> u = body.points.displacement[k], x = body.points.position[k] - u;
        if (x[0] < 0.3) far = std::max(far, u.norm());
        if (x[0] > 1.1 && 1 + rise - rise * (x[0] - 1) - x[1] < 0.05) near = std::max(near, u.norm());
      });
      EXPECT_LT(near, 0.1 * far);
      if (rise == 0.0) straight = far;
      EXPECT_NEAR(far, straight, 0.1 * straight) << rise << ", basis " << basis.index();
    }
  }
  auto o = bent_slab(-0.3, PowellSabinOptions{});  // 33 degrees inwards
  hold_part(o, "side 3", "xy");
  EXPECT_THROW(Model<2>{o}, InputError);
}

TEST(Triangles, MotionThatVariesAlongTheBoundaryGivesTheLinearPatch) {
  // u = A x on a boundary with a kink of 5.7 degrees, all of it held, makes u = A x everywhere.
  Mat<2> a;
  a << 2e-3, -1e-3, 3e-3, 1e-3;
  for (const AnyBasisOptions& basis :
       {AnyBasisOptions(LinearOptions{}), AnyBasisOptions(LagrangeQuadraticOptions{}),
        AnyBasisOptions(PowellSabinOptions{}), AnyBasisOptions(PowellSabinCubicOptions{})}) {
    auto o = bent_slab(0.05, basis);
    o.bodies[0].sampling.points_per_cell = 8;
    for (int side = 1; side <= 5; ++side)
      for (int d = 0; d < 2; ++d) {
        auto& c = hold_part(o, "side " + std::to_string(side), d == 0 ? "x" : "y");
        c.label += d == 0 ? " x" : " y";
        c.displacement = ramp(), c.profile = {0.0, a(d, 0), a(d, 1)};
      }
    Model<2> model(o);
    QuasiStaticOptions q;
    q.steps = 1;
    Implicit<2> run(model, q);
    run.step(1.0);
    const bool by_points = std::holds_alternative<PowellSabinOptions>(basis) ||
                           std::holds_alternative<PowellSabinCubicOptions>(basis);
    double worst = 0.0;
    for_each_point(model, [&](const auto& body, std::size_t k) {
      const Vec<2> u = body.points.displacement[k];
      worst = std::max(worst, (u - a * (body.points.position[k] - u)).norm());
    });
    // The sum over points integrates constant gradients exactly, and linear ones of a lattice.
    EXPECT_LT(worst, by_points ? 2e-4 : 1e-11) << basis.index();
  }
}

TEST(Triangles, TractionBalancesOnEveryBasis) {
  // Reactions and resultants need no quadrature; splines fix their boundary functions.
  for (const auto& basis : triangle_bases()) {
    auto o = on_blocks({0, 0}, {2.5, 1}, 5, 2, basis);
    // points enough for the 21 functions of a cubic triangle, or it is soft
    add_rectangle(o, {0, 0}, {2, 1}, LinearElastic{1.0, 1000.0, 0.3}, 5);
    hold_part(o, "left", "xy");
    TractionOptions t;
    t.label = "pull", t.body = "body 0", t.traction = {0.3, -0.2};
    t.corner = {2, 0}, t.edges = {{0, 1}}, t.points = {12};
    o.loads.push_back(t);
    Model<2> model(o);
    QuasiStaticOptions q;
    q.steps = 1;
    Implicit<2> run(model, q);
    run.step(1.0);
    EXPECT_NEAR(model.reactions[0][0], -0.3, 1e-9) << basis.index();
    EXPECT_NEAR(model.reactions[0][1], 0.2, 1e-9) << basis.index();
    double near = 0.0, far = 0.0;
    for_each_point(model, [&](const auto& body, std::size_t k) {
      const auto& p = body.points;
      const double u = p.displacement[k].norm();
      far = std::max(far, u);
      if ((p.position[k] - p.displacement[k])[0] < 0.15) near = std::max(near, u);
    });
    // Held at the wall. Next to it the strain of bending, 6 x 0.4/E, times 0.15 is a sixteenth of the tip's
    // deflection, 0.2 x 32/E; shear adds a fifth of that.
    EXPECT_LT(near, 0.1 * far) << basis.index();
  }
}

ModelOptions flight(const AnyBasisOptions& basis, MassKind kind, int points) {
  auto o = on_triangles({-1.5, -1.5}, {1.5, 1.5}, 0.5, basis);
  add_rectangle(o, {-0.6, -0.5}, {0.5, 0.6}, soft, points);
  apply(kind, o);
  return o;
}

TEST(Triangles, TranslationIsExactAndStressFree) {
  for (const auto& basis : triangle_bases())
    for (const MassKind kind : {MassKind::lumped, MassKind::ghost}) {
      // A lumped mass of functions with negative parts can be negative.
      if (kind == MassKind::lumped && std::holds_alternative<LagrangeQuadraticOptions>(basis)) continue;
      auto o = flight(basis, kind, 3);
      const Vec<2> v(2.0, -1.3);
      o.bodies[0].velocity = {v[0], v[1]};
      Model<2> model(o);
      Explicit<2> run(model,
                      explicit_steps(1e-2, kind == MassKind::lumped ? Mass::lumped : Mass::consistent));
      for (int k = 0; k < 20; ++k) run.step(1e-2);
      for_each_point(model, [&](const auto& body, std::size_t p) {
        ASSERT_LT((body.points.displacement[p] - 0.2 * v).norm(), 1e-9) << basis.index();
        ASSERT_LT((body.points.velocity[p] - v).norm(), 1e-8) << basis.index();
        ASSERT_LT(stress_of(body, p).norm(), 1e-4) << basis.index();
      });
    }
}

TEST(Triangles, MomentumStaysWithGhostAndAngularMomentumToFirstOrder) {
  for (const auto& basis : triangle_bases()) {
    const auto lost = [&](double dt) {
      auto o = flight(basis, MassKind::ghost, 3);
      o.bodies[0].velocity = {0.5, 0.2};
      o.bodies[0].velocity_gradient = {{0.4, -3.0}, {3.0, -0.4}};
      Model<2> model(o);
      Explicit<2> run(model, explicit_steps(dt, Mass::consistent));
      const Vec<2> p = momentum(model);
      const Mat<2> l = angular_momentum(model);
      while (model.time < 0.04 - 0.5 * dt) run.step(dt);
      EXPECT_GT(stress_error(model, [](const auto&, std::size_t) { return Sym<2>(Sym<2>::Zero()); }), 10.0);
      return Vec<2>((momentum(model) - p).norm() / p.norm(), (angular_momentum(model) - l).norm() / l.norm());
    };
    const Vec<2> coarse = lost(4e-3), fine = lost(1e-3);
    EXPECT_LT(coarse[0], 1e-11) << basis.index();
    EXPECT_LT(fine[0], 1e-11) << basis.index();
    EXPECT_LT(coarse[1], 1e-3) << basis.index();
    EXPECT_LT(fine[1], std::max(0.5 * coarse[1], 1e-10)) << basis.index();
  }
}

/// A bar under gravity along its axis, with grid, shape and load turned by an angle; the points'
/// displacements turned back, in the order of ids.
std::vector<Vec<2>> turned_bar(double angle, const AnyBasisOptions& basis) {
  const double c = std::cos(angle), s = std::sin(angle);
  Mat<2> turn;
  turn << c, -s, s, c;
  ModelOptions o;
  DelaunayOptions grid;
  grid.outline = turned_rectangle({0, 0}, {2, 1}, angle);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> inside(0.05, 0.95);
  for (int k = 0; k < 30; ++k) {
    const double x = 2 * inside(random);
    const Vec<2> v = turn * Vec<2>(x, inside(random));
    grid.vertices.push_back({v[0], v[1]});
  }
  o.triangulation = grid;
  o.basis = basis;
  BodyOptions body;
  body.label = "bar", body.shape = grid.outline, body.material = soft;
  body.sampling.points_per_cell = 2;
  body.sampling.points_per_cell = 2;
  o.bodies.push_back(body);
  hold_part(o, "side 4", "xy");
  const Vec<2> g = turn * Vec<2>(3.0, -1.0);
  o.gravity = GravityOptions{{g[0], g[1]}, Curve(1.0)};
  Model<2> model(o);
  Explicit<2> run(model, explicit_steps(2e-4));
  for (int k = 0; k < 50; ++k) run.step(2e-4);
  std::vector<std::pair<Vec<2>, Vec<2>>> found;
  for_each_point(model, [&](const auto& b, std::size_t p) {
    found.push_back({turn.transpose() * (b.points.position[p] - b.points.displacement[p]),
                     turn.transpose() * b.points.displacement[p]});
  });
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return std::abs(a.first[0] - b.first[0]) > 1e-9 ? a.first[0] < b.first[0] : a.first[1] < b.first[1];
  });
  std::vector<Vec<2>> list;
  for (const auto& [x, u] : found) list.push_back(u);
  return list;
}

TEST(Triangles, TurnedGridsGiveTurnedResults) {
  for (const AnyBasisOptions& basis :
       {AnyBasisOptions(LinearOptions{}), AnyBasisOptions(PowellSabinOptions{})}) {
    const auto straight = turned_bar(0.0, basis), turned = turned_bar(0.7, basis);
    ASSERT_EQ(straight.size(), turned.size());
    double most = 0.0;
    for (std::size_t k = 0; k < straight.size(); ++k) {
      ASSERT_LT((straight[k] - turned[k]).norm(), 1e-11) << basis.index();
      most = std::max(most, straight[k].norm());
    }
    EXPECT_GT(most, 1e-5);
  }
}

TEST(Triangles, BarVibratesWithTheExactPeriod) {
  // Small axial motion of a bar between fixed ends, v = v0 sin(pi x / L): period 2 L / c. Linear functions
  // err by (k h)^2 / 24 at most, splines by the points as quadrature.
  const double E = 1e4, rho = 1000.0, L = 4.0, v0 = 1e-4, c = std::sqrt(E / rho);
  for (const AnyBasisOptions& basis :
       {AnyBasisOptions(LinearOptions{}), AnyBasisOptions(PowellSabinOptions{})}) {
    const bool smooth = !std::holds_alternative<LinearOptions>(basis);
    auto o = on_blocks({0, 0}, {L, 0.5}, 16, 2, basis);
    add_rectangle(o, {0, 0}, {L, 0.5}, LinearElastic{rho, E, 0.0}, smooth ? 5 : 3);
    hold_part(o, "left", "x"), hold_part(o, "right", "x"), hold_part(o, "top", "y"),
        hold_part(o, "bottom", "y");
    Model<2> model(o);
    for (auto& body : model.bodies)
      for (std::size_t p = 0; p < body.points.position.size(); ++p)
        body.points.velocity[p] = {v0 * std::sin(std::numbers::pi * body.points.position[p][0] / L), 0.0};
    const double dt = 2e-3;
    Explicit<2> run(model, explicit_steps(dt, Mass::consistent));
    std::vector<double> times, middle;
    while (model.time < 1.1 * L / c) {
      run.step(dt);
      double sum = 0.0;
      for (const auto& u : model.bodies[0].points.displacement) sum += u[0];
      times.push_back(model.time), middle.push_back(sum / static_cast<double>(model.bodies[0].points.size()));
    }
    const auto zeros = sign_changes(times, middle);
    ASSERT_EQ(zeros.size(), 1U) << basis.index();
    EXPECT_NEAR(zeros[0], L / c, 2e-3 * L / c) << basis.index();
  }
}

TEST(Triangles, WhatDoesNotFitIsAnInputError) {
  const auto fails = [](ModelOptions o) {
    try {
      const Model<2> model(o);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("(no error)");
  };
  auto o = on_blocks({0, 0}, {1, 1}, 2, 2);
  add_rectangle(o, {0, 0}, {1, 1}, soft);
  EXPECT_EQ(fails(o), "(no error)");
  auto wrong = o;
  wrong.basis = GimpOptions{};
  EXPECT_NE(fails(wrong).find("needs a structured grid"), std::string::npos);
  wrong = o;
  hold_part(wrong, "lefd", "x");
  EXPECT_NE(fails(wrong).find("did you mean 'left'?"), std::string::npos) << fails(wrong);
  wrong = o;
  hold(wrong, "x", 0.3, "x");
  EXPECT_NE(fails(wrong).find("no edge of a triangle lies on x = 0.3"), std::string::npos);
  wrong = o;
  wrong.bodies[0].shape = Box{{0.0, 0.0}, {1.5, 1.0}},
  wrong.bodies[0].sampling.method = SamplingMethod::divisions;
  wrong.bodies[0].sampling.divisions = {3, 2};
  EXPECT_NE(fails(wrong).find("lies outside the grid"), std::string::npos);
  wrong = o;
  wrong.basis = PowellSabinOptions{};
  pin(wrong, {0, 0}, "x");
  EXPECT_NE(fails(wrong).find("splines cannot be held at a single vertex"), std::string::npos);
  auto structured = on_grid<2>({0, 0}, {1, 1}, {2, 2}, false);
  structured.basis = PowellSabinOptions{};
  EXPECT_NE(fails(structured).find("needs a triangulation"), std::string::npos);
}

}  // namespace
}  // namespace wisp
