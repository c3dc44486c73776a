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

  /// Tabulates points one after the other and remembers the cell of the last one: points of one cell are
  /// located once.
  class Walk {
   public:
    explicit Walk(const Linear& basis) : basis_(basis) {}
    inline __attribute__((always_inline)) Stencil tabulate(const Vec<dim>& x, const Vec<dim>&) {
      bool inside = true;
      for_short<dim>([&](int d) { inside &= (x[d] >= lower_[d]) & (x[d] < upper_[d]); });
      if (!inside) find(x);
      Stencil s;
      for_short<3>([&](int k) { s.stride[k] = basis_.numbering_.stride[k]; });
      s.base = base_;
      for_short<dim>([&](int d) {
        const double r = (x[d] - lower_[d]) * per_h_[d];
        s.value[d] = {1.0 - r, r};
        s.derivative[d] = {-per_h_[d], per_h_[d]};
      });
      return s;
    }

   private:
    inline __attribute__((always_inline)) void find(const Vec<dim>& x) {
      base_ = 0;
      for_short<dim>([&](int d) {
        const int i = basis_.cell(d, x[d]);
        const double* const lines = basis_.grid_->lines(d) + i;
        lower_[d] = lines[0], upper_[d] = lines[1];
        per_h_[d] = basis_.grid_->per_spacing(d)[i];
        base_ += (i - basis_.numbering_.lower[d]) * basis_.numbering_.stride[d];
      });
    }

    const Linear basis_;
    int base_ = 0;
    double lower_[dim] = {}, upper_[dim] = {}, per_h_[dim] = {};  // no point lies in this cell
  };

  /// Stencil at x, which must lie inside the grid. Values in [0, 1], gradients in 1/m.
  inline __attribute__((always_inline)) Stencil tabulate(const Vec<dim>& x, const Vec<dim>& none) const {
    return Walk(*this).tabulate(x, none);
  }

 private:
  inline __attribute__((always_inline)) int cell(int d, double x) const {
    int i = grid_->locate(d, x);
    i = i < grid_->cells(d) ? i : grid_->cells(d) - 1;  // the upper edge belongs to the last cell
    return i > 0 ? i : 0;
  }

  const StructuredGrid<dim>* grid_;
  NodeNumbering<dim> numbering_;
};

}  // namespace wisp
