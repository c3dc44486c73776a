// The function that chapter 3 of de Koster 2018 projects, and its grids.
#pragma once
#include <cmath>
#include <numbers>
#include <random>

#include "geometry/delaunay.h"
#include "grid/triangulate.h"

namespace wisp::spline_thesis {

/// sin(pi x) sin(pi y) on the unit square (eq. 3.65); the integral of its square is 1/4.
inline double double_sine(const Vec<2>& x) {
  return std::sin(std::numbers::pi * x[0]) * std::sin(std::numbers::pi * x[1]);
}

/// The unit square with n x n vertices, every square cut by the same diagonal (figure 3.25).
inline Triangulation unit_square(int n) {
  return triangulate_blocks(StructuredGrid<2>({0, 0}, {1, 1}, {n - 1, n - 1}), BlockSplit::two);
}

/// The Delaunay triangulation of the same vertices, the inner ones shifted at random by up to 0.3 of their
/// distance, those on the sides along them.
inline Triangulation shifted_square(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-0.3 / (n - 1), 0.3 / (n - 1));
  std::vector<Vec<2>> vertices;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double dx = shift(random), dy = shift(random);
      vertices.emplace_back(i / (n - 1.0) + (i > 0 && i < n - 1 ? dx : 0.0),
                            j / (n - 1.0) + (j > 0 && j < n - 1 ? dy : 0.0));
    }
  return Triangulation(vertices, delaunay(vertices));
}

}  // namespace wisp::spline_thesis
