// Jumps of derivatives across edges of triangles and splits: what they feel, and what edges alone do not.
#include "basis/triangle_jumps.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "basis/polynomials.h"
#include "grid/triangulations.h"

namespace wisp {
namespace {

using basis_test::coefficient;
using basis_test::Monomial;

void add(const std::vector<JumpRows>& list, Eigen::MatrixXd& k) {
  for (const auto& rows : list) {
    const std::size_t n = rows.function.size();
    for (std::size_t q = 0; q < rows.weight.size(); ++q)
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          k(rows.function[i], rows.function[j]) +=
              rows.weight[q] * rows.jump[q * n + i] * rows.jump[q * n + j];
  }
}

/// The penalty over all edges between flagged triangles and, if asked, the split edges inside them.
template <class Basis>
Eigen::MatrixXd penalty(const Basis& basis, const std::vector<char>& flagged, bool inside = true) {
  const auto& mesh = basis.triangulation();
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(basis.n_functions(), basis.n_functions());
  for (int e = 0; e < mesh.n_edges(); ++e) {
    const auto& [t, u] = mesh.edge(e).triangle;
    if (u >= 0 && flagged[static_cast<std::size_t>(t)] && flagged[static_cast<std::size_t>(u)])
      add(edge_jumps(basis, e), k);
  }
  for (int t = 0; inside && t < mesh.n_triangles(); ++t)
    if (flagged[static_cast<std::size_t>(t)]) add(inner_jumps(basis, t), k);
  return k;
}

std::vector<char> all_of(const Triangulation& mesh) {
  return std::vector<char>(static_cast<std::size_t>(mesh.n_triangles()), 1);
}

template <class Spline>
struct TriangleJumps : testing::Test {};
using Splines = testing::Types<PowellSabinQuadratic, PowellSabinCubic>;
TYPED_TEST_SUITE(TriangleJumps, Splines);

TYPED_TEST(TriangleJumps, FeelEverythingButPolynomialsOfTheSplinesDegree) {
  // Symmetric, positive semi-definite, and the kernel is exactly the polynomials: 6 or 10 of them.
  constexpr int n_polynomials = TypeParam::degree == 2 ? 6 : 10;
  for (const auto& mesh :
       {grid_test::block(3, 3, 0.25, 4), grid_test::fan(7, 3), grid_test::random_delaunay(12, 2)}) {
    const TypeParam basis(mesh);
    const auto k = penalty(basis, all_of(mesh));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(k);
    const auto& values = eigen.eigenvalues();
    const double largest = values[values.size() - 1];
    EXPECT_GT(values[0], -1e-13 * largest);
    EXPECT_LT(values[n_polynomials - 1], 1e-13 * largest);
    EXPECT_GT(values[n_polynomials], 1e-10 * largest);
    for (int a = 0; a <= TypeParam::degree; ++a)
      for (int b = 0; a + b <= TypeParam::degree; ++b) {
        Eigen::VectorXd c(basis.n_functions());
        for (int i = 0; i < basis.n_functions(); ++i) c[i] = coefficient(basis, Monomial{a, b}, i);
        EXPECT_LT((k * c).norm(), 1e-12 * largest * c.norm());
      }
  }
}

TYPED_TEST(TriangleJumps, OfEdgesBetweenTrianglesAloneLeaveMoreThanPolynomialsUnfelt) {
  // The reason for the split edges inside.
  const auto mesh = grid_test::block(2, 2, 0.25, 4);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(penalty(TypeParam(mesh), all_of(mesh), false));
  EXPECT_LT(eigen.eigenvalues()[10], 1e-12 * eigen.eigenvalues()[eigen.eigenvalues().size() - 1]);
}

TYPED_TEST(TriangleJumps, ScaleWithLengthAsAMassDoes) {
  // Jumps of derivatives shrink as h^-k while the weight grows: J ~ area, like the consistent mass.
  const auto scaled = [](double s) {
    const auto base = grid_test::block(3, 2, 0.2, 8);
    std::vector<Vec<2>> vertices;
    std::vector<std::array<int, 3>> triangles;
    for (int v = 0; v < base.n_vertices(); ++v) vertices.emplace_back(s * base.vertex(v));
    for (int t = 0; t < base.n_triangles(); ++t) triangles.push_back(base.triangle(t));
    const Triangulation mesh(vertices, triangles);
    return penalty(TypeParam(mesh), all_of(mesh));
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

TYPED_TEST(TriangleJumps, HoldAllFunctionsOfABodyHoweverFewTrianglesItHas) {
  // Quadratics with a ring of triangles around the body, cubics on its triangles alone.
  const auto mesh = grid_test::block(6, 6, 0.25, 12);
  const TypeParam basis(mesh);
  for (const int n_triangles : {1, 2, 7}) {
    std::vector<char> populated(static_cast<std::size_t>(mesh.n_triangles()), 0);
    std::vector<int> body{mesh.locate({0.32, 0.48})};
    populated[static_cast<std::size_t>(body[0])] = 1;
    for (std::size_t k = 0; static_cast<int>(body.size()) < n_triangles; ++k)
      for (int side = 0; side < 3 && static_cast<int>(body.size()) < n_triangles; ++side) {
        const int u = mesh.neighbour(body[k], side);
        if (u >= 0 && !populated[static_cast<std::size_t>(u)])
          populated[static_cast<std::size_t>(u)] = 1, body.push_back(u);
      }
    std::vector<char> active = populated;
    if (TypeParam::degree == 2)
      for (const int t : body)
        for (const int v : mesh.triangle(t))
          for (const int u : mesh.triangles_of_vertex(v)) active[static_cast<std::size_t>(u)] = 1;
    const Eigen::MatrixXd both = point_mass(basis, populated, 16, 5) + penalty(basis, active);
    std::vector<char> used(static_cast<std::size_t>(basis.n_functions()), 0);
    for (int t = 0; t < mesh.n_triangles(); ++t)
      if (active[static_cast<std::size_t>(t)])
        for (const int i : basis.functions(t)) used[static_cast<std::size_t>(i)] = 1;
    std::vector<int> list;
    for (int i = 0; i < basis.n_functions(); ++i)
      if (used[static_cast<std::size_t>(i)]) list.push_back(i);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(both(list, list));
    EXPECT_GT(eigen.eigenvalues()[0], 1e-10 * eigen.eigenvalues()[eigen.eigenvalues().size() - 1])
        << n_triangles << " triangles";
  }
}

}  // namespace
}  // namespace wisp
