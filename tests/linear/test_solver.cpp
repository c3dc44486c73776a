#include <gtest/gtest.h>

#include <array>
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

TEST(LinearSolver, refuses_options_that_nothing_reads) {
  const Problem p(20, 1, 1e-6);
  SolverOptions options;
  options.solver = SolverKind::iterative;
  options.petsc_options = "-ksp_type cg -pc_tpye jacobi";
  LinearSolver solver(options);
  std::vector<double> x(p.rhs.size(), 0.0);
  try {
    solver.solve(p.system, p.dofs, p.halo, p.rhs, x);
    FAIL() << "a misspelt option was ignored";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("-pc_tpye"), std::string::npos) << error.what();
  }
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

TEST(LinearSolver, sees_symmetry_come_and_go) {
  Problem p(10, 2, 0.3);
  const BlockMatrix skew = laplacian(10, 2, 0.3, 0.4);
  LinearSolver solver;
  std::vector<double> x(p.rhs.size(), 0.0);
  for (int round = 0; round < 4; ++round) {
    BlockMatrix a = p.a;  // the same pattern
    if (round % 2 == 1) std::copy(skew.values().begin(), skew.values().end(), a.values().begin());
    EXPECT_EQ(a.symmetric(), round % 2 == 0);
    a.multiply(p.exact, p.rhs);
    p.system.assign(a, p.dofs);
    EXPECT_EQ(p.system.symmetric(), round % 2 == 0);
    const auto report = solver.solve(p.system, p.dofs, p.halo, p.rhs, x);
    EXPECT_TRUE(report.solved) << report.cause;
    EXPECT_LT(p.error(x), 1e-11);
  }
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

/// Square lattice of springs along edges and diagonals, fixed along its left edge: plane elasticity with
/// rigid modes.
struct Lattice {
  int n;
  BlockMatrix k{2};
  DofMap dofs;
  SystemMatrix system;
  MatrixTraits traits;

  explicit Lattice(int size) : n(size) {
    const auto node = [&](int i, int j) { return j * n + i; };
    std::vector<std::array<int, 4>> springs;  // two nodes and the direction
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        if (i + 1 < n) springs.push_back({node(i, j), node(i + 1, j), 1, 0});
        if (j + 1 < n) springs.push_back({node(i, j), node(i, j + 1), 0, 1});
        if (i + 1 < n && j + 1 < n) springs.push_back({node(i, j), node(i + 1, j + 1), 1, 1});
        if (i + 1 < n && j + 1 < n) springs.push_back({node(i + 1, j), node(i, j + 1), -1, 1});
      }
    k.begin_pattern(n * n);
    for (const auto& s : springs) k.add_element(std::span(s).first(2));
    k.end_pattern();
    for (const auto& s : springs) {
      const double l2 = s[2] * s[2] + s[3] * s[3];
      const double u[4] = {-s[2] / l2, -s[3] / l2, s[2] / l2, s[3] / l2};
      double element[16];
      for (int a = 0; a < 16; ++a) element[a] = u[a / 4] * u[a % 4];
      k.add(std::span(s).first(2), element);
    }
    std::vector<char> fixed(static_cast<std::size_t>(2 * n * n), 0);
    for (int j = 0; j < n; ++j)
      fixed[static_cast<std::size_t>(2 * node(0, j))] = fixed[static_cast<std::size_t>(2 * node(0, j) + 1)] =
          1;
    dofs = DofMap(Halo(n * n), 2, std::vector<char>(static_cast<std::size_t>(n * n), 1), fixed,
                  FixedUnknowns::unit_rows);
    system.assign(k, dofs);
    traits.symmetric = true;
  }
  SolveReport solve(bool with_coordinates, std::vector<double>& x) {
    traits.coordinates.clear();
    for (int f = 0; with_coordinates && f < n * n; ++f) {
      traits.coordinates.push_back(f % n);
      traits.coordinates.push_back(static_cast<double>(f / n));
    }
    SolverOptions options;
    options.solver = SolverKind::iterative;
    LinearSolver solver(options, traits);
    std::vector<double> load(static_cast<std::size_t>(2 * n * n), 0.0);
    load.back() = 1.0;
    x.assign(load.size(), 0.0);
    return solver.solve(system, dofs, Halo(n * n), load, x);
  }
};

TEST(LinearSolver, multigrid_gains_from_rigid_modes) {
  std::vector<double> x, y;
  Lattice plain(40), informed(40);
  const auto without = plain.solve(false, x);
  const auto with = informed.solve(true, y);
  ASSERT_TRUE(with.solved) << with.cause;
  ASSERT_TRUE(without.solved) << without.cause;
  EXPECT_LT(with.iterations, without.iterations);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], y[i], 1e-6 * std::abs(y.back()));
}

TEST(LinearSolver, auto_turns_to_the_direct_solver_where_iterations_fail) {
  Lattice lattice(75);  // more unknowns than the direct solver takes at once in 3D
  SolverOptions options;
  options.max_iterations = 2;
  MatrixTraits traits;
  traits.dim = 3;
  traits.symmetric = true;
  LinearSolver solver(options, traits);
  EXPECT_EQ(solver.numbering(lattice.dofs.n_global()), FixedUnknowns::unit_rows);
  std::vector<double> load(static_cast<std::size_t>(lattice.dofs.n_global()), 1.0), x(load.size(), 0.0);
  const auto report = solver.solve(lattice.system, lattice.dofs, Halo(75 * 75), load, x);
  EXPECT_TRUE(report.solved) << report.cause;
  EXPECT_TRUE(solver.direct());
  EXPECT_LT(report.residual, 1e-9);
  EXPECT_EQ(solver.numbering(lattice.dofs.n_global()), FixedUnknowns::removed);
}

TEST(LinearSolver, passes_the_case_s_options_to_petsc) {
  const Problem p(8, 1, 0.5);
  std::vector<double> x(p.rhs.size(), 0.0);
  SolverOptions options;
  options.petsc_options = "-ksp_type minres -pc_type jacobi -ksp_rtol 1e-12";
  LinearSolver solver(options);
  const auto report = solver.solve(p.system, p.dofs, p.halo, p.rhs, x);
  EXPECT_TRUE(report.solved) << report.cause;
  EXPECT_GT(report.iterations, 2);  // so it was not the direct solver
  EXPECT_LT(p.error(x), 1e-9);
}

}  // namespace
}  // namespace wisp
