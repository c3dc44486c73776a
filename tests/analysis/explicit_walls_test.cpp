// Walls in explicit steps: forces and motions with known answers, momentum, what a wall admits.
#include <numbers>

#include "analysis/fixtures.h"
#include "core/error.h"

namespace wisp {
namespace {

using namespace analysis_test;

constexpr double E = 1e5, rho = 1000.0, g = 10.0, h = 0.1;

enum class Kind { linear, gimp, triangles, splines };

/// A square of `cells` cells on a straight wall, turned by `degrees`; its points are sampled in the grid's
/// cells, so level with the grid they reach down to the wall if that is at a half of a cell.
ModelOptions on_wall(Kind kind, double degrees, double y = 0.53, int cells = 3) {
  auto o = on_grid<2>({0, 0}, {1.6, 1.6}, {16, 16}, kind == Kind::gimp);
  if (kind > Kind::gimp) {
    TriangleBlocksOptions blocks;
    blocks.lower = {0, 0}, blocks.upper = {1.6, 1.6};
    blocks.cells.assign(2, kind == Kind::splines ? 8 : 16);  // of splines a vertex has three
    blocks.split = BlockSplit::two;
    o.triangulation = blocks;
    if (kind == Kind::splines) o.basis = PowellSabinOptions{};
  }
  const double a = degrees * std::numbers::pi / 180.0, side = cells * h;
  const Vec<2> along(std::cos(a), std::sin(a)), up(-std::sin(a), std::cos(a)), foot(0.6, y);
  Polygon square;
  for (const auto& [s, t] : {std::pair{0.0, 0.0}, {side, 0.0}, {side, side}, {0.0, side}}) {
    const Vec<2> x = foot + s * along + t * up;
    square.vertices.push_back({x[0], x[1]});
  }
  BodyOptions body;
  body.label = "block";
  body.shape = square;
  body.material = LinearElastic{rho, E, 0.3};
  o.bodies.push_back(body);
  WallOptions wall;
  wall.label = "wall";
  wall.shape = PlaneWall{{foot[0], foot[1]}, {up[0], up[1]}};
  wall.unilateral = true;
  o.boundaries.push_back(wall);
  return o;
}
WallOptions& wall_of(ModelOptions& o) { return std::get<WallOptions>(o.boundaries[0]); }

double mass_of(const Model<2>& model) {
  double m = 0.0;
  for_each_point(model, [&](const auto& body, std::size_t p) { m += body.points.mass[p]; });
  return m;
}

struct Scheme {
  Kind kind;
  StressUpdate update;
  MassKind mass;
};
std::string scheme_name(const testing::TestParamInfo<Scheme>& info) {
  const auto& s = info.param;
  constexpr const char* kinds[] = {"Linear", "Gimp", "Triangles", "Splines"};
  return std::string(kinds[static_cast<std::size_t>(s.kind)]) +
         (s.update == StressUpdate::usl    ? "Usl"
          : s.update == StressUpdate::musl ? "Musl"
                                           : "Usf") +
         (s.mass == MassKind::lumped ? "Lumped" : "Ghost");
}

class Walls : public testing::TestWithParam<Scheme> {
 protected:
  /// Steps; checks after each that the momentum is that of gravity's and the walls' impulses.
  template <class F>
  void run(ModelOptions o, double duration, F&& watch, double damping = 0.0) {
    const Scheme& s = GetParam();
    const Mass mass = apply(s.mass, o);
    Model<2> model(o);
    // A wave crosses triangles along their height.
    const double share = s.kind == Kind::triangles ? 0.15 : 0.3;
    const double dt = share * h / std::sqrt(1.35 * E / rho);
    ExplicitOptions options = explicit_steps(dt, mass, s.update, VelocityUpdate::flip);
    options.damping = damping;
    Explicit<2> analysis(model, options);
    Vec<2> expected = momentum(model);
    double size = 0.0;
    const double m = mass_of(model);
    while (model.time < duration) {
      const Vec<2> weight = m * model.gravity(model.time);
      analysis.step(dt);
      for (const auto& r : model.reactions) expected += dt * r;
      expected += dt * weight;
      size = std::max(size, expected.norm());
      if (damping == 0.0) {
        ASSERT_LE((momentum(model) - expected).norm(), 1e-12 * size) << model.time;
      }
      watch(model);
    }
  }
};

TEST_P(Walls, SlideWithoutFrictionAndNeverPull) {
  auto o = on_wall(GetParam().kind, 30.0);
  add_gravity(o, {0.0, -g});
  const Vec<2> along(std::cos(M_PI / 6), std::sin(M_PI / 6)), up(-along[1], along[0]);
  double speed = 0.0, time = 0.0;
  run(o, 0.1, [&](const Model<2>& model) {
    ASSERT_GE(model.reactions[0].dot(up), 0.0);
    ASSERT_NEAR(model.reactions[0].dot(along), 0.0, 1e-9 * mass_of(model) * g);
    speed = momentum(model).dot(along) / mass_of(model), time = model.time;
  });
  EXPECT_NEAR(speed, -0.5 * g * time, 1e-10);
}

TEST_P(Walls, FrictionStaysInCoulombsCone) {
  auto o = on_wall(GetParam().kind, 30.0);
  wall_of(o).friction = 0.2;
  add_gravity(o, {0.0, -g});
  const Vec<2> along(std::cos(M_PI / 6), std::sin(M_PI / 6)), up(-along[1], along[0]);
  double normal = 0.0, tangential = 0.0;
  run(o, 0.1, [&](const Model<2>& model) {
    const double n = model.reactions[0].dot(up), t = model.reactions[0].dot(along);
    ASSERT_LE(std::abs(t), 0.2 * n + 1e-9 * mass_of(model) * g);
    normal += n, tangential += t;
  });
  EXPECT_NEAR(tangential / normal, 0.2, 0.01);  // it slides nearly all the time
}

TEST_P(Walls, CarryTheWeightAtRest) {
  auto o = on_wall(GetParam().kind, 0.0, 0.55);
  add_gravity(o, {0.0, -g}, ramp());
  o.gravity->factor.times = {0.0, 0.1};
  double force = 0.0;
  int steps = 0;
  run(o, 0.6, [&](const Model<2>& model) {
    if (model.time > 0.2) force += model.reactions[0][1] / (mass_of(model) * g), ++steps;
  });
  EXPECT_NEAR(force / steps, 1.0, 0.01);
}

TEST_P(Walls, WhichHoldStopTheMaterial) {
  for (const WallKind kind : {WallKind::fixed, WallKind::tangential}) {
    auto o = on_wall(GetParam().kind, 0.0, 0.55);
    wall_of(o).kind = kind, wall_of(o).unilateral = false;
    o.bodies[0].velocity = {0.05, 0.0};
    double least = 0.05;
    run(o, 0.3, [&](const Model<2>& model) { least = std::min(least, momentum(model)[0] / mass_of(model)); });
    // Held it sways back. A stop along the wall alone turns it: of a rigid square's speed the impulse takes
    // 0.4, of an elastic one's up to twice that; more where the functions at the wall reach up two thirds of
    // the square, as those of the splines do, and so turn it less.
    const double bound = GetParam().kind == Kind::splines ? 0.0 : 0.15 * 0.05;
    EXPECT_LT(least, kind == WallKind::fixed ? 0.0 : 0.6 * 0.05) << choice_name(kind);
    EXPECT_GT(least, kind == WallKind::fixed ? -0.05 : bound) << choice_name(kind);
  }
}

TEST_P(Walls, ThatMovePushTheBodyAlong) {
  auto o = on_wall(GetParam().kind, 0.0, 0.55);
  RigidMotionOptions motion;
  motion.velocity = {Curve(0.0), Curve(0.2)};
  wall_of(o).motion = motion;
  double work = 0.0, last = 0.0;
  run(o, 0.6, [&](const Model<2>& model) {
    last = momentum(model)[1] / mass_of(model);
    work = model.external_work - 0.5 * mass_of(model) * last * last;
  });
  EXPECT_GT(last, 0.2);  // it leaves the wall by its elasticity
  EXPECT_LT(last, 0.4);
  EXPECT_GT(work, 0.0);  // what is left vibrates
}

TEST_P(Walls, ThatHoldAMovingRollerKeepTheBodyAtIt) {
  auto o = on_wall(GetParam().kind, 0.0, 0.55);
  wall_of(o).unilateral = false;
  RigidMotionOptions motion;
  motion.velocity = {Curve(0.0), Curve(-0.2)};  // away from the body: it has to pull
  wall_of(o).motion = motion;
  double mean = 0.0;
  run(
      o, 1.0, [&](const Model<2>& model) { mean = momentum(model)[1] / mass_of(model); }, 0.0);
  EXPECT_LT(mean, -0.05);
}

INSTANTIATE_TEST_SUITE_P(Explicit, Walls,
                         testing::Values(Scheme{Kind::gimp, StressUpdate::musl, MassKind::lumped},
                                         Scheme{Kind::gimp, StressUpdate::usl, MassKind::lumped},
                                         Scheme{Kind::linear, StressUpdate::usl, MassKind::lumped},
                                         Scheme{Kind::linear, StressUpdate::musl, MassKind::lumped},
                                         Scheme{Kind::gimp, StressUpdate::usf, MassKind::lumped},
                                         Scheme{Kind::gimp, StressUpdate::musl, MassKind::ghost},
                                         Scheme{Kind::triangles, StressUpdate::usl, MassKind::lumped},
                                         Scheme{Kind::triangles, StressUpdate::musl, MassKind::lumped},
                                         Scheme{Kind::splines, StressUpdate::usl, MassKind::lumped},
                                         Scheme{Kind::splines, StressUpdate::musl, MassKind::lumped},
                                         Scheme{Kind::splines, StressUpdate::usf, MassKind::lumped},
                                         Scheme{Kind::triangles, StressUpdate::musl, MassKind::ghost}),
                         scheme_name);

TEST(Walls3D, ABallSlidesInABowlOfPlanes) {
  auto o = on_grid<3>({0, 0, 0}, {0.8, 0.8, 0.8}, {8, 8, 8}, true);
  BodyOptions body;
  body.label = "ball", body.shape = Ball{{0.4, 0.4, 0.35}, 0.15}, body.material = LinearElastic{rho, E, 0.3};
  o.bodies.push_back(body);
  for (const double side : {-1.0, 1.0}) {
    WallOptions wall;
    wall.label = side < 0 ? "left" : "right";
    // Two planes through the ball's lowest points, turned by 45 degrees: a groove along y.
    wall.shape = PlaneWall{{0.4, 0.4, 0.35 - 0.15 * std::sqrt(2.0)}, {side, 0.0, 1.0}};
    wall.unilateral = true;
    o.boundaries.push_back(wall);
  }
  add_gravity(o, {0.0, 0.0, -g});
  Model<3> model(o);
  const double dt = 0.3 * h / std::sqrt(1.35 * E / rho);
  ExplicitOptions options = explicit_steps(dt, Mass::lumped, StressUpdate::musl, VelocityUpdate::flip);
  Explicit<3> run(model, options);
  double m = 0.0;
  for (const double p : model.bodies[0].points.mass) m += p;
  Vec<3> impulse = Vec<3>::Zero(), walls = Vec<3>::Zero();
  for (int k = 0; k < 120; ++k) {
    run.step(dt);
    for (const auto& r : model.reactions) walls += dt * r;
    impulse += dt * m * Vec<3>(0, 0, -g);
  }
  EXPECT_LE((momentum(model) - impulse - walls).norm(), 1e-12 * impulse.norm());
  EXPECT_GT(walls[2], 0.5 * -impulse[2]);
  EXPECT_NEAR(walls[0], 0.0, 1e-6 * walls[2]);  // the groove is symmetric
  EXPECT_NEAR(walls[1], 0.0, 1e-9 * walls[2]);  // and smooth along y
}

TEST(Walls3D, OutsideTheGridAreRefused) {
  auto o = on_wall(Kind::gimp, 0.0);
  wall_of(o).shape = PolylineWall{{{-2, -1}, {-1, -1}}};
  EXPECT_THROW(
      {
        Model<2> model(o);
        Explicit<2> run(model, ExplicitOptions{});
      },
      InputError);
}

/// With steps above the critical one points leave the grid in mid-step: the run must say so, not read beyond
/// it.
TEST(WallsOfARunThatBreaksUp, StopWithOneLine) {
  for (const StressUpdate update : {StressUpdate::usl, StressUpdate::musl})
    for (const double number : {1.2, 1.5, 2.0, 3.0}) {
      auto o = on_wall(Kind::gimp, 30.0);
      o.bodies[0].velocity = {0.0, -0.2};
      add_gravity(o, {0.0, -g});
      const Mass mass = apply(MassKind::lumped, o);
      Model<2> model(o);
      const double dt = number * h / std::sqrt(1.35 * E / rho);
      Explicit<2> analysis(model, explicit_steps(dt, mass, update, VelocityUpdate::flip));
      EXPECT_THROW(for (int k = 0; k < 2000; ++k) analysis.step(dt), RunError) << number;
    }
}

}  // namespace
}  // namespace wisp
