// Which functions of a triangulation make up the motion along edges, so that a condition can fix them.
#pragma once
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "basis/spline_conditions.h"
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
/// sorted. Of splines those of `spline_conditions`.
///
/// Errors (InputError): splines at a single vertex, whose functions are not nodal, on edges inside the grid,
/// or on one edge alone at a corner where no side of the control triangle lies on it.
template <class Basis>
std::vector<int> trace_functions(const Basis& basis, const std::vector<int>& edges,
                                 const std::vector<int>& vertices) {
  std::set<int> held;
  if constexpr (Basis::continuity > 0) {
    if (!vertices.empty()) input_error("splines cannot be held at a single vertex; hold an edge");
    const auto conditions =
        spline_conditions(basis, edges, [](int, const Vec<2>&) { return ValueAndGradient(1.0, 0.0, 0.0); });
    if (!conditions.vertices.empty()) {
      const Vec<2>& v = basis.triangulation().vertex(conditions.vertices[0].function[0] / 3);
      input_error(
          "the splines at ({}, {}) cannot be fixed along one edge alone, because the boundary turns there "
          "inwards or by less than 10 degrees; hold both edges, or (where it turns inwards) use "
          "control_triangles = \"corner-sides\" in [basis]",
          v.x(), v.y());
    }
    for (const auto& fixed : conditions.fixed) held.insert(fixed.function);
  } else {
    for (const int e : edges) {
      const auto functions = functions_on_edge(basis, e);
      held.insert(functions.begin(), functions.end());
    }
    held.insert(vertices.begin(), vertices.end());
  }
  return {held.begin(), held.end()};
}

}  // namespace wisp
