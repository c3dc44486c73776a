#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "linear/newton.h"

namespace wisp {
namespace {

/// x² + y² = 4, x y = 1, scaled by the size of the load.
struct Curves {
  Eigen::Vector2d r;
  Eigen::Matrix2d k;
  double evaluate(std::span<const double> u) {
    r << 4.0 - u[0] * u[0] - u[1] * u[1], 1.0 - u[0] * u[1];
    k << 2.0 * u[0], 2.0 * u[1], u[1], u[0];
    return r.norm() / 4.0;
  }
  std::string correct(std::span<double> du) const {
    if (k.determinant() == 0.0) return "singular";
    const Eigen::Vector2d step = k.partialPivLu().solve(r);
    du[0] = step[0];
    du[1] = step[1];
    return {};
  }
};

NewtonReport run(const NewtonOptions& options, std::vector<double>& u) {
  Curves curves;
  return newton(
      options, u, [&](std::span<const double> x) { return curves.evaluate(x); },
      [&](std::span<double> du) { return curves.correct(du); });
}

TEST(Newton, converges_at_second_order) {
  NewtonOptions options;
  options.tolerance = 1e-13;
  std::vector<double> u{2.0, 1.0};
  const auto report = run(options, u);
  ASSERT_TRUE(report.converged) << report.cause;
  EXPECT_EQ(report.iterations, static_cast<int>(report.residuals.size()));
  EXPECT_NEAR(u[0] * u[1], 1.0, 1e-12);
  EXPECT_NEAR(u[0] * u[0] + u[1] * u[1], 4.0, 1e-12);
  // Error constants are of order one: each residual below the square of the one before, up to a factor and
  // rounding.
  for (std::size_t i = 2; i < report.residuals.size(); ++i)
    EXPECT_LT(report.residuals[i], 4.0 * report.residuals[i - 1] * report.residuals[i - 1] + 1e-15);
}

TEST(Newton, a_linear_problem_takes_two_iterations_and_a_balanced_one_takes_one) {
  double r = 0.0;
  std::vector<double> u{0.0};
  const auto residual = [&](std::span<const double> x) {
    r = 3.0 - 2.0 * x[0];
    return std::abs(r) / 3.0;
  };
  const auto correct = [&](std::span<double> du) {
    du[0] = r / 2.0;
    return std::string{};
  };
  const auto first = newton({}, u, residual, correct);
  EXPECT_TRUE(first.converged);
  EXPECT_EQ(first.iterations, 2);
  EXPECT_DOUBLE_EQ(u[0], 1.5);
  EXPECT_NEAR(first.margin, 6.0, 1e-12);  // the first residual is 1, six decades above the tolerance
  EXPECT_EQ(newton({}, u, residual, correct).iterations, 1);
}

TEST(Newton, says_why_it_fails) {
  std::vector<double> u{0.0, 0.0};
  const auto singular = run({}, u);
  EXPECT_FALSE(singular.converged);
  EXPECT_EQ(singular.cause, "singular");

  NewtonOptions few;
  few.max_iterations = 2;
  u = {2.0, 1.0};
  const auto unfinished = run(few, u);
  EXPECT_FALSE(unfinished.converged);
  EXPECT_EQ(unfinished.iterations, 2);
  EXPECT_NE(unfinished.cause.find("2 iterations"), std::string::npos);

  u = {std::nan(""), 0.0};
  const auto lost = run({}, u);
  EXPECT_FALSE(lost.converged);
  EXPECT_NE(lost.cause.find("finite"), std::string::npos);
}

TEST(Newton, line_search_tames_an_overshoot) {
  double x0 = 0.0;
  const auto residual = [&](std::span<const double> x) {
    x0 = x[0];
    return std::abs(std::atan(x[0]));
  };
  const auto correct = [&](std::span<double> du) {
    du[0] = -std::atan(x0) * (1.0 + x0 * x0);
    return std::string{};
  };
  NewtonOptions options;
  std::vector<double> plain{3.0}, searched{3.0};
  EXPECT_FALSE(newton(options, plain, residual, correct).converged);
  options.line_search = true;
  EXPECT_TRUE(newton(options, searched, residual, correct).converged);
  EXPECT_NEAR(searched[0], 0.0, 1e-6);
}

}  // namespace
}  // namespace wisp
