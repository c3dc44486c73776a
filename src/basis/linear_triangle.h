// Linear functions on triangles.
#pragma once
#include "basis/list_stencil.h"
#include "grid/triangulation.h"

namespace wisp {

/// Hat functions of a triangulation: barycentric coordinates. Function v belongs to vertex v.
class LinearTriangle {
 public:
  static constexpr int dimension = 2;
  static constexpr int degree = 1;
  static constexpr int continuity = 0;
  static constexpr bool non_negative = true;
  static constexpr bool uses_domains = false;
  static constexpr int max_functions = 3;
  using Stencil = ListStencil<2, max_functions>;
  using Functions = std::array<int, max_functions>;

  /// `triangulation` must outlive the basis.
  explicit LinearTriangle(const Triangulation& triangulation) : triangulation_(&triangulation) {}

  const Triangulation& triangulation() const { return *triangulation_; }
  int n_functions() const { return triangulation_->n_vertices(); }
  const Functions& functions(int t) const { return triangulation_->triangle(t); }
  const Vec<2>& control_point(int function) const { return triangulation_->vertex(function); }

  /// Stencil at x, which must lie in the grid; `hint` is a triangle near x.
  Stencil tabulate(const Vec<2>& x, int hint) const {
    return tabulate_in(triangulation_->locate(x, hint), x);
  }
  /// Stencil at a point of triangle t.
  Stencil tabulate_in(int t, const Vec<2>& x) const {
    const auto b = triangulation_->barycentric(t, x);
    const auto gradient = triangulation_->barycentric_gradients(t);
    Stencil s;
    s.cell = t;
    s.function = functions(t);
    for (std::size_t k = 0; k < 3; ++k) {
      s.value[k] = b[k] > 0.0 ? b[k] : 0.0;  // on edges rounding must not make it negative
      s.derivative[0][k] = gradient[k][0], s.derivative[1][k] = gradient[k][1];
    }
    return s;
  }

 private:
  const Triangulation* triangulation_;
};

}  // namespace wisp
