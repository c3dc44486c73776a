// The reference solutions of the Powell-Sabin benchmarks against each other.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "verification/powell_sabin/exact.h"
#include "verification/powell_sabin/ulfem.h"

namespace wisp::powell_sabin {
namespace {

UlfemCase bar_case(const VibratingBar& bar, int elements) {
  UlfemCase c{bar.length, bar.density, bar.young_modulus, 0.0, true, {}, elements};
  c.velocity = [bar](double x) { return bar.velocity(x, 0.0); };
  return c;
}

UlfemCase column_case(const SoilColumn& column, int elements) {
  return {column.height, column.density, column.young_modulus, -column.gravity, false, {}, elements};
}

TEST(ExactMotions, SatisfyTheWaveEquationAndTheirConditions) {
  const VibratingBar bar;
  const SoilColumn column;
  for (const double s : {0.13, 0.5, 0.81})
    for (const double t : {0.013, 0.11, 0.29}) {
      const double h = 1e-2, x = s * bar.length;
      const auto second = [&](auto&& f) { return (f(h) - 2.0 * f(0.0) + f(-h)) / (h * h); };
      EXPECT_NEAR(
          second([&](double d) { return bar.displacement(x, t + d); }),
          bar.young_modulus / bar.density * second([&](double d) { return bar.displacement(x + d, t); }),
          1e-6);
    }
  // At rest at the start, held at the base, and falling freely where no wave has come yet.
  for (const double y : {1.0, 12.0, 25.0}) EXPECT_NEAR(column.displacement(y, 0.0), 0.0, 1e-12);
  EXPECT_EQ(column.displacement(0.0, 0.07), 0.0);
  const double early = 0.5 * column.height / std::sqrt(column.young_modulus / column.density);
  EXPECT_NEAR(column.displacement(20.0, early), -0.5 * column.gravity * early * early, 1e-9);
  EXPECT_NEAR(column.velocity(20.0, early), -column.gravity * early, 1e-4);
  // Half a period later the column stands at twice its static displacement.
  const double statics =
      -0.5 * column.density * column.gravity * column.height * column.height / column.young_modulus;
  EXPECT_NEAR(column.displacement(25.0, 0.5 * column.period()), 2.0 * statics, 1e-9);
}

TEST(Ulfem, ConvergesToTheExactBarAtSecondOrderInSmallDeformation) {
  VibratingBar bar;
  bar.speed = 1e-7;  // a strain of 1e-9: what is left is the method's error
  double coarse = 0.0;
  for (const int n : {50, 100}) {
    Ulfem ulfem(bar_case(bar, n));
    ulfem.advance_to(3.0);
    const double error = std::abs(ulfem.displacement(12.5) / bar.displacement(12.5, 3.0) - 1.0);
    if (n == 100) {
      EXPECT_NEAR(coarse / error, 4.0, 0.1);
    }
    coarse = error;
  }
}

TEST(Ulfem, FollowsTheExactColumnInSmallDeformation) {
  SoilColumn column;
  column.gravity = 9.81e-6;
  Ulfem ulfem(column_case(column, 2000));
  for (const double t : {0.1, 0.2, 0.3, 0.5}) {
    ulfem.advance_to(t);
    const double scale =
        column.density * column.gravity * column.height * column.height / column.young_modulus;
    EXPECT_NEAR(ulfem.displacement(12.5), column.displacement(12.5, t), 2e-5 * scale);
    EXPECT_NEAR(ulfem.displacement(25.0), column.displacement(25.0, t), 2e-5 * scale);
  }
}

TEST(Ulfem, KeepsItsEnergyInLargeDeformation) {
  Ulfem ulfem(column_case({1000.0, 1e5, 9.81, 1.0}, 200));
  const double weight = 1000.0 * 9.81 * 0.1;  // that of the column on its mean way
  for (int i = 1; i <= 20; ++i) {
    ulfem.advance_to(0.05 * i);
    EXPECT_NEAR(ulfem.energy(), 0.0, 1e-3 * weight);
  }
  EXPECT_LT(ulfem.displacement(1.0), 0.0);
}

}  // namespace
}  // namespace wisp::powell_sabin
