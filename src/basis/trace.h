// The grid's functions on walls: the polynomials of one cell, also continued beyond it.
#pragma once
#include <array>
#include <span>

#include "basis/space.h"

namespace wisp {

/// Values and gradients (1/m) at a point of the functions of one cell; the first `n` entries count.
template <int dim>
struct CellFunctions {
  static constexpr int max_functions = dim == 2 ? 21 : 8;  // 21: cubic splines
  int n = 0;
  std::array<int, max_functions> function;  ///< local indices
  std::array<double, max_functions> phi;
  std::array<Vec<dim>, max_functions> dphi;

  std::span<const int> functions() const { return {function.data(), static_cast<std::size_t>(n)}; }
};

/// The polynomials that the grid's multilinear functions are in a cell of the window, at a point in the cell
/// or beyond it. GIMP's field between the points is made of the same functions.
template <int dim>
CellFunctions<dim> cell_functions(const Space<dim>& space, const MultiIndex<dim>& cell, const Vec<dim>& x) {
  CellFunctions<dim> out;
  out.n = 1 << dim;
  const auto& strides = space.window().node_strides();
  const int base = space.window().node_index(cell);
  Vec<dim> r, per_h;
  for (int d = 0; d < dim; ++d) {
    per_h[d] = space.grid().per_spacing(d)[cell[d]];
    r[d] = (x[d] - space.grid().line(d, cell[d])) * per_h[d];
  }
  for (int k = 0; k < out.n; ++k) {
    const auto at = static_cast<std::size_t>(k);
    int function = base;
    double phi = 1.0;
    Vec<dim> dphi = Vec<dim>::Ones();
    for (int d = 0; d < dim; ++d) {
      const bool upper = (k >> d) & 1;
      if (upper) function += strides[d];
      const double value = upper ? r[d] : 1.0 - r[d];
      phi *= value;
      for (int e = 0; e < dim; ++e) dphi[e] *= e == d ? (upper ? per_h[d] : -per_h[d]) : value;
    }
    out.function[at] = function, out.phi[at] = phi, out.dphi[at] = dphi;
  }
  return out;
}

/// The sub-triangle of the split (2 edge + side) that holds a point of triangle t; 0 for functions that need
/// no split.
int sub_triangle(const Space<2>& space, int t, const Vec<2>& x);

/// The polynomials that the functions of a triangulation are in a sub-triangle of triangle t, at a point in
/// it or beyond it.
CellFunctions<2> triangle_functions(const Space<2>& space, int t, int sub, const Vec<2>& x);

}  // namespace wisp
