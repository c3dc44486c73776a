// The same problem on any number of ranks: a line of elements, each rank holding some and sharing a function
// with its neighbours.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "linear/mass_solver.h"
#include "linear/spectrum.h"
#include "parallel/session.h"

namespace wisp {
namespace {

/// Elements [20 r, 20 (r + 1)) on rank r, local functions 0..20; the last one belongs to the next rank.
struct SharedLine {
  static constexpr int n = 20;
  int rank = Session::rank(), ranks = Session::size();
  Halo halo;
  BlockMatrix k{2}, mass{1};

  static Halo make_halo() {
    if (Session::size() == 1) return Halo(n + 1);
    std::vector<int> owner(n + 1, Session::rank()), slot(n + 1);
    for (int f = 0; f <= n; ++f) slot[static_cast<std::size_t>(f)] = f;
    if (Session::rank() + 1 < Session::size()) {
      owner[n] = Session::rank() + 1;
      slot[n] = 0;
    }
    return Halo(owner, slot);
  }
  SharedLine() : halo(make_halo()) {
    mass.begin_pattern(n + 1);
    for (int e = 0; e < n; ++e) mass.add_element(std::vector<int>{e, e + 1});
    mass.end_pattern();
    k.share_pattern(mass);
    for (int e = 0; e < n; ++e) {
      const double w = 1.0 + 0.5 * std::sin(rank * n + e);
      const double m[4] = {2 * w, w, w, 2 * w}, s[4] = {2 * w, -w, -w, 2 * w};
      mass.add(std::vector<int>{e, e + 1}, m);
      k.add_scalar(std::vector<int>{e, e + 1}, s);
    }
  }
  std::vector<double> field(int m) const {
    std::vector<double> x;
    for (int f = 0; f <= n; ++f)
      for (int c = 0; c < m; ++c) x.push_back(std::sin(0.3 * (rank * n + f) + c));
    return x;
  }
  double error(const std::vector<double>& x, const std::vector<double>& exact) const {
    double worst = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) worst = std::max(worst, std::abs(x[i] - exact[i]));
    return Session::max(worst);
  }
};

TEST(Ranks, number_every_unknown_once) {
  const SharedLine line;
  std::vector<char> active(SharedLine::n + 1, 1), fixed(2 * (SharedLine::n + 1), 0);
  if (line.rank == 0) fixed[1] = 1;
  const DofMap dofs(line.halo, 2, active, fixed);
  EXPECT_EQ(dofs.n_global(), 2 * (SharedLine::n * line.ranks + 1) - 1);
  EXPECT_EQ(Session::sum(dofs.n_owned()), dofs.n_global());
  for (int f = 0; f <= SharedLine::n; ++f)
    EXPECT_EQ(dofs.number(f, 0), 2 * (line.rank * SharedLine::n + f) - (line.rank + f > 0 ? 1 : 0));
}

TEST(Ranks, solve_what_they_share) {
  const SharedLine line;
  const auto exact = line.field(2);
  std::vector<double> b(exact.size());
  line.k.multiply(exact, b);
  line.halo.add(b.data(), 2);
  for (const auto mode : {FixedUnknowns::removed, FixedUnknowns::unit_rows})
    for (const auto kind : {SolverKind::direct, SolverKind::iterative})
      for (const bool symmetric : {true, false}) {
        const DofMap dofs(line.halo, 2, std::vector<char>(SharedLine::n + 1, 1), {}, mode);
        SystemMatrix system;
        system.assign(line.k, dofs);
        system.assign(line.k, dofs);  // once more over the kept structure: values must not pile up
        SolverOptions options;
        options.solver = kind;
        options.tolerance = 1e-12;
        MatrixTraits traits;
        traits.symmetric = symmetric;
        LinearSolver solver(options, traits);
        std::vector<double> x(exact.size(), 0.0);
        const auto report = solver.solve(system, dofs, line.halo, b, x);
        EXPECT_TRUE(report.solved) << report.cause;
        EXPECT_LT(line.error(x, exact), 1e-9);
      }
}

TEST(Ranks, solve_a_mass_that_none_of_them_assembles) {
  const SharedLine line;
  const auto exact = line.field(3);
  std::vector<double> b(exact.size());
  line.mass.multiply_columns(exact, b, 3);
  line.halo.add(b.data(), 3);
  std::vector<char> fixed(exact.size(), 0);
  fixed[0] = fixed[3 * SharedLine::n] = 1;  // the shared functions' first component
  for (const auto kind : {SolverKind::iterative, SolverKind::direct}) {
    MassSolverOptions options;
    options.solver = kind;
    MassSolver solver(options);
    solver.set_matrix(line.mass, line.halo, 3, std::vector<char>(SharedLine::n + 1, 1), fixed);
    std::vector<double> x(exact.size(), 0.0);
    x[0] = exact[0];
    x[3 * SharedLine::n] = exact[3 * SharedLine::n];
    const auto report = solver.solve(b, x);
    EXPECT_TRUE(report.solved) << report.cause;
    EXPECT_LT(line.error(x, exact), 1e-10);
  }
}

TEST(Ranks, find_the_spectrum_of_the_whole) {
  // Equal elements [1, -1; -1, 1] + mass-like shift: the free line of N functions has eigenvalues 2 - 2
  // cos(pi j / N), j = 0..N-1.
  SharedLine line;
  line.mass.zero();
  const double spring[4] = {1, -1, -1, 1};
  for (int e = 0; e < SharedLine::n; ++e) line.mass.add(std::vector<int>{e, e + 1}, spring);
  const DofMap dofs(line.halo, 1, std::vector<char>(SharedLine::n + 1, 1));
  SystemMatrix system;
  system.assign(line.mass, dofs);
  const int total = SharedLine::n * line.ranks + 1;
  const Extremes e = eigenvalue_extremes(system);
  EXPECT_LT(e.least, 1e-12);
  EXPECT_NEAR(e.greatest, 2.0 + 2.0 * std::cos(std::numbers::pi / total), 1e-7);
  const std::vector<double> lumped(static_cast<std::size_t>(dofs.n_owned()), 0.25);
  EXPECT_NEAR(greatest_pencil_eigenvalue(system, lumped), 4.0 * e.greatest, 1e-6);
}

}  // namespace
}  // namespace wisp
