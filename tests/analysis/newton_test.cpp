// How an implicit step is found: rate of convergence, cut steps, line search, failure.
#include "analysis/fixtures.h"
#include "core/error.h"

namespace wisp {
namespace {

using namespace analysis_test;

/// A cantilever that bends far under its own weight.
ModelOptions cantilever(const AnyLaw& law, bool gimp, double gravity) {
  auto o = on_grid<2>({0, -2}, {3, 1}, {12, 12}, gimp);
  add_box<2>(o, {0, -0.25}, {2, 0.25}, law);
  hold(o, "x", 0.0, "xy");
  add_gravity(o, {0.0, -gravity}, ramp());
  o.stabilisation = GhostOptions{};
  return o;
}

QuasiStaticOptions newton(double tolerance, int iterations) {
  QuasiStaticOptions q;
  q.steps = 1, q.tolerance = tolerance, q.max_iterations = iterations;
  return q;
}

TEST(Newton, ConvergesQuadratically) {
  for (const bool gimp : {false, true})
    for (const AnyLaw& law :
         {AnyLaw(Hencky{1000.0, 1e6, 0.3}), AnyLaw(VonMises{1000.0, 1e6, 0.3, 3e4, 1e5})}) {
      Model<2> model(cantilever(law, gimp, 4.0));
      Implicit<2> run(model, newton(1e-11, 25));
      const auto r = run.step(1.0).residuals;
      // Where the asymptotic range is reached and rounding is not, the exponent doubles.
      double best = 0.0;
      for (std::size_t k = 2; k < r.size(); ++k)
        if (r[k - 1] < 1e-2 && r[k] > 1e-15) best = std::max(best, std::log(r[k]) / std::log(r[k - 1]));
      std::string list;
      for (const double v : r) list += " " + std::to_string(std::log10(v));
      EXPECT_GT(best, 1.7) << "log10 of residuals:" << list;
      EXPECT_LE(r.size(), 14U) << list;
    }
}

TEST(Newton, LinearProblemsTakeTwoIterations) {
  Model<2> model(cantilever(LinearElastic{1000.0, 1e6, 0.3}, false, 4.0));
  Implicit<2> run(model, newton(1e-9, 10));
  const auto record = run.step(1.0);
  EXPECT_EQ(record.iterations, 2);
  EXPECT_EQ(record.cuts, 0);
  EXPECT_NEAR(model.reactions[0][1], 1000.0 * 4.0, 1e-4);
}

TEST(Newton, NothingOverNothingIsConverged) {
  // No force at all: the residual and its scale are both zero, and the step must end, not turn into 0/0.
  {
    auto o = cantilever(LinearElastic{1000.0, 1e6, 0.3}, false, 0.0);
    Model<2> model(o);
    Implicit<2> run(model, newton(1e-9, 10));
    const auto record = run.step(1.0);
    EXPECT_EQ(record.iterations, 2);
    ASSERT_EQ(record.residuals.size(), 2U);
    EXPECT_EQ(record.residuals[0], 1.0) << "the first evaluation never ends a step";
    EXPECT_EQ(record.residuals[1], 0.0);
  }
  // Nothing acts but a prescribed motion: no scale until the first reactions are found.
  auto o = cantilever(LinearElastic{1000.0, 1e6, 0.3}, false, 0.0);
  std::get<ConformingOptions>(o.boundaries[0]).displacement = ramp(0.1);
  Model<2> model(o);
  Implicit<2> run(model, newton(1e-9, 10));
  const auto record = run.step(1.0);
  for (const double r : record.residuals) EXPECT_TRUE(std::isfinite(r));
  EXPECT_EQ(record.residuals[0], 1.0);
  for_each_point(model, [&](const auto& body, std::size_t p) {
    ASSERT_NEAR(body.points.displacement[p][0], 0.1, 1e-9) << "moved as a whole";
    ASSERT_NEAR(body.points.displacement[p][1], 0.1, 1e-9);
  });
}

TEST(Newton, ReportsAStepThatDoesNotConverge) {
  Model<2> model(cantilever(Hencky{1000.0, 1e6, 0.3}, true, 40.0));
  Implicit<2> run(model, newton(1e-8, 4));
  try {
    run.step(1.0);
    FAIL() << "four iterations cannot be enough";
  } catch (const RunError& e) {
    const std::string what = e.what();
    EXPECT_NE(what.find("step 1"), std::string::npos) << what;
    EXPECT_NE(what.find("cuts"), std::string::npos) << what;
  }
  EXPECT_EQ(model.time, 0.0);
  for_each_point(model, [&](const auto& body, std::size_t p) {
    ASSERT_EQ(body.points.displacement[p], Vec<2>(0.0, 0.0)) << "a failed step must leave the points alone";
    ASSERT_EQ(stress_of(body, p).norm(), 0.0);
  });
}

TEST(Newton, CutsAStepUntilItConverges) {
  auto options = newton(1e-8, 5);
  options.cuts = 8;
  Model<2> model(cantilever(Hencky{1000.0, 1e6, 0.3}, true, 40.0));
  Implicit<2> run(model, options);
  const auto record = run.step(1.0);
  EXPECT_GT(record.cuts, 0);
  EXPECT_GT(record.iterations, 5);
  EXPECT_NEAR(model.time, 1.0, 1e-15);
  EXPECT_EQ(model.step, 1);
  EXPECT_NEAR(model.reactions[0][1], 40000.0, 1e-3);
}

TEST(Newton, LineSearchDoesNotHurtAndNeverRaisesTheResidual) {
  auto plain = newton(1e-9, 25), search = plain;
  search.line_search = true;
  for (const double gravity : {1.0, 12.0}) {
    Model<2> one(cantilever(Hencky{1000.0, 1e6, 0.3}, true, gravity)),
        two(cantilever(Hencky{1000.0, 1e6, 0.3}, true, gravity));
    Implicit<2> a(one, plain), b(two, search);
    a.step(1.0);
    const auto record = b.step(1.0);
    for (std::size_t k = 1; k < record.residuals.size(); ++k)
      EXPECT_LE(record.residuals[k], record.residuals[k - 1]);
    for (std::size_t p = 0; p < one.bodies[0].points.position.size(); ++p)
      ASSERT_LT((one.bodies[0].points.position[p] - two.bodies[0].points.position[p]).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace wisp
