// Monomials and their coefficients in the bases of a triangulation.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "basis/lagrange_quadratic.h"
#include "basis/linear_triangle.h"
#include "basis/powell_sabin_cubic.h"
#include "basis/powell_sabin_quadratic.h"

namespace wisp::basis_test {

/// x^a y^b.
struct Monomial {
  int a, b;
  double operator()(const Vec<2>& x) const { return std::pow(x[0], a) * std::pow(x[1], b); }
  Vec<2> gradient(const Vec<2>& x) const {
    return {a == 0 ? 0.0 : a * std::pow(x[0], a - 1) * std::pow(x[1], b),
            b == 0 ? 0.0 : b * std::pow(x[0], a) * std::pow(x[1], b - 1)};
  }
  /// Blossom (polar form) of the monomial as a polynomial of degree 3: the symmetric form, linear in each
  /// argument, with F[x, x, x] = x^a y^b.
  double blossom(const std::array<Vec<2>, 3>& p) const {
    double sum = 0.0;
    int terms = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) {
          if (i == j || j == k || i == k) continue;
          const int order[3] = {i, j, k};
          double product = 1.0;
          for (int n = 0; n < a + b; ++n) product *= p[static_cast<std::size_t>(order[n])][n < a ? 0 : 1];
          sum += product, ++terms;
        }
    return sum / terms;
  }
};

inline double coefficient(const LinearTriangle& basis, const Monomial& f, int i) {
  return f(basis.control_point(i));
}

inline double coefficient(const LagrangeQuadratic& basis, const Monomial& f, int i) {
  return f(basis.control_point(i));
}

inline double coefficient(const PowellSabinQuadratic& basis, const Monomial& f, int i) {
  const Vec<2>& v = basis.triangulation().vertex(i / 3);
  return f(v) + f.gradient(v).dot(basis.control_point(i) - v);
}

inline double coefficient(const PowellSabinCubic& basis, const Monomial& f, int i) {
  const auto& mesh = basis.triangulation();
  if (i < 3 * mesh.n_vertices()) {
    const Vec<2>& v = mesh.vertex(i / 3);
    return f.blossom({v, v, Vec<2>(3.0 * basis.control_point(i) - 2.0 * v)});
  }
  for (int t = 0; t < mesh.n_triangles(); ++t)
    for (int k = 0; k < 3; ++k)
      for (int side = 0; side < 2; ++side)
        if (basis.corner_function(t, k, side) == i) {
          const Vec<2>& v = mesh.corner(t, k);
          const Vec<2> r = basis.split().edge_point(mesh.edge(t, side == 0 ? k : (k + 2) % 3));
          return f.blossom({v, basis.split().centre(t), Vec<2>(v + basis.corner(t, k).s * (r - v))});
        }
  for (int e = 0; e < mesh.n_edges(); ++e)
    for (int end = 0; end < 2; ++end)
      if (mesh.edge(e).boundary() && basis.edge_function(e, end) == i) {
        const Vec<2> r = basis.split().edge_point(e);
        return f.blossom({mesh.vertex(mesh.edge(e).vertex[static_cast<std::size_t>(end)]), r, r});
      }
  ADD_FAILURE() << "function " << i << " belongs to nothing";
  return 0.0;
}

}  // namespace wisp::basis_test
