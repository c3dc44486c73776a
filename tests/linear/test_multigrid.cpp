// Multigrid on elastic blocks in 3D: the rigid modes keep its iterations from growing with the block.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <iostream>

#include "linear/solver.h"
#include "parallel/session.h"

namespace wisp {
namespace {

/// Stiffness of a cube of trilinear functions with side h, by 2 x 2 x 2 Gauss points; unknowns node by node,
/// nodes with x fastest.
Eigen::Matrix<double, 24, 24> brick(double h, double young, double poisson) {
  const double lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson)),
               mu = young / (2 * (1 + poisson));
  Eigen::Matrix<double, 24, 24> k = Eigen::Matrix<double, 24, 24>::Zero();
  for (int q = 0; q < 8; ++q) {
    Eigen::Vector3d x;
    for (int d = 0; d < 3; ++d) x[d] = 0.5 + ((q >> d) & 1 ? 0.5 : -0.5) / std::sqrt(3.0);
    std::array<Eigen::Vector3d, 8> g;
    for (int a = 0; a < 8; ++a)
      for (int d = 0; d < 3; ++d) {
        double value = ((a >> d) & 1 ? 1.0 : -1.0) / h;
        for (int e = 0; e < 3; ++e)
          if (e != d) value *= (a >> e) & 1 ? x[e] : 1.0 - x[e];
        g[static_cast<std::size_t>(a)][d] = value;
      }
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b) {
        const auto &u = g[static_cast<std::size_t>(a)], &v = g[static_cast<std::size_t>(b)];
        const Eigen::Matrix3d block =
            lambda * u * v.transpose() + mu * v * u.transpose() + mu * u.dot(v) * Eigen::Matrix3d::Identity();
        k.block<3, 3>(3 * a, 3 * b) += h * h * h / 8.0 * block;
      }
  }
  return k;
}

/// A unit cube of n^3 bricks, clamped on the plane x = 0, pulled sideways at a corner.
struct Block {
  int n, nodes;
  BlockMatrix k{3};
  DofMap dofs;
  SystemMatrix system;
  std::vector<double> coordinates, load;

  explicit Block(int size) : n(size), nodes((size + 1) * (size + 1) * (size + 1)) {
    const Eigen::Matrix<double, 24, 24, Eigen::RowMajor> element = brick(1.0 / n, 1e6, 0.3);
    const auto for_each_brick = [&](auto&& f) {
      std::array<int, 8> corners;
      for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
          for (int x = 0; x < n; ++x) {
            for (int a = 0; a < 8; ++a)
              corners[static_cast<std::size_t>(a)] =
                  ((z + (a >> 2)) * (n + 1) + y + ((a >> 1) & 1)) * (n + 1) + x + (a & 1);
            f(std::span<const int>(corners));
          }
    };
    k.begin_pattern(nodes);
    for_each_brick([&](auto corners) { k.add_element(corners); });
    k.end_pattern();
    for_each_brick([&](auto corners) { k.add(corners, element.data()); });
    std::vector<char> fixed(static_cast<std::size_t>(3 * nodes), 0);
    for (int i = 0; i < nodes; ++i) {
      if (i % (n + 1) == 0) std::fill_n(fixed.begin() + 3 * i, 3, 1);
      for (const int c : {i % (n + 1), i / (n + 1) % (n + 1), i / (n + 1) / (n + 1)})
        coordinates.push_back(static_cast<double>(c) / n);
    }
    dofs = DofMap(Halo(nodes), 3, std::vector<char>(static_cast<std::size_t>(nodes), 1), fixed,
                  FixedUnknowns::unit_rows);
    system.assign(k, dofs);
    load.assign(static_cast<std::size_t>(3 * nodes), 0.0);
    load.back() = 1.0;
  }

  /// As an implicit stage would solve it: nothing is said of symmetry, a size beyond the direct solver's.
  SolveReport solve(SolverKind kind, bool with_modes, std::vector<double>& x) const {
    SolverOptions options;
    options.solver = kind;
    MatrixTraits traits{3, false, {}};
    if (with_modes) traits.coordinates = coordinates;
    LinearSolver solver(options, traits);
    x.assign(load.size(), 0.0);
    return solver.solve(system, dofs, Halo(nodes), load, x);
  }
};

TEST(Multigrid, TakesAsManyIterationsForALargeBlockAsForASmallOne) {
  if (Session::size() > 1) GTEST_SKIP() << "the block is one rank's";
  std::vector<double> x, y;
  const Block small(7), large(14);
  const auto few = small.solve(SolverKind::iterative, true, x);
  const auto many = large.solve(SolverKind::automatic, true, y);  // 10,125 unknowns: not a direct solver's
  ASSERT_TRUE(few.solved) << few.cause;
  ASSERT_TRUE(many.solved) << many.cause;
  EXPECT_GT(many.iterations, 1) << "a direct solver was taken";
  EXPECT_LE(many.iterations, few.iterations + few.iterations / 2);
  const auto direct = small.solve(SolverKind::direct, false, y);
  ASSERT_TRUE(direct.solved) << direct.cause;
  double error = 0.0, size = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
    error = std::max(error, std::abs(x[i] - y[i])), size = std::max(size, std::abs(x[i]));
  EXPECT_LT(error, 1e-6 * size);
}

/// Figures for larger blocks, on request: --gtest_also_run_disabled_tests --gtest_filter=Multigrid.*.
TEST(Multigrid, DISABLED_IterationsOverSize) {
  std::vector<double> x;
  for (const int n : {8, 16, 24, 32}) {
    for (const bool modes : {true, false}) {
      const Block block(n);  // its own: a matrix keeps the modes that it was given
      const auto report = block.solve(SolverKind::iterative, modes, x);
      std::cout << 3 * block.nodes << " unknowns, rigid modes " << (modes ? "given" : "not given") << ": "
                << report.iterations << " iterations, residual " << report.residual << " " << report.cause
                << "\n";
    }
  }
}

}  // namespace
}  // namespace wisp
