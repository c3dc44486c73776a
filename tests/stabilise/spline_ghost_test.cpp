// The ghost penalty of splines: what it feels and what it does not.
#include "stabilise/spline_ghost.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "basis/polynomials.h"
#include "grid/triangulations.h"

namespace wisp {
namespace {

using basis_test::coefficient;
using basis_test::Monomial;

template <class Spline>
Eigen::MatrixXd ghost_matrix(const Spline& basis, const GhostTriangles& triangles,
                             const SplineGhost& ghost = {}) {
  BlockMatrix matrix;
  matrix.begin_pattern(basis.n_functions());
  add_ghost_pattern(basis, triangles, matrix);
  matrix.end_pattern();
  add_ghost(basis, triangles, ghost, matrix);
  const int n = basis.n_functions();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i)
    for (const int j : matrix.pattern().row(i)) dense(i, j) = matrix.entry(i, 0, j, 0);
  return dense;
}

GhostTriangles everything(const Triangulation& mesh) {
  return ghost_triangles(mesh, std::vector<char>(static_cast<std::size_t>(mesh.n_triangles()), 1),
                         GhostRing::populated);
}

template <class Spline>
struct SplineGhostTest : testing::Test {};
using Splines = testing::Types<PowellSabinQuadratic, PowellSabinCubic>;
TYPED_TEST_SUITE(SplineGhostTest, Splines);

TYPED_TEST(SplineGhostTest, FeelsEverythingButPolynomialsOfTheSplinesDegree) {
  // Symmetric, positive semi-definite, and its kernel is exactly the polynomials: 6 or 10 of them.
  constexpr int n_polynomials = TypeParam::degree == 2 ? 6 : 10;
  for (const auto& mesh :
       {grid_test::block(3, 3, 0.25, 4), grid_test::fan(7, 3), grid_test::random_delaunay(12, 2)})
    for (const JumpLength length : {JumpLength::element, JumpLength::heights})
      for (const double split_share : {1.0, 0.01}) {
        const TypeParam basis(mesh);
        const auto k = ghost_matrix(basis, everything(mesh), {1.0, length, split_share});
        const double largest = k.cwiseAbs().maxCoeff();
        EXPECT_LT((k - k.transpose()).cwiseAbs().maxCoeff(), 1e-14 * largest);
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(k);
        const auto& values = eigen.eigenvalues();
        EXPECT_GT(values[0], -1e-13 * values[values.size() - 1]);
        EXPECT_LT(values[n_polynomials - 1], 1e-13 * values[values.size() - 1]);
        EXPECT_GT(values[n_polynomials], 1e-10 * values[values.size() - 1]);
        for (int a = 0; a <= TypeParam::degree; ++a)
          for (int b = 0; a + b <= TypeParam::degree; ++b) {
            Eigen::VectorXd c(basis.n_functions());
            for (int i = 0; i < basis.n_functions(); ++i) c[i] = coefficient(basis, Monomial{a, b}, i);
            EXPECT_LT(std::sqrt(std::abs(c.dot(k * c))), 1e-6 * std::sqrt(largest) * c.norm());
            EXPECT_LT((k * c).norm(), 1e-12 * largest * c.norm());
          }
      }
}

TYPED_TEST(SplineGhostTest, EdgesBetweenTrianglesAloneLeaveMoreThanPolynomialsUnfelt) {
  // The reason for the split edges inside.
  const auto mesh = grid_test::block(2, 2, 0.25, 4);
  const TypeParam basis(mesh);
  const int n = basis.n_functions();
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
  for (int e = 0; e < mesh.n_edges(); ++e) {
    if (mesh.edge(e).boundary()) continue;
    const auto jumps = edge_jumps(basis, e);
    for (std::size_t r = 0; r < jumps.n_rows; ++r)
      for (std::size_t i = 0; i < jumps.n_functions; ++i)
        for (std::size_t j = 0; j < jumps.n_functions; ++j)
          k(jumps.function[i], jumps.function[j]) +=
              jumps.row[r].weight * jumps.row[r].jump[i] * jumps.row[r].jump[j];
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(k);
  EXPECT_LT(eigen.eigenvalues()[10], 1e-12 * eigen.eigenvalues()[n - 1]);
}

TYPED_TEST(SplineGhostTest, ScalesWithLengthAsAMassDoes) {
  // Jumps of derivatives shrink as h^-k while the weight grows: J ~ area, like the consistent mass.
  const auto scaled = [](double s) {
    const auto base = grid_test::block(3, 2, 0.2, 8);
    std::vector<Vec<2>> vertices;
    std::vector<std::array<int, 3>> triangles;
    for (int v = 0; v < base.n_vertices(); ++v) vertices.emplace_back(s * base.vertex(v));
    for (int t = 0; t < base.n_triangles(); ++t) triangles.push_back(base.triangle(t));
    const Triangulation mesh(vertices, triangles);
    const TypeParam basis(mesh);
    return ghost_matrix(basis, everything(mesh));
  };
  const Eigen::MatrixXd one = scaled(1.0), large = scaled(1000.0);
  EXPECT_LT((large * 1e-6 - one).cwiseAbs().maxCoeff(), 1e-9 * one.cwiseAbs().maxCoeff());
}

/// Consistent mass of points in some triangles, density one.
template <class Spline>
Eigen::MatrixXd point_mass(const Spline& basis, const std::vector<char>& populated, int points,
                           unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const int n = basis.n_functions();
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n, n);
  const auto& mesh = basis.triangulation();
  for (int t = 0; t < mesh.n_triangles(); ++t) {
    if (!populated[static_cast<std::size_t>(t)]) continue;
    for (int p = 0; p < points; ++p) {
      double a = unit(random), b = unit(random);
      if (a + b > 1.0) a = 1.0 - a, b = 1.0 - b;
      const auto s = basis.tabulate_in(t, mesh.point(t, {a, b, 1.0 - a - b}));
      s.for_each([&](int, int i, double phi, const Vec<2>&) {
        s.for_each(
            [&](int, int j, double psi, const Vec<2>&) { mass(i, j) += mesh.area(t) / points * phi * psi; });
      });
    }
  }
  return mass;
}

TYPED_TEST(SplineGhostTest, HoldsAllFunctionsOfABodyHoweverFewTrianglesItHas) {
  const auto mesh = grid_test::block(6, 6, 0.25, 12);
  const TypeParam basis(mesh);
  for (const GhostRing ring : {GhostRing::ring, GhostRing::ringall, GhostRing::populated})
    for (const int n_triangles : {1, 2, 7}) {
      std::vector<char> populated(static_cast<std::size_t>(mesh.n_triangles()), 0);
      const int start = mesh.locate({0.32, 0.48});
      populated[static_cast<std::size_t>(start)] = 1;
      std::vector<int> body{start};
      for (std::size_t k = 0; static_cast<int>(body.size()) < n_triangles; ++k)
        for (int side = 0; side < 3 && static_cast<int>(body.size()) < n_triangles; ++side) {
          const int u = mesh.neighbour(body[k], side);
          if (u >= 0 && !populated[static_cast<std::size_t>(u)])
            populated[static_cast<std::size_t>(u)] = 1, body.push_back(u);
        }
      const auto triangles = ghost_triangles(mesh, populated, ring);
      const Eigen::MatrixXd both = point_mass(basis, populated, 16, 5) + ghost_matrix(basis, triangles);
      std::vector<char> active(static_cast<std::size_t>(basis.n_functions()), 0);
      for (int t = 0; t < mesh.n_triangles(); ++t)
        if (triangles.active[static_cast<std::size_t>(t)])
          for (const int i : basis.functions(t)) active[static_cast<std::size_t>(i)] = 1;
      std::vector<int> list;
      for (int i = 0; i < basis.n_functions(); ++i)
        if (active[static_cast<std::size_t>(i)]) list.push_back(i);
      const Eigen::MatrixXd reduced = both(list, list);
      // Nothing reaches beyond the active functions, and none of those is left without mass.
      EXPECT_NEAR(reduced.cwiseAbs().sum(), both.cwiseAbs().sum(), 1e-12 * both.cwiseAbs().sum());
      if (TypeParam::degree == 3 && ring != GhostRing::populated)
        continue;  // functions of the ring's outer edges
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(reduced);
      EXPECT_GT(eigen.eigenvalues()[0], 1e-10 * eigen.eigenvalues()[eigen.eigenvalues().size() - 1])
          << static_cast<int>(ring) << ", " << n_triangles << " triangles";
    }
}

TEST(GhostTriangles, RingsAroundABody) {
  // Six by six blocks of two triangles; points fill the blocks of the middle four by four.
  const auto mesh = grid_test::block(6, 6, 0.0, 0);
  std::vector<char> populated;
  for (int t = 0; t < mesh.n_triangles(); ++t) {
    const int i = t / 2 % 6, j = t / 12;
    populated.push_back(i >= 1 && i <= 4 && j >= 1 && j <= 4);
  }
  const auto count = [](const std::vector<char>& flags) { return std::count(flags.begin(), flags.end(), 1); };
  const auto none = ghost_triangles(mesh, populated, GhostRing::populated);
  EXPECT_EQ(none.active, populated);
  EXPECT_EQ(none.penalised, populated);
  const auto all = ghost_triangles(mesh, populated, GhostRing::ringall);
  for (int t = 0; t < mesh.n_triangles(); ++t) {
    bool touches = false;
    for (const int v : mesh.triangle(t))
      for (const int u : mesh.triangles_of_vertex(v))
        touches = touches || populated[static_cast<std::size_t>(u)];
    EXPECT_EQ(all.active[static_cast<std::size_t>(t)] != 0, touches);
  }
  EXPECT_EQ(all.active, all.penalised);
  const auto ring = ghost_triangles(mesh, populated, GhostRing::ring);
  EXPECT_EQ(ring.active, all.active);
  EXPECT_EQ(count(all.active) - count(ring.penalised), 8);  // the inner two by two blocks are left alone
}

TEST(GhostTriangles, OnlyFreeEdgesOfTheGridCountAsTheEdgeOfTheBody) {
  const auto mesh = grid_test::block(4, 4, 0.0, 0);
  const std::vector<char> populated(static_cast<std::size_t>(mesh.n_triangles()), 1);
  std::vector<char> free_edge(static_cast<std::size_t>(mesh.n_edges()), 0);
  const auto held = ghost_triangles(mesh, populated, GhostRing::ring, free_edge);
  EXPECT_EQ(std::count(held.penalised.begin(), held.penalised.end(), 1), 0);
  const auto open = ghost_triangles(mesh, populated, GhostRing::ring);
  EXPECT_EQ(std::count(open.penalised.begin(), open.penalised.end(), 1), 24);
}

}  // namespace
}  // namespace wisp
