// The cell whose functions a part of a wall uses.
#pragma once
#include <optional>

#include "basis/trace.h"
#include "boundary/wall_cut.h"
#include "transfer/active.h"

namespace wisp {

/// An active cell beside a part of a wall.
template <int dim>
struct WallHost {
  MultiIndex<dim> cell;       ///< on triangulations (triangle, sub-triangle)
  int number = 0;             ///< of the cell on this rank
  bool extrapolated = false;  ///< it is not the part's own
  double extent = 0.0;        ///< m: its side along the wall's normal, the shortest height of a triangle
};

/// The part's own cell, or where that holds no points the next active one along the normal that is at most
/// one cell's length away. Of a cell outside of the window only the owner knows more: nothing as well.
template <int dim>
std::optional<WallHost<dim>> find_host(const Space<dim>& space, const ActiveCells& active,
                                       const WallPart<dim>& part);

/// The host's polynomials at a point of the wall.
template <int dim>
CellFunctions<dim> functions_at(const Space<dim>& space, const WallHost<dim>& host, const Vec<dim>& x) {
  if constexpr (dim == 2)
    if (!space.structured()) return triangle_functions(space, host.cell[0], host.cell[1], x);
  return cell_functions(space, host.cell, x);
}

/// Whether the functions are smooth splines: what walls ask of Ghost and of their band differs for them.
template <int dim>
bool on_splines(const Space<dim>& space) {
  return !space.structured() &&
         std::visit([](const auto& basis) { return basis.continuity > 0; }, space.basis());
}

/// Whether this rank owns a cell that `WallPart::host` or `WallHost::cell` names.
template <int dim>
bool owns_host(const Space<dim>& space, const MultiIndex<dim>& cell) {
  return space.structured() ? space.window().owns_cell(cell) : cell[0] >= 0;
}

/// Cuts a piece at what bounds the polynomials of the space's functions.
template <int dim>
void cut_piece(const Space<dim>& space, const WallPiece<dim>& piece, WallCut<dim>& cut);

}  // namespace wisp
