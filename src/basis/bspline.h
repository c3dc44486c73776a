// Tensor products of B-splines on structured grids.
#pragma once
#include "basis/knots.h"
#include "basis/stencil.h"
#include "core/error.h"
#include "grid/structured.h"

namespace wisp {

/// B-splines of a degree on the lines of a structured grid, with open knot vectors: the grid's edge functions
/// interpolate, the others sit between lines (de Koster 2018, section 3.4). Functions are numbered densely, x
/// fastest, `n_functions(d)` a direction.
template <int dim, int degree_>
class BSpline {
 public:
  static constexpr int dimension = dim;
  static constexpr int width = degree_ + 1;
  static constexpr int degree = degree_;
  static constexpr int continuity = degree_ - 1;
  static constexpr bool non_negative = true;
  static constexpr bool uses_domains = false;
  using Stencil = TensorStencil<dim, width>;

  /// @param multiplicity of the inner lines of each direction; empty: all once
  explicit BSpline(const StructuredGrid<dim>& grid,
                   const std::array<std::vector<int>, dim>& multiplicity = {})
      : grid_(&grid) {
    stride_ = {1, 0, 0};
    for (int d = 0; d < dim; ++d) {
      const auto k = static_cast<std::size_t>(d);
      std::vector<double> lines(grid.lines(d), grid.lines(d) + grid.cells(d) + 1);
      knots_[k] = KnotVector(degree, lines, multiplicity[k]);
      if (d + 1 < dim) stride_[k + 1] = stride_[k] * n_functions(d);
    }
  }

  int n_functions(int d) const { return knots_[static_cast<std::size_t>(d)].n_functions(); }
  int n_functions() const {
    int n = 1;
    for (int d = 0; d < dim; ++d) n *= n_functions(d);
    return n;
  }
  const KnotVector& knots(int d) const { return knots_[static_cast<std::size_t>(d)]; }
  const StructuredGrid<dim>& grid() const { return *grid_; }
  /// Where a coefficient lives: sum of control_point(i) phi_i(x) = x.
  Vec<dim> control_point(int function) const {
    Vec<dim> x;
    for (int d = 0; d < dim; ++d) {
      x[d] = knots(d).greville(function % n_functions(d));
      function /= n_functions(d);
    }
    return x;
  }

  /// Stencil at x, which must lie inside the grid. Values in [0, 1], gradients in 1/m.
  inline __attribute__((always_inline)) Stencil tabulate(const Vec<dim>& x,
                                                         const Vec<dim>& /*half_length*/) const {
    Stencil s;
    s.stride = stride_;
    s.base = 0;
    for (int d = 0; d < dim; ++d) {
      const auto k = static_cast<std::size_t>(d);
      int i = grid_->locate(d, x[d]);
      i = i < grid_->cells(d) ? i : grid_->cells(d) - 1;  // the upper edge belongs to the last cell
      i = i > 0 ? i : 0;
      knots_[k].template evaluate<degree>(i, x[d], s.value[k], s.derivative[k]);
      s.base += knots_[k].first_function(i) * stride_[k];
    }
    return s;
  }

 private:
  const StructuredGrid<dim>* grid_;
  std::array<KnotVector, dim> knots_;
  std::array<int, 3> stride_{};
};

}  // namespace wisp
