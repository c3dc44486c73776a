#include <gtest/gtest.h>

#include <cmath>

#include "linear/mass_solver.h"

namespace wisp {
namespace {

/// Mass of a line of n linear elements among `unused` functions that nothing touches; element e weighs
/// 10^-(spread e/n).
struct Line {
  int n;
  BlockMatrix mass{1};
  Halo halo;
  std::vector<char> active;

  explicit Line(int elements, double spread = 0.0, int unused = 5)
      : n(elements + 1 + unused), halo(n), active(static_cast<std::size_t>(n), 1) {
    mass.begin_pattern(n);
    for (int e = 0; e < elements; ++e) mass.add_element(std::vector<int>{unused + e, unused + e + 1});
    mass.end_pattern();
    for (int e = 0; e < elements; ++e) {
      const double w = std::pow(10.0, -spread * e / elements);
      const double element[4] = {2 * w, w, w, 2 * w};
      mass.add(std::vector<int>{unused + e, unused + e + 1}, element);
    }
    for (int f = 0; f < unused; ++f) active[static_cast<std::size_t>(f)] = 0;
  }
  std::vector<double> field(int m) const {
    std::vector<double> x(static_cast<std::size_t>(n * m), 0.0);
    for (int f = 0; f < n; ++f)
      for (int c = 0; c < m; ++c)
        if (active[static_cast<std::size_t>(f)])
          x[static_cast<std::size_t>(f * m + c)] = std::sin(f + 2.0 * c);
    return x;
  }
};

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  return worst;
}

TEST(MassSolver, solves_all_columns_by_either_way) {
  const Line line(40, 3.0);
  for (const auto kind : {SolverKind::iterative, SolverKind::direct, SolverKind::automatic})
    for (int m = 1; m <= 4; ++m) {
      MassSolverOptions options;
      options.solver = kind;
      options.tolerance = 1e-13;
      MassSolver solver(options);
      const auto exact = line.field(m);
      std::vector<double> b(exact.size()), x(exact.size(), 0.0);
      line.mass.multiply_columns(exact, b, m);
      solver.set_matrix(line.mass, line.halo, m, line.active);
      const auto report = solver.solve(b, x);
      EXPECT_TRUE(report.solved) << report.cause;
      EXPECT_LT(distance(x, exact), 1e-10) << m;
      const auto again = solver.solve(b, x);
      EXPECT_LE(again.iterations, 1);
      EXPECT_LT(distance(x, exact), 1e-10);
    }
}

TEST(MassSolver, keeps_fixed_values_and_solves_for_the_rest) {
  const Line line(30);
  const auto exact = line.field(2);
  std::vector<char> fixed(exact.size(), 0);
  fixed[2 * 5] = fixed[2 * 20 + 1] = fixed[2 * 35] = fixed[2 * 35 + 1] = 1;
  std::vector<double> b(exact.size());
  line.mass.multiply_columns(exact, b, 2);
  for (std::size_t i = 0; i < b.size(); ++i)
    if (fixed[i]) b[i] = 1e3;  // the row of a fixed unknown holds its reaction, which must not matter
  for (const auto kind : {SolverKind::iterative, SolverKind::direct}) {
    MassSolverOptions options;
    options.solver = kind;
    MassSolver solver(options);
    std::vector<double> x(exact.size(), 0.5);
    for (std::size_t i = 0; i < x.size(); ++i)
      if (fixed[i]) x[i] = exact[i];
    solver.set_matrix(line.mass, line.halo, 2, line.active, fixed);
    const auto report = solver.solve(b, x);
    EXPECT_TRUE(report.solved) << report.cause;
    EXPECT_LT(distance(x, exact), 1e-10);
    EXPECT_EQ(x[2 * 20 + 1], exact[2 * 20 + 1]);
  }
}

TEST(MassSolver, an_inactive_function_takes_no_part) {
  Line line(10);
  line.active[8] = 0;
  auto exact = line.field(1);
  ASSERT_EQ(exact[8], 0.0);
  std::vector<double> b(exact.size()), x(exact.size(), 3.0);
  line.mass.multiply(exact, b);
  MassSolver solver;
  solver.set_matrix(line.mass, line.halo, 1, line.active);
  EXPECT_TRUE(solver.solve(b, x).solved);
  EXPECT_LT(distance(x, exact), 1e-10);
}

TEST(MassSolver, zero_load_gives_zero_and_non_finite_load_is_reported) {
  const Line line(10);
  MassSolver solver;
  solver.set_matrix(line.mass, line.halo, 2, line.active);
  std::vector<double> b(static_cast<std::size_t>(2 * line.n), 0.0), x(b.size(), 0.0);
  const auto nothing = solver.solve(b, x);
  EXPECT_TRUE(nothing.solved);
  EXPECT_EQ(nothing.iterations, 0);
  EXPECT_EQ(x, std::vector<double>(x.size(), 0.0));
  b[20] = std::nan("");
  EXPECT_FALSE(solver.solve(b, x).solved);
}

TEST(MassSolver, falls_back_on_a_factorisation_and_follows_new_values) {
  Line line(60, 8.0);
  MassSolverOptions options;
  options.max_iterations = 3;
  MassSolver solver(options);
  const auto exact = line.field(2);
  std::vector<double> b(exact.size()), x(exact.size(), 0.0);
  for (int round = 0; round < 2; ++round) {
    line.mass.multiply_columns(exact, b, 2);
    solver.set_matrix(line.mass, line.halo, 2, line.active);
    const auto report = solver.solve(b, x);
    EXPECT_TRUE(report.solved) << report.cause;
    EXPECT_LT(distance(x, exact), 1e-9);
    for (double& v : line.mass.values()) v *= 7.0;
    std::fill(x.begin(), x.end(), 0.0);
  }
}

TEST(MassSolver, goes_direct_for_a_while_after_iterations_have_failed) {
  const Line line(60, 8.0);
  MassSolverOptions options;
  options.max_iterations = 3;
  MassSolver solver(options);
  const auto exact = line.field(1);
  const std::vector<double> zero(exact.size(), 0.0);
  std::vector<double> b(exact.size());
  line.mass.multiply(exact, b);
  solver.set_matrix(line.mass, line.halo, 1, line.active);
  // Conjugate gradients started from the solution are done without an iteration; a factorisation counts one.
  const auto iterations = [&](std::vector<double> start) {
    const auto report = solver.solve(b, start);
    EXPECT_TRUE(report.solved) << report.cause;
    EXPECT_LT(distance(start, exact), 1e-9);
    return report.iterations;
  };
  iterations(zero);
  EXPECT_EQ(iterations(exact), 1);
  EXPECT_EQ(iterations(exact), 0);
  // Two failures in a row.
  iterations(zero);
  EXPECT_EQ(iterations(exact), 1);
  iterations(zero);
  EXPECT_EQ(iterations(exact), 1);
  EXPECT_EQ(iterations(exact), 1);
  EXPECT_EQ(iterations(exact), 0);
}

TEST(MassSolver, reports_an_indefinite_matrix) {
  Line line(10);
  for (double& v : line.mass.values()) v = -v;
  MassSolverOptions options;
  options.solver = SolverKind::iterative;
  MassSolver solver(options);
  solver.set_matrix(line.mass, line.halo, 1, line.active);
  std::vector<double> b(static_cast<std::size_t>(line.n), 1.0), x(b.size(), 0.0);
  EXPECT_FALSE(solver.solve(b, x).solved);
}

}  // namespace
}  // namespace wisp
