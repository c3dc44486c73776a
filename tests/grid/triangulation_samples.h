// Triangulations for tests.
#pragma once
#include <rapidcheck.h>

#include <random>

#include "grid/triangulate.h"

namespace wisp::grid_test {

/// Unit square with a Delaunay triangulation of the corners and some random points of the inside.
inline Triangulation random_square(unsigned seed, int inner = 40) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> inside(0.02, 0.98);
  PolygonVertices vertices;
  for (int i = 0; i < inner; ++i) {
    const double x = inside(random);
    vertices.given.emplace_back(x, inside(random));
  }
  return triangulate_polygon(Outline({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}), vertices);
}

/// A square ring.
inline Outline ring_outline() {
  return Outline({{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{1, 1}, {3, 1}, {3, 3}, {1, 3}}});
}

inline StructuredGrid<2> unit_blocks(int nx, int ny) {
  return StructuredGrid<2>(Vec<2>(0, 0), Vec<2>(1, 1), MultiIndex<2>(nx, ny));
}

}  // namespace wisp::grid_test
