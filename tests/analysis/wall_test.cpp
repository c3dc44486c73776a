// Walls in quasi-static and dynamic steps: exact states at any angle, no creep, Newton's rate, reactions.
#include <gtest/gtest.h>

#include "analysis/turned_square.h"

namespace wisp {
namespace {
using namespace analysis_test;

ModelOptions square_on_grid(const AnyLaw& law, bool gimp) {
  ModelOptions o = on_grid<2>({-1.0, -0.5}, {1.4, 1.9}, {12, 12}, gimp);
  o.bodies.push_back(turned_square(law));
  return o;
}

TEST(Walls, AContainedSquareIsExact) {
  LinearElastic law;
  law.young_modulus = 1e6, law.poisson_ratio = 0.3, law.density = 1.0;
  ModelOptions o = square_on_grid(law, false);
  contain(o, 1e-3);
  Model<2> model(o);
  Implicit<2> analysis(model, QuasiStaticOptions{.steps = 4});
  const double modulus = law.p_wave_modulus();
  for (int k = 1; k <= 4; ++k) {
    analysis.step(analysis.time_step());
    const double force = modulus * 1e-3 * k / 4.0;
    // Exact in the first step; then the cut points have moved against the grid and integrate less exactly.
    const double tolerance = (k == 1 ? 1e-9 : 2e-3) * force;
    EXPECT_LT((model.reactions[3] + force * Vec<2>(cosine, sine)).norm(), tolerance) << "step " << k;
    EXPECT_LT((model.reactions[0] + model.reactions[3]).norm(), tolerance);
  }
}

/// Under a load that stays, a body that has come to rest stays: what walls carry is gathered. Otherwise every
/// step would let it slip by what carries the load, (3/4) delta of the strain at the wall.
TEST(Walls, NothingCreepsUnderASteadyLoad) {
  LinearElastic law;
  law.young_modulus = 1e6, law.poisson_ratio = 0.3, law.density = 1000.0;
  ModelOptions o = square_on_grid(law, false);
  add_wall(o, "support", {0, 1}, {0, 0}, WallKind::fixed).delta = 0.1;
  Curve factor;
  factor.times = {0.0, 0.1, 1.0}, factor.values = {0.0, 1.0, 1.0};
  add_gravity(o, {0.3, -1.0}, factor);
  Model<2> model(o);
  Implicit<2> analysis(model, QuasiStaticOptions{.steps = 10});
  std::vector<double> moved;  // mean of the points' displacement over a step
  Vec<2> last = Vec<2>::Zero();
  for (int k = 0; k < 10; ++k) {
    analysis.step(analysis.time_step());
    Vec<2> mean = Vec<2>::Zero();
    const auto& points = model.bodies[0].points;
    for (const auto& u : points.displacement) mean += u / static_cast<double>(points.size());
    moved.push_back((mean - last).norm());
    last = mean;
    EXPECT_LT((model.reactions[0] - Vec<2>(-300.0, 1000.0)).norm(), 1e-3 * 1000.0);
  }
  EXPECT_LT(moved.back(), 2e-3 * moved.front());
}

TEST(Walls, FiniteDeformationConvergesQuadratically) {
  Hencky law;
  law.young_modulus = 1e6, law.poisson_ratio = 0.3, law.density = 1000.0;
  ModelOptions o = square_on_grid(law, true);
  add_wall(o, "support", {0, 1}, {0, 0}, WallKind::fixed);
  add_wall(o, "press", {1, 0}, {1, 1}, WallKind::fixed).displacement = {ramp(0.1), ramp(0.05)};
  Model<2> model(o);
  QuasiStaticOptions stage;
  stage.steps = 2, stage.tolerance = 1e-9;
  Implicit<2> analysis(model, stage);
  for (int k = 0; k < 2; ++k) {
    const auto record = analysis.step(analysis.time_step());
    const auto& r = record.residuals;
    ASSERT_GE(r.size(), 3u);
    EXPECT_LE(record.iterations, 7);
    EXPECT_LT(r.back(), 1e-2 * r[r.size() - 2]);
  }
  EXPECT_LT((model.reactions[0] + model.reactions[1]).norm(), 1e-6 * model.reactions[0].norm());
}

TEST(Walls, ImplicitDynamicsFollowsAMovingWall) {
  LinearElastic law;
  law.young_modulus = 1e6, law.poisson_ratio = 0.3, law.density = 1000.0;
  ModelOptions o = square_on_grid(law, false);
  auto& wall = add_wall(o, "carrier", {0, 0}, {1, 0}, WallKind::fixed);
  wall.motion = RigidMotionOptions{};
  wall.motion->velocity = {Curve(0.1), Curve(0.0)};
  o.bodies[0].velocity = {0.1, 0.0};
  Model<2> model(o);
  ImplicitDynamicOptions stage;
  stage.duration = 0.2, stage.steps = 4;
  Implicit<2> analysis(model, stage);
  for (int k = 0; k < 4; ++k) analysis.step(analysis.time_step());
  // Both go on as they were: no force, and the points have moved by the wall's way.
  EXPECT_LT(model.reactions[0].norm(), 1e-5);
  for (const auto& u : model.bodies[0].points.displacement) EXPECT_LT((u - Vec<2>(0.02, 0.0)).norm(), 1e-9);
}

TEST(Walls, TheLiteralFormAsksForNoGhostTheConsistentOneDoes) {
  LinearElastic law;
  law.young_modulus = 1e6, law.poisson_ratio = 0.3, law.density = 1.0;
  std::vector<double> diagonal[2];
  for (const bool literal : {false, true}) {
    ModelOptions o = square_on_grid(law, false);
    contain(o, 1e-3);
    for (auto& b : o.boundaries) {
      auto& w = std::get<WallOptions>(b);
      w.mode = literal ? WallMode::literal : WallMode::consistent, w.delta = 0.01;
    }
    Model<2> model(o);
    Implicit<2> analysis(model, QuasiStaticOptions{.steps = 1});
    analysis.step(1.0);
    auto& d = diagonal[literal ? 1 : 0];
    d.resize(static_cast<std::size_t>(analysis.stiffness().n_local()) * 2);
    analysis.stiffness().diagonal(d);
  }
  double more = 0.0;
  for (std::size_t k = 0; k < diagonal[0].size(); ++k) more = std::max(more, diagonal[0][k] - diagonal[1][k]);
  EXPECT_GT(more, 0.0);
}

}  // namespace
}  // namespace wisp
