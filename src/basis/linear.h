// Linear (hat) functions: the standard material point method.
#pragma once
#include "basis/options.h"
#include "basis/stencil.h"
#include "grid/structured.h"

namespace wisp {

/// Multilinear functions of a structured grid; points are concentrated (Sulsky, Chen and Schreyer 1994). A
/// point on a grid line belongs to the cell above it, and takes values and gradients both from there.
template <int dim>
class Linear : public LinearOptions {
 public:
  static constexpr int width = 2;
  static constexpr int degree = 1;
  static constexpr int continuity = 0;
  static constexpr bool non_negative = true;
  static constexpr bool uses_domains = false;
  using Stencil = TensorStencil<dim, width>;

  Linear(const StructuredGrid<dim>& grid, const NodeNumbering<dim>& numbering)
      : grid_(&grid), numbering_(numbering) {}

  /// Stencil at x, which must lie inside the grid. Values in [0, 1], gradients in 1/m.
  inline __attribute__((always_inline)) Stencil tabulate(const Vec<dim>& x,
                                                         const Vec<dim>& /*half_length*/) const {
    Stencil s;
    s.stride = numbering_.stride;
    s.base = 0;
    for (int d = 0; d < dim; ++d) {
      const auto k = static_cast<std::size_t>(d);
      int i = grid_->locate(d, x[d]);
      i = i < grid_->cells(d) ? i : grid_->cells(d) - 1;  // the upper edge belongs to the last cell
      i = i > 0 ? i : 0;
      const double* lines = grid_->lines(d);
      const double per_h = grid_->per_spacing(d)[i];
      const double r = (x[d] - lines[i]) * per_h;
      s.value[k] = {1.0 - r, r};
      s.derivative[k] = {-per_h, per_h};
      s.base += (i - numbering_.lower[k]) * s.stride[k];
    }
    return s;
  }

 private:
  const StructuredGrid<dim>* grid_;
  NodeNumbering<dim> numbering_;
};

}  // namespace wisp
