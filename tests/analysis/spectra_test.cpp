// The critical time step is that of the step which is run: motions stay below it and blow up above it.
#include "analysis/spectra.h"

#include <random>

#include "analysis/triangle_samples.h"

namespace wisp {
namespace {

using namespace analysis_test;

struct Treatment {
  const char* name;
  Mass mass;
  bool ghost;
  double deactivate_below;
};
constexpr Treatment treatments[] = {
    {"lumped", Mass::lumped, false, 0.0},   {"consistent", Mass::consistent, false, 0.0},
    {"Ghost", Mass::consistent, true, 0.0}, {"deactivated", Mass::consistent, false, 2.0},
    {"FMPM(3)", Mass::fmpm, false, 0.0},    {"partial", Mass::partial, false, 0.0}};

ModelOptions plate(const AnyBasisOptions& basis, const Treatment& t) {
  auto o = on_blocks({0, 0}, {2.5, 1.5}, 5, 3, basis);
  add_box<2>(o, {0.5, 0.0}, {1.9, 1.1}, Hencky{1000.0, 1e4, 0.3}, 4);
  hold(o, "y", 0.0, "y");
  if (t.ghost) o.stabilisation = GhostOptions{};
  return o;
}

ExplicitOptions step_of(const Treatment& t, StressUpdate scheme) {
  ExplicitOptions e = explicit_steps(1.0, t.mass, scheme);
  e.fmpm_order = 3, e.deactivate_below = t.deactivate_below;
  return e;
}

/// Largest speed in the last 30 steps of a run of small random motions, over that in the first 10.
double growth(const AnyBasisOptions& basis, const Treatment& t, StressUpdate scheme, double share,
              int steps) {
  Model<2> model(plate(basis, t));
  model.settle();
  const double dt = share * ExplicitSpectrum<2>(model, step_of(t, scheme)).critical_time_step();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> speed(-1e-7, 1e-7);
  for (auto& v : model.bodies[0].points.velocity) v = {speed(random), speed(random)};
  Explicit<2> run(model, step_of(t, scheme));
  double first = 0.0, last = 0.0;
  for (int k = 0; k < steps; ++k) {
    run.step(dt);
    double most = 0.0;
    for (const auto& v : model.bodies[0].points.velocity) most = std::max(most, v.norm());
    if (k < 10) first = std::max(first, most);
    if (k >= steps - 30) last = std::max(last, most);
    if (k > 0 && most > 1e3 * first) return most / first;
  }
  return last / first;
}

/// Where the consistent mass stands alone, linear functions only: that of splines is singular to rounding.
bool solvable(const AnyBasisOptions& basis, const Treatment& t) {
  const bool alone = t.mass == Mass::consistent && !t.ghost && t.deactivate_below == 0.0;
  return !alone || std::holds_alternative<LinearOptions>(basis);
}

TEST(ExplicitSpectrum, IsTheStepAtWhichARunBlowsUp) {
  for (const AnyBasisOptions& basis :
       {AnyBasisOptions(LinearOptions{}), AnyBasisOptions(PowellSabinOptions{})})
    for (const Treatment& t : treatments)
      for (const StressUpdate scheme : {StressUpdate::usl, StressUpdate::projected}) {
        if (!solvable(basis, t)) continue;
        // Partial lumping grows slowly below it.
        const double limit = t.mass == Mass::partial ? 5.0 : 1.5;
        EXPECT_LT(growth(basis, t, scheme, 0.98, 300), limit) << basis.index() << t.name << int(scheme);
        EXPECT_GT(growth(basis, t, scheme, 1.02, 300), 100.0) << basis.index() << t.name << int(scheme);
      }
}

TEST(ExplicitSpectrum, OfStressFirstAndOfTheSecondMapIsThatOfTheProjectedStep) {
  const Treatment t = treatments[4];
  const AnyBasisOptions basis = PowellSabinOptions{};
  for (const StressUpdate scheme : {StressUpdate::usf, StressUpdate::musl}) {
    EXPECT_LT(growth(basis, t, scheme, 0.98, 300), 1.5) << int(scheme);
    EXPECT_GT(growth(basis, t, scheme, 1.02, 300), 100.0) << int(scheme);
  }
}

TEST(ExplicitSpectrum, ConditionIsThatOfWhatIsSolved) {
  const AnyBasisOptions basis = PowellSabinOptions{};
  const auto condition = [&](const Treatment& t) {
    Model<2> model(plate(basis, t));
    model.settle();
    return ExplicitSpectrum<2>(model, step_of(t, StressUpdate::projected)).condition();
  };
  const double lumped = condition(treatments[0]), consistent = condition(treatments[1]),
               ghost = condition(treatments[2]), deactivated = condition(treatments[3]),
               series = condition(treatments[4]), partial = condition(treatments[5]);
  EXPECT_GT(consistent, 1e12);
  EXPECT_LT(ghost, 1e6);
  EXPECT_LT(deactivated, consistent);
  EXPECT_LT(partial, 1e-2 * consistent);
  EXPECT_EQ(series, lumped);
}

}  // namespace
}  // namespace wisp
