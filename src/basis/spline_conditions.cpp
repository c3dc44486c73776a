#include "basis/spline_conditions.h"

#include <cmath>
#include <map>

#include "core/error.h"

namespace wisp {

namespace {

/// What the edges at a vertex ask for: at most two directions with the field's slope along each.
struct AtVertex {
  double value = 0.0;
  std::vector<Vec<2>> along;
  std::vector<double> slope;
};

/// Two edges on one line ask for the same thing.
constexpr double straight = 1e-9;

double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

void add_direction(AtVertex& at, const Vec<2>& along, double slope) {
  for (const auto& known : at.along)
    if (std::abs(cross(known, along)) < straight) return;
  at.along.push_back(along), at.slope.push_back(slope);
}

/// value and slope along a direction: by the two functions on the boundary line if there are two.
template <class Spline>
void add_line(const Spline& basis, int vertex, const AtVertex& at, bool by_control_points,
              SplineConditions& conditions) {
  const Vec<2>& v = basis.triangulation().vertex(vertex);
  const Vec<2>& along = at.along[0];
  const auto& triangle = basis.control_triangle(vertex);
  const double size = std::sqrt(signed_area(triangle));
  std::vector<FixedCoefficient> on_line;
  for (int q = 0; q < 3; ++q) {
    const Vec<2> arm = triangle[static_cast<std::size_t>(q)] - v;
    if (std::abs(cross(along, arm)) < straight * size)
      on_line.push_back({3 * vertex + q, at.value + at.slope[0] * along.dot(arm)});
  }
  if (by_control_points && on_line.size() == 2) {
    conditions.fixed.insert(conditions.fixed.end(), on_line.begin(), on_line.end());
    return;
  }
  // c = f(V) + g . (Q - V) for any gradient g with the given part along the edge.
  VertexCondition condition;
  const Vec<2> across(-along[1], along[0]);
  double norm = 0.0;
  for (std::size_t q = 0; q < 3; ++q) {
    condition.function[q] = 3 * vertex + static_cast<int>(q);
    condition.constant[q] = at.value + at.slope[0] * along.dot(triangle[q] - v);
    condition.slope[q] = across.dot(triangle[q] - v);
    norm = std::hypot(norm, condition.slope[q]);
  }
  for (double& s : condition.slope) s /= norm;
  conditions.vertices.push_back(condition);
}

}  // namespace

template <class Spline>
SplineConditions spline_conditions(const Spline& basis, std::span<const int> edges,
                                   const BoundaryField& field, bool by_control_points) {
  const auto& mesh = basis.triangulation();
  std::map<int, AtVertex> vertices;
  SplineConditions conditions;
  for (const int e : edges) {
    if (e < 0 || e >= mesh.n_edges() || !mesh.edge(e).boundary())
      input_error("edge {} is not on the boundary: essential conditions of splines need boundary edges", e);
    const auto& ends = mesh.edge(e).vertex;
    const Vec<2> along = (mesh.vertex(ends[1]) - mesh.vertex(ends[0])).normalized();
    for (int end = 0; end < 2; ++end) {
      const int v = ends[static_cast<std::size_t>(end)];
      const auto f = field(e, mesh.vertex(v));
      auto& at = vertices[v];
      at.value = f.value;
      add_direction(at, along, along[0] * f.x + along[1] * f.y);
      if constexpr (Spline::degree == 3) {
        // Blossom [V, R, R] of the field's cubic along the edge.
        const Vec<2> r = basis.split().edge_point(e), third = (mesh.vertex(v) - r) / 3.0;
        const auto middle = field(e, r);
        conditions.fixed.push_back(
            {basis.edge_function(e, end), middle.value + middle.x * third[0] + middle.y * third[1]});
      }
    }
  }
  for (const auto& [v, at] : vertices) {
    if (at.along.size() == 1) {
      add_line(basis, v, at, by_control_points, conditions);
      continue;
    }
    Mat<2> along;
    along << at.along[0].transpose(), at.along[1].transpose();
    const Vec<2> gradient = along.inverse() * Vec<2>(at.slope[0], at.slope[1]);
    for (int q = 0; q < 3; ++q) {
      const Vec<2> arm = basis.control_triangle(v)[static_cast<std::size_t>(q)] - mesh.vertex(v);
      conditions.fixed.push_back({3 * v + q, at.value + gradient.dot(arm)});
    }
  }
  return conditions;
}

template SplineConditions spline_conditions(const PowellSabinQuadratic&, std::span<const int>,
                                            const BoundaryField&, bool);
template SplineConditions spline_conditions(const PowellSabinCubic&, std::span<const int>,
                                            const BoundaryField&, bool);

}  // namespace wisp
