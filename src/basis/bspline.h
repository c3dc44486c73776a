// Tensor products of B-splines on structured grids.
#pragma once
#include <memory>

#include "basis/knots.h"
#include "basis/stencil.h"
#include "grid/structured.h"

namespace wisp {

/// B-splines of a degree on the lines of a structured grid, with open knot vectors: the grid's edge functions
/// interpolate, the others sit between lines (de Koster 2018, section 3.4). Functions are numbered densely, x
/// fastest, `n_functions(d)` a direction, or as a rank's window asks.
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
      : grid_(&grid), knots_(make_knots(grid, multiplicity)) {
    for (int d = 0; d + 1 < dim; ++d) {
      const auto k = static_cast<std::size_t>(d);
      numbering_.stride[k + 1] = numbering_.stride[k] * n_functions(d);
    }
  }
  /// On a rank's window, all inner lines once: function i of a direction, which starts in cell i - degree,
  /// has the number that a node i has. The window's margin must be at least the degree.
  BSpline(const StructuredGrid<dim>& grid, const NodeNumbering<dim>& numbering)
      : grid_(&grid), numbering_(numbering), knots_(make_knots(grid, {})) {}

  int n_functions(int d) const { return knots(d).n_functions(); }
  /// Without a window.
  int n_functions() const {
    int n = 1;
    for (int d = 0; d < dim; ++d) n *= n_functions(d);
    return n;
  }
  const KnotVector& knots(int d) const { return (*knots_)[static_cast<std::size_t>(d)]; }
  const StructuredGrid<dim>& grid() const { return *grid_; }
  /// Where a coefficient lives: sum of control_point(i) phi_i(x) = x. Of the functions with these numbers in
  /// each direction, or, without a window, of a function.
  Vec<dim> control_point(const MultiIndex<dim>& i) const {
    Vec<dim> x;
    for (int d = 0; d < dim; ++d) x[d] = knots(d).greville(i[d]);
    return x;
  }
  Vec<dim> control_point(int function) const {
    MultiIndex<dim> i;
    for (int d = 0; d < dim; ++d) i[d] = function % n_functions(d), function /= n_functions(d);
    return control_point(i);
  }

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
      knots(d).template evaluate<degree>(i, x[d], s.value[k], s.derivative[k]);
      s.base += (knots(d).first_function(i) - numbering_.lower[k]) * numbering_.stride[k];
    }
    return s;
  }

 private:
  using Knots = std::array<KnotVector, dim>;
  static std::shared_ptr<const Knots> make_knots(const StructuredGrid<dim>& grid,
                                                 const std::array<std::vector<int>, dim>& multiplicity) {
    Knots knots;
    for (int d = 0; d < dim; ++d) {
      const std::vector<double> lines(grid.lines(d), grid.lines(d) + grid.cells(d) + 1);
      knots[static_cast<std::size_t>(d)] =
          KnotVector(degree, lines, multiplicity[static_cast<std::size_t>(d)]);
    }
    return std::make_shared<const Knots>(std::move(knots));
  }

  const StructuredGrid<dim>* grid_;
  NodeNumbering<dim> numbering_;
  std::shared_ptr<const Knots> knots_;  // shared: kernels copy their basis
};

template <class Basis>
inline constexpr bool is_bspline = false;
template <int dim, int degree>
inline constexpr bool is_bspline<BSpline<dim, degree>> = true;

}  // namespace wisp
