// What a model does around steps: points that leave, time steps, domains that grow.
#include "analysis/fixtures.h"
#include "core/error.h"

namespace wisp {
namespace {

using namespace analysis_test;

ModelOptions flyer(bool gimp) {
  auto o = on_grid<2>({0, 0}, {2, 1}, {8, 4}, gimp);
  add_box<2>(o, {1, 0.25}, {1.5, 0.75}, Hencky{1000.0, 1e4, 0.3});
  o.bodies[0].velocity = {1.0, 0.0};
  return o;
}

TEST(Leaving, StopsWithIdsAndPlaces) {
  for (const bool gimp : {false, true}) {
    Model<2> model(flyer(gimp));
    Explicit<2> run(model, explicit_steps(0.01));
    try {
      for (int k = 0; k < 100; ++k) run.step(0.01);
      FAIL() << "the block has left";
    } catch (const RunError& e) {
      const std::string what = e.what();
      EXPECT_NE(what.find("'body 0'"), std::string::npos) << what;
      EXPECT_NE(what.find("left the grid"), std::string::npos) << what;
      EXPECT_NE(what.find("remove"), std::string::npos) << what;
      EXPECT_NE(what.find("(2."), std::string::npos) << what;
    }
    EXPECT_NEAR(model.time, 0.57, 1e-9) << "points at 1.4375 cross x = 2 in the step to 0.57";
  }
}

TEST(Leaving, RemovesAndCounts) {
  auto o = flyer(true);
  o.grid.leaving = Leaving::remove;
  Model<2> model(o);
  Explicit<2> run(model, explicit_steps(0.01));
  for (int k = 0; k < 60; ++k) run.step(0.01);
  EXPECT_EQ(model.removed, 4);
  EXPECT_EQ(model.n_points(), 12);
  for (int k = 0; k < 60; ++k) run.step(0.01);
  EXPECT_EQ(model.removed, 16);
  EXPECT_EQ(model.n_points(), 0);
}

TEST(TimeStep, IsGivenOrFromTheWaveSpeed) {
  auto o = flyer(true);
  Model<2> model(o);
  ExplicitOptions e;
  e.cfl = 0.4;
  const double wave = std::sqrt(Hencky{1000.0, 1e4, 0.3}.p_wave_modulus() / 1000.0);
  EXPECT_NEAR(Explicit<2>(model, e).time_step(1.0), 0.4 * 0.25 / (wave + 1.0), 1e-15);
  EXPECT_NEAR(Explicit<2>(model, e).time_step(1e-3), 1e-3, 1e-15) << "never beyond the end";
  e.dt = 0.3;
  EXPECT_EQ(Explicit<2>(model, e).time_step(1.0), 0.3);
  EXPECT_EQ(Explicit<2>(model, e).time_step(0.2), 0.2);
  EXPECT_EQ(Explicit<2>(model, e).time_step(0.3 + 1e-12), 0.3 + 1e-12) << "no step for a rest of rounding";
  e.dt.reset(), e.steps = 8, e.duration = 2.0;
  EXPECT_EQ(Explicit<2>(model, e).time_step(2.0), 0.25);
}

TEST(TimeStep, ZeroWaveSpeedIsAnErrorThatNamesDt) {
  auto o = on_grid<2>({0, 0}, {1, 1}, {4, 4}, false);
  add_box<2>(o, {0.25, 0.25}, {0.75, 0.75}, Hencky{1000.0, 0.0, 0.0});
  Model<2> model(o);
  try {
    (void)Explicit<2>(model, ExplicitOptions{}).time_step(1.0);
    FAIL();
  } catch (const RunError& e) {
    EXPECT_NE(std::string(e.what()).find("dt"), std::string::npos) << e.what();
  }
}

TEST(Explicit, VelocitiesThatAreNotFiniteStopBeforeThePointsMove) {
  auto o = flyer(false);
  o.bodies[0].velocity = {1e200, 0.0};
  Model<2> model(o);
  Explicit<2> run(model, explicit_steps(1e-3));
  try {
    run.step(1e-3);
    FAIL();
  } catch (const RunError& e) {
    const std::string what = e.what();
    EXPECT_NE(what.find("not finite"), std::string::npos) << what;
    EXPECT_NE(what.find("dt"), std::string::npos) << what;
  }
  EXPECT_EQ(model.time, 0.0);
  for_each_point(model,
                 [](const auto& body, std::size_t p) { ASSERT_EQ(body.points.displacement[p].norm(), 0.0); });
}

TEST(Domains, GrowOverSeveralCellsAndThenStop) {
  // A block without stiffness that stretches: width 3 up to F = 2, width 5 up to F = 6.
  auto o = on_grid<2>({-5, -1}, {5, 1}, {40, 8}, true);
  add_box<2>(o, {-0.5, -0.25}, {0.5, 0.25}, Hencky{1000.0, 0.0, 0.0});
  o.bodies[0].velocity_gradient = {{1.0, 0.0}, {0.0, 0.0}};
  const Mass mass = apply(MassKind::ghost, o);
  Model<2> model(o);
  Explicit<2> run(model, explicit_steps(0.05, mass));
  EXPECT_EQ(model.space->basis().index(), 1U);
  for (int k = 0; k < 60; ++k) run.step(0.05);
  EXPECT_EQ(model.space->basis().index(), 2U);
  for_each_point(model, [&](const auto& body, std::size_t p) {
    const Vec<2> start = body.points.position[p] - body.points.displacement[p];
    // Free points keep their velocities; their domains follow the stretch between them.
    ASSERT_NEAR(body.points.position[p][0], 4.0 * start[0], 1e-6);
    ASSERT_NEAR(body.points.half_length[p][0], 4.0 * 0.0625, 1e-3);
    ASSERT_NEAR(body.points.half_length[p][1], 0.0625, 1e-9);
  });
  EXPECT_THROW(
      {
        for (int k = 0; k < 60; ++k) run.step(0.05);
      },
      RunError);
  EXPECT_GT(model.time, 4.9);
}

TEST(Model, SamplesPointsWithTheVolumeOfTheirBody) {
  auto o = on_grid<3>({0, 0, 0}, {1, 1, 1}, {4, 4, 4}, true);
  add_box<3>(o, {0, 0.25, 0.5}, {1, 0.75, 1.0}, Hencky{1000.0, 1e4, 0.3}, 3);
  add_box<3>(o, {0, 0, 0}, {0.5, 0.25, 0.25}, LinearElastic{500.0, 1e4, 0.3}, 1);
  const Model<3> model(o);
  EXPECT_EQ(model.n_points(), 4 * 2 * 2 * 27 + 2);
  EXPECT_NEAR(total_mass(model), 1000.0 * 0.25 + 500.0 * 0.5 * 0.0625, 1e-10);
  std::vector<char> seen(static_cast<std::size_t>(model.n_points()), 0);
  for_each_point(
      model, [&](const auto& body, std::size_t p) { seen[static_cast<std::size_t>(body.points.id[p])]++; });
  for (const char count : seen) ASSERT_EQ(count, 1);
}

}  // namespace
}  // namespace wisp
