// Which functions of a triangulation make up the motion along edges, so that a condition can fix them.
#pragma once
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "core/error.h"
#include "grid/triangulation.h"

namespace wisp {

/// The functions of the triangle at edge e that do not vanish along it.
template <class Basis>
std::vector<int> functions_on_edge(const Basis& basis, int e) {
  const Triangulation& mesh = basis.triangulation();
  const auto& edge = mesh.edge(e);
  std::set<int> functions;
  // A function that vanishes at this many places of every piece of the edge vanishes along it: degree <= 3,
  // two pieces.
  for (int k = 1; k < 16; ++k) {
    const double s = k / 16.0;
    const Vec<2> x = (1.0 - s) * mesh.vertex(edge.vertex[0]) + s * mesh.vertex(edge.vertex[1]);
    basis.tabulate_in(edge.triangle[0], x).for_each([&](int, int i, double phi, const Vec<2>&) {
      if (std::abs(phi) > 1e-11) functions.insert(i);
    });
  }
  return {functions.begin(), functions.end()};
}

/// The functions to fix so that a constant motion is prescribed along `edges` and at single `vertices`,
/// sorted.
///
/// Of splines the three functions of a vertex V take part in the motion along an edge through V only by value
/// and tangential derivative there: two of them, if a side of V's control triangle lies on the edge. Where
/// two edges with a kink at V are held the whole gradient is, and so all three. Errors (InputError): neither
/// is the case; a single vertex of splines, whose functions are not nodal.
template <class Basis>
std::vector<int> trace_functions(const Basis& basis, const std::vector<int>& edges,
                                 const std::vector<int>& vertices) {
  const Triangulation& mesh = basis.triangulation();
  std::set<int> held;
  std::vector<std::vector<Vec<2>>> tangents(static_cast<std::size_t>(mesh.n_vertices()));
  for (const int e : edges)
    for (const int v : mesh.edge(e).vertex)
      tangents[static_cast<std::size_t>(v)].push_back(
          (mesh.vertex(mesh.edge(e).vertex[1]) - mesh.vertex(mesh.edge(e).vertex[0])).normalized());
  for (const int e : edges) {
    const auto functions = functions_on_edge(basis, e);
    held.insert(functions.begin(), functions.end());
    if constexpr (Basis::continuity > 0)
      for (const int v : mesh.edge(e).vertex) {
        const auto of_vertex =
            std::count_if(functions.begin(), functions.end(), [&](int i) { return i / 3 == v; });
        const auto& t = tangents[static_cast<std::size_t>(v)];
        const bool kink = std::any_of(t.begin(), t.end(), [&](const Vec<2>& u) {
          return std::abs(u.x() * t[0].y() - u.y() * t[0].x()) > 1e-9;
        });
        if (of_vertex > 2 && !kink)
          input_error(
              "the splines at ({}, {}) cannot be fixed along one edge alone: the boundary turns there by "
              "less "
              "than 60 degrees or inwards, or the edge is no boundary; hold both edges, or use linear "
              "functions",
              mesh.vertex(v).x(), mesh.vertex(v).y());
      }
  }
  if constexpr (Basis::continuity > 0) {
    if (!vertices.empty()) input_error("splines cannot be held at a single vertex; hold an edge");
  }
  held.insert(vertices.begin(), vertices.end());
  return {held.begin(), held.end()};
}

}  // namespace wisp
