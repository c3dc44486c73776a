// Triangulations on which splits and bases have to keep their promises.
#pragma once
#include <cmath>
#include <random>
#include <vector>

#include "geometry/delaunay.h"
#include "grid/triangulation.h"

namespace wisp::grid_test {

/// The rectangle [-0.2, 0.8] x [0.1, 0.9] in nx x ny blocks of two triangles each; inner vertices moved by up
/// to `shift` of a block, diagonals and shifts chosen by the seed. Corner blocks are cut towards the corner's
/// inside, or all one way without a shift.
inline Triangulation block(int nx, int ny, double shift, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Vec<2>> vertices;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      Vec<2> x(-0.2 + 1.0 * i / nx, 0.1 + 0.8 * j / ny);
      const double dx = unit(random) * shift / nx, dy = unit(random) * shift / ny;
      if (i == nx) x[0] = 0.8;
      if (j == ny) x[1] = 0.9;
      if (i > 0 && i < nx) x[0] += dx;
      if (j > 0 && j < ny) x[1] += dy;
      vertices.push_back(x);
    }
  std::vector<std::array<int, 3>> triangles;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int a = j * (nx + 1) + i, b = a + 1, c = a + nx + 2, d = a + nx + 1;
      if (shift > 0.0 && unit(random) > 0.0)
        triangles.push_back({a, b, d}), triangles.push_back({b, c, d});
      else
        triangles.push_back({a, b, c}), triangles.push_back({a, c, d});
    }
  return Triangulation(vertices, triangles);
}

/// An L of blocks with a re-entrant corner at the origin, inner vertices moved.
inline Triangulation l_shape(int n, double shift, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Vec<2>> vertices;
  std::vector<std::vector<int>> number(static_cast<std::size_t>(2 * n + 1),
                                       std::vector<int>(static_cast<std::size_t>(2 * n + 1), -1));
  const auto at = [&](int i, int j) -> int& {
    return number[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  };
  for (int j = 0; j <= 2 * n; ++j)
    for (int i = 0; i <= 2 * n; ++i) {
      if (i > n && j > n) continue;
      const bool edge = i == 0 || j == 0 || i == 2 * n || j == 2 * n || (i >= n && j >= n);
      Vec<2> x(-1.0 + 1.0 * i / n, -1.0 + 1.0 * j / n);
      const double dx = unit(random) * shift / n, dy = unit(random) * shift / n;
      if (!edge) x += Vec<2>(dx, dy);
      at(i, j) = static_cast<int>(vertices.size());
      vertices.push_back(x);
    }
  std::vector<std::array<int, 3>> triangles;
  for (int j = 0; j < 2 * n; ++j)
    for (int i = 0; i < 2 * n; ++i) {
      if (i >= n && j >= n) continue;
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return Triangulation(vertices, triangles);
}

/// A fan around the origin whose rim is a polygon with blunt corners of different sizes.
inline Triangulation fan(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.8, 1.2);
  std::vector<Vec<2>> vertices{{0.0, 0.0}};
  std::vector<std::array<int, 3>> triangles;
  for (int k = 0; k < n; ++k) {
    const double r = unit(random), angle = 2.0 * M_PI * (k + 0.2 * unit(random)) / n;
    vertices.emplace_back(r * std::cos(angle), r * std::sin(angle));
    triangles.push_back({0, 1 + k, 1 + (k + 1) % n});
  }
  return Triangulation(vertices, triangles);
}

/// The unit square: the Delaunay triangulation of its corners, points on its sides and `n` inside, all at
/// random but not closer than a distance that keeps triangles from getting too flat.
inline Triangulation random_delaunay(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double apart = 0.5 / std::sqrt(n);
  std::vector<Vec<2>> points{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int trial = 0; trial < 40 * n; ++trial) {
    Vec<2> x(unit(random), unit(random));
    const bool on_side = trial % 4 == 0;
    if (on_side) x[trial / 4 % 2] = trial / 8 % 2;
    bool close = !on_side && std::min(x.minCoeff(), 1.0 - x.maxCoeff()) < 0.5 * apart;
    for (const auto& p : points) close = close || (p - x).norm() < apart;
    if (!close) points.push_back(x);
  }
  return Triangulation(points, delaunay(points));
}

inline std::vector<Triangulation> meshes() {
  std::vector<Triangulation> list;
  list.push_back(Triangulation({{0.0, 0.0}, {2.0, 0.3}, {0.4, 1.1}}, {{0, 1, 2}}));
  list.push_back(block(2, 2, 0.0, 0));
  list.push_back(block(4, 3, 0.25, 5));
  for (unsigned seed = 1; seed < 5; ++seed) list.push_back(block(5, 5, 0.33, seed));
  list.push_back(block(9, 2, 0.3, 7));
  list.push_back(l_shape(2, 0.25, 3));
  list.push_back(fan(5, 1));
  list.push_back(fan(9, 2));
  for (unsigned seed = 1; seed < 7; ++seed) list.push_back(random_delaunay(30, seed));
  return list;
}

}  // namespace wisp::grid_test
