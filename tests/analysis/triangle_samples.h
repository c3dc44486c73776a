// Cases on triangulations for the tests of analyses.
#pragma once
#include <random>

#include "analysis/fixtures.h"
#include "geometry/polygon.h"

namespace wisp::analysis_test {

inline std::vector<AnyBasisOptions> triangle_bases() {
  return {LinearOptions{}, LagrangeQuadraticOptions{}, PowellSabinOptions{}, PowellSabinCubicOptions{}};
}

/// A rectangle turned by an angle about its lower corner.
inline Polygon turned_rectangle(const Vec<2>& lower, const Vec<2>& upper, double angle) {
  Polygon p;
  const double c = std::cos(angle), s = std::sin(angle);
  for (const auto& [x, y] :
       {std::pair{lower[0], lower[1]}, {upper[0], lower[1]}, {upper[0], upper[1]}, {lower[0], upper[1]}})
    p.vertices.push_back({c * x - s * y, s * x + c * y});
  return p;
}

/// An irregular Delaunay triangulation of a rectangle.
inline ModelOptions on_triangles(const Vec<2>& lower, const Vec<2>& upper, double spacing,
                                 const AnyBasisOptions& basis = LinearOptions{}, int seed = 1) {
  ModelOptions o;
  DelaunayOptions grid;
  grid.outline = turned_rectangle(lower, upper, 0.0);
  grid.spacing = spacing, grid.irregularity = 0.25, grid.seed = seed;
  o.triangulation = grid;
  o.basis = basis;
  return o;
}

/// Blocks of four triangles.
inline ModelOptions on_blocks(const Vec<2>& lower, const Vec<2>& upper, int nx, int ny,
                              const AnyBasisOptions& basis = LinearOptions{}) {
  ModelOptions o;
  TriangleBlocksOptions grid;
  grid.lower = {lower[0], lower[1]}, grid.upper = {upper[0], upper[1]}, grid.cells = {nx, ny};
  o.triangulation = grid;
  o.basis = basis;
  return o;
}

/// Fixes directions on a named boundary.
inline ConformingOptions& hold_part(ModelOptions& o, const std::string& part, const std::string& directions) {
  ConformingOptions c;
  c.label = part, c.part = part;
  for (const char d : directions) c.directions.emplace_back(1, d);
  return std::get<ConformingOptions>(o.boundaries.emplace_back(c));
}

}  // namespace wisp::analysis_test
