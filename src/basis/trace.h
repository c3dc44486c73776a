// The grid's functions on walls: the polynomials of one cell, also continued beyond it.
#pragma once
#include <array>

#include "basis/space.h"

namespace wisp {

/// Values and gradients (1/m) at a point of the functions of one cell.
template <int dim>
struct CellFunctions {
  static constexpr int n = dim == 2 ? 4 : 8;
  std::array<int, n> function;  ///< local indices
  std::array<double, n> phi;
  std::array<Vec<dim>, n> dphi;
};

/// The polynomials that the grid's multilinear functions are in a cell of the window, at a point in the cell
/// or beyond it. GIMP's field between the points is made of the same functions.
template <int dim>
CellFunctions<dim> cell_functions(const Space<dim>& space, const MultiIndex<dim>& cell, const Vec<dim>& x) {
  CellFunctions<dim> out;
  const auto& strides = space.window().node_strides();
  const int base = space.window().node_index(cell);
  Vec<dim> r, per_h;
  for (int d = 0; d < dim; ++d) {
    per_h[d] = space.grid().per_spacing(d)[cell[d]];
    r[d] = (x[d] - space.grid().line(d, cell[d])) * per_h[d];
  }
  for (int k = 0; k < CellFunctions<dim>::n; ++k) {
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

}  // namespace wisp
