// Walls split at grid lines, so that the grid's functions are polynomials on every part.
#pragma once
#include <vector>

#include "geometry/wall_piece.h"
#include "grid/structured.h"

namespace wisp {

/// Gauss points of the part of a wall piece that lies in one cell.
template <int dim>
struct WallPart {
  Vec<dim> middle;        ///< m
  Vec<dim> normal;        ///< unit, into the solid
  MultiIndex<dim> host;   ///< cell of the middle after a nudge of 1e-6 of the shortest side along the normal
  std::size_t first = 0;  ///< of its Gauss points
  std::size_t count = 0;
};

/// A wall cut into parts.
template <int dim>
struct WallCut {
  std::vector<WallPart<dim>> parts;
  std::vector<Vec<dim>> position;  ///< m, of the Gauss points
  std::vector<double> weight;      ///< m2, in 2D m

  void clear() { parts.clear(), position.clear(), weight.clear(); }
};

/// Adds the parts of a piece: segments with 3 Gauss points (exact to degree 5; products of bilinear functions
/// have 4 along a line), in 3D triangles with 6 (degree 4, Dunavant 1985). Parts outside of the grid are
/// kept, with a host outside. A part along a grid line or plane belongs to the cell on its solid side.
template <int dim>
void cut_piece(const StructuredGrid<dim>& grid, const WallPiece<dim>& piece, WallCut<dim>& cut);

}  // namespace wisp
