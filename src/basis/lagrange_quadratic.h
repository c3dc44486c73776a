// Quadratic Lagrange functions on triangles.
#pragma once
#include "basis/list_stencil.h"
#include "grid/triangulation.h"

namespace wisp {

/// Quadratic functions that are one at a vertex or in the middle of an edge (de Koster 2018, section 3.3).
/// They are negative in places and kinked across edges: the reason for Powell–Sabin splines, kept to show it.
/// Functions of vertices come first, then those of edges.
class LagrangeQuadratic {
 public:
  static constexpr int dimension = 2;
  static constexpr int degree = 2;
  static constexpr int continuity = 0;
  static constexpr bool non_negative = false;
  static constexpr bool uses_domains = false;
  static constexpr int max_functions = 6;
  using Stencil = ListStencil<2, max_functions>;
  using Functions = std::array<int, max_functions>;

  /// `triangulation` must outlive the basis.
  explicit LagrangeQuadratic(const Triangulation& triangulation) : triangulation_(&triangulation) {}

  const Triangulation& triangulation() const { return *triangulation_; }
  int n_functions() const { return triangulation_->n_vertices() + triangulation_->n_edges(); }
  /// Corners, then edges, of triangle t.
  Functions functions(int t) const {
    const auto& v = triangulation_->triangle(t);
    const int n = triangulation_->n_vertices();
    return {v[0],
            v[1],
            v[2],
            n + triangulation_->edge(t, 0),
            n + triangulation_->edge(t, 1),
            n + triangulation_->edge(t, 2)};
  }
  Vec<2> control_point(int function) const {
    const int n = triangulation_->n_vertices();
    if (function < n) return triangulation_->vertex(function);
    const auto& edge = triangulation_->edge(function - n);
    return 0.5 * (triangulation_->vertex(edge.vertex[0]) + triangulation_->vertex(edge.vertex[1]));
  }

  /// Stencil at x, which must lie in the grid; `hint` is a triangle near x.
  Stencil tabulate(const Vec<2>& x, int hint) const {
    return tabulate_in(triangulation_->locate(x, hint), x);
  }
  /// The same with the last triangle as hint: points come in the order of cells.
  Stencil tabulate(const Vec<2>& x, const Vec<2>& /*half_length*/) const {
    last_ = triangulation_->locate(x, last_);
    return tabulate_in(last_, x);
  }
  /// Stencil at a point of triangle t.
  Stencil tabulate_in(int t, const Vec<2>& x) const {
    const auto b = triangulation_->barycentric(t, x);
    const auto gradient = triangulation_->barycentric_gradients(t);
    Stencil s;
    s.cell = t;
    s.function = functions(t);
    const auto set = [&](std::size_t i, double value, const Vec<2>& slope) {
      s.value[i] = value;
      s.derivative[0][i] = slope[0], s.derivative[1][i] = slope[1];
    };
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t j = (k + 1) % 3;
      set(k, b[k] * (2.0 * b[k] - 1.0), (4.0 * b[k] - 1.0) * gradient[k]);
      set(3 + k, 4.0 * b[k] * b[j], 4.0 * (b[k] * gradient[j] + b[j] * gradient[k]));
    }
    return s;
  }

 private:
  const Triangulation* triangulation_;
  mutable int last_ = -1;
};

}  // namespace wisp
