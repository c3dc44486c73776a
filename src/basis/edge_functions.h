// Which functions of a triangulation make up the motion along edges, so that a condition can fix them.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
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

/// By how much the boundary turns at a vertex, rad: 0 where its two edges are on one line.
inline double turn_of_boundary(const Triangulation& mesh, int vertex) {
  std::vector<Vec<2>> away;
  for (const int t : mesh.triangles_of_vertex(vertex))
    for (int k = 0; k < 3; ++k) {
      const auto& edge = mesh.edge(mesh.edge(t, k));
      if (!edge.boundary() || (edge.vertex[0] != vertex && edge.vertex[1] != vertex)) continue;
      const int other = edge.vertex[0] == vertex ? edge.vertex[1] : edge.vertex[0];
      away.push_back((mesh.vertex(other) - mesh.vertex(vertex)).normalized());
    }
  if (away.size() != 2) return 0.0;
  return std::atan2(std::abs(away[0][0] * away[1][1] - away[0][1] * away[1][0]), -away[0].dot(away[1]));
}

/// The functions to fix so that a constant motion is prescribed along `edges` and at single `vertices`,
/// sorted. Of splines those of `spline_conditions`. Where one edge alone is held at a vertex without a side
/// of the control triangle on it, and the boundary turns there by at most 10 degrees either way (a line that
/// is straight but for the rounding of a drawing, or a chord of a curve), all three functions are: the motion
/// along the edge is exact, and at that one vertex its derivative across the edge is that of the prescribed
/// field as well.
///
/// Errors (InputError): splines at a single vertex, whose functions are not nodal, on edges inside the grid,
/// or on one edge alone at a corner that turns inwards by more than 10 degrees.
template <class Basis>
std::vector<int> trace_functions(const Basis& basis, const std::vector<int>& edges,
                                 const std::vector<int>& vertices) {
  std::set<int> held;
  if constexpr (Basis::continuity > 0) {
    if (!vertices.empty()) input_error("splines cannot be held at a single vertex; hold an edge");
    const auto conditions =
        spline_conditions(basis, edges, [](int, const Vec<2>&) { return ValueAndGradient(1.0, 0.0, 0.0); });
    for (const auto& condition : conditions.vertices) {
      const int vertex = condition.function[0] / 3;
      const Vec<2>& v = basis.triangulation().vertex(vertex);
      if (turn_of_boundary(basis.triangulation(), vertex) > 10.01 * std::numbers::pi / 180.0)
        input_error(
            "the splines at ({}, {}) cannot be fixed along one edge alone, because the boundary turns there "
            "inwards; hold both edges, or use control_triangles = \"corner-sides\" in [basis]",
            v.x(), v.y());
      held.insert(condition.function.begin(), condition.function.end());
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
