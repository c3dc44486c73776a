#include "stabilise/spline_ghost.h"

namespace wisp {

GhostTriangles ghost_triangles(const Triangulation& triangulation, std::span<const char> populated,
                               GhostRing ring, std::span<const char> free_edge) {
  const auto n = static_cast<std::size_t>(triangulation.n_triangles());
  const auto vertices = static_cast<std::size_t>(triangulation.n_vertices());
  std::vector<char> near_points(vertices, 0), at_edge(vertices, 0);
  for (std::size_t t = 0; t < n; ++t)
    for (const int v : triangulation.triangle(static_cast<int>(t)))
      (populated[t] ? near_points : at_edge)[static_cast<std::size_t>(v)] = 1;
  for (int e = 0; e < triangulation.n_edges(); ++e) {
    const auto& edge = triangulation.edge(e);
    if (edge.boundary() && (free_edge.empty() || free_edge[static_cast<std::size_t>(e)]))
      for (const int v : edge.vertex) at_edge[static_cast<std::size_t>(v)] = 1;
  }
  GhostTriangles result{std::vector<char>(populated.begin(), populated.end()), std::vector<char>(n, 0)};
  for (std::size_t t = 0; t < n; ++t) {
    bool edge = false;
    for (const int v : triangulation.triangle(static_cast<int>(t))) {
      if (ring != GhostRing::populated && near_points[static_cast<std::size_t>(v)]) result.active[t] = 1;
      edge = edge || at_edge[static_cast<std::size_t>(v)];
    }
    result.penalised[t] = result.active[t] && (ring != GhostRing::ring || edge);
  }
  return result;
}

template <class Spline>
void add_ghost_pattern(const Spline& basis, const GhostTriangles& triangles, BlockMatrix& matrix) {
  for_each_ghost_jump(basis, triangles, {}, [&](const auto& jumps) {
    matrix.add_element(std::span(jumps.function).first(jumps.n_functions));
  });
}

template <class Spline>
void add_ghost(const Spline& basis, const GhostTriangles& triangles, const SplineGhost& ghost,
               BlockMatrix& matrix) {
  std::vector<double> dense;
  for_each_ghost_jump(basis, triangles, ghost, [&](const auto& jumps) {
    const std::size_t n = jumps.n_functions;
    dense.assign(n * n, 0.0);
    for (std::size_t r = 0; r < jumps.n_rows; ++r)
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          dense[i * n + j] +=
              ghost.factor * jumps.row[r].weight * jumps.row[r].jump[i] * jumps.row[r].jump[j];
    matrix.add_scalar(std::span(jumps.function).first(n), dense.data());
  });
}

template void add_ghost_pattern(const PowellSabinQuadratic&, const GhostTriangles&, BlockMatrix&);
template void add_ghost_pattern(const PowellSabinCubic&, const GhostTriangles&, BlockMatrix&);
template void add_ghost(const PowellSabinQuadratic&, const GhostTriangles&, const SplineGhost&, BlockMatrix&);
template void add_ghost(const PowellSabinCubic&, const GhostTriangles&, const SplineGhost&, BlockMatrix&);

}  // namespace wisp
