#include <gtest/gtest.h>

#include <cmath>

#include "linear/solver.h"

namespace wisp {
namespace {

/// Plane grid of n x n functions with b components each: Laplacian plus `shift` times the identity, and a
/// skew coupling of neighbours of size `skew` to make it unsymmetric.
BlockMatrix laplacian(int n, int b, double shift, double skew = 0.0) {
  BlockMatrix a(b);
  a.begin_pattern(n * n);
  std::vector<std::vector<int>> edges;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      if (i + 1 < n) edges.push_back({j * n + i, j * n + i + 1});
      if (j + 1 < n) edges.push_back({j * n + i, j * n + i + n});
    }
  for (const auto& e : edges) a.add_element(e);
  a.end_pattern();
  const double element[4] = {1.0, -1.0 + skew, -1.0 - skew, 1.0};
  for (const auto& e : edges) a.add_scalar(e, element);
  for (int f = 0; f < n * n; ++f) {
    const int one[1] = {f};
    a.add_scalar(one, &shift);
  }
  return a;
}

struct Problem {
  Halo halo;
  BlockMatrix a;
  DofMap dofs;
  SystemMatrix system;
  std::vector<double> exact, rhs;

  Problem(int n, int b, double shift, double skew = 0.0)
      : halo(n * n),
        a(laplacian(n, b, shift, skew)),
        dofs(halo, b, std::vector<char>(static_cast<std::size_t>(n * n), 1)) {
    system.assign(a, dofs);
    exact.resize(static_cast<std::size_t>(n * n * b));
    for (std::size_t i = 0; i < exact.size(); ++i) exact[i] = std::sin(static_cast<double>(i));
    rhs.resize(exact.size());
    a.multiply(exact, rhs);
  }
  double error(const std::vector<double>& x) const {
    double e = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) e = std::max(e, std::abs(x[i] - exact[i]));
    return e;
  }
};

TEST(LinearSolver, direct_solves_symmetric_and_unsymmetric_systems) {
  for (const double skew : {0.0, 0.4}) {
    const Problem p(12, 2, 0.1, skew);
    MatrixTraits traits;
    traits.symmetric = skew == 0.0;
    LinearSolver solver(SolverOptions{}, traits);
    std::vector<double> x(p.rhs.size(), 0.0);
    const auto report = solver.solve(p.system, p.dofs, p.halo, p.rhs, x);
    EXPECT_TRUE(solver.direct());
    EXPECT_TRUE(report.solved) << report.cause;
    EXPECT_LT(report.residual, 1e-13);
    EXPECT_LT(p.error(x), 1e-11);
  }
}

TEST(LinearSolver, iterative_solves_and_starts_from_the_given_vector) {
  for (const double skew : {0.0, 0.4}) {
    const Problem p(20, 2, 0.1, skew);
    SolverOptions options;
    options.solver = SolverKind::iterative;
    options.tolerance = 1e-11;
    MatrixTraits traits;
    traits.symmetric = skew == 0.0;
    LinearSolver solver(options, traits);
    std::vector<double> x(p.rhs.size(), 0.0);
    const auto cold = solver.solve(p.system, p.dofs, p.halo, p.rhs, x);
    EXPECT_FALSE(solver.direct());
    EXPECT_TRUE(cold.solved) << cold.cause;
    EXPECT_GT(cold.iterations, 1);
    EXPECT_LT(p.error(x), 1e-8);
    const auto warm = solver.solve(p.system, p.dofs, p.halo, p.rhs, x, true);
    EXPECT_TRUE(warm.solved);
    EXPECT_LE(warm.iterations, 1);
  }
}

TEST(LinearSolver, reports_a_singular_matrix_and_goes_on) {
  Problem p(6, 1, 0.0);                        // constants are in the kernel
  std::vector<double> rhs(p.rhs.size(), 1.0);  // not in the range
  for (const bool symmetric : {true, false}) {
    MatrixTraits traits;
    traits.symmetric = symmetric;
    LinearSolver solver(SolverOptions{}, traits);
    std::vector<double> x(rhs.size(), 0.0);
    const auto report = solver.solve(p.system, p.dofs, p.halo, rhs, x);
    EXPECT_FALSE(report.solved);
    EXPECT_FALSE(report.cause.empty());
    Problem good(6, 1, 1.0);
    const auto after = solver.solve(good.system, good.dofs, good.halo, good.rhs, x);
    EXPECT_TRUE(after.solved) << after.cause;
    EXPECT_LT(good.error(x), 1e-12);
  }
}

TEST(LinearSolver, reports_a_zero_row) {
  Problem p(4, 1, 1.0);
  BlockMatrix a(1);
  a.begin_pattern(3);
  const int pair[2] = {0, 1};
  a.add_element(pair);
  a.end_pattern();
  const double element[4] = {2, 1, 1, 2};
  a.add(pair, element);
  const Halo halo(3);
  const DofMap dofs(halo, 1, std::vector<char>(3, 1));
  SystemMatrix system;
  system.assign(a, dofs);
  for (const char* package : {"mumps", "umfpack", "petsc"}) {
    SolverOptions options;
    options.petsc_options = std::string("-pc_factor_mat_solver_type ") + package;
    LinearSolver solver(options);
    std::vector<double> x(3, 0.0);
    const std::vector<double> b{1, 1, 1};
    const auto report = solver.solve(system, b, x);
    EXPECT_FALSE(report.solved) << package;
    EXPECT_FALSE(report.cause.empty());
  }
}

TEST(LinearSolver, reports_an_iteration_that_does_not_converge) {
  const Problem p(20, 1, 1e-6);
  SolverOptions options;
  options.solver = SolverKind::iterative;
  options.max_iterations = 2;
  options.petsc_options = "-ksp_type cg -pc_type none";
  LinearSolver solver(options);
  std::vector<double> x(p.rhs.size(), 0.0);
  const auto report = solver.solve(p.system, p.dofs, p.halo, p.rhs, x);
  EXPECT_FALSE(report.solved);
  EXPECT_NE(report.cause.find("limit"), std::string::npos) << report.cause;
}

TEST(LinearSolver, follows_values_that_change_and_keeps_a_factorisation_when_told) {
  Problem p(8, 2, 0.5);
  LinearSolver solver;
  std::vector<double> x(p.rhs.size(), 0.0), y(p.rhs.size(), 0.0), z(p.rhs.size(), 0.0);
  solver.solve(p.system, p.dofs, p.halo, p.rhs, x);
  for (double& v : p.a.values()) v *= 2.0;
  p.system.assign(p.a, p.dofs);
  solver.solve(p.system, p.dofs, p.halo, p.rhs, y, true);  // the old factorisation
  EXPECT_EQ(x, y);
  const auto report = solver.solve(p.system, p.dofs, p.halo, p.rhs, z);
  EXPECT_LT(report.residual, 1e-13);
  for (std::size_t i = 0; i < z.size(); ++i) EXPECT_NEAR(z[i], 0.5 * x[i], 1e-12);
}

TEST(LinearSolver, repeats_itself_bit_by_bit) {
  const Problem p(15, 2, 0.1);
  for (const auto kind : {SolverKind::direct, SolverKind::iterative}) {
    SolverOptions options;
    options.solver = kind;
    std::vector<double> first(p.rhs.size(), 0.0), second(p.rhs.size(), 0.0);
    LinearSolver(options).solve(p.system, p.dofs, p.halo, p.rhs, first);
    LinearSolver(options).solve(p.system, p.dofs, p.halo, p.rhs, second);
    EXPECT_EQ(first, second);
  }
}

}  // namespace
}  // namespace wisp
