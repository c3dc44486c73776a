// Walls split at grid lines, so that the grid's functions are polynomials on every part.
#pragma once
#include <vector>

#include "geometry/wall_piece.h"
#include "grid/powell_sabin_split.h"
#include "grid/structured.h"

namespace wisp {

/// Gauss points of the part of a wall piece that lies in one cell.
template <int dim>
struct WallPart {
  Vec<dim> middle;        ///< m
  Vec<dim> normal;        ///< unit, into the solid
  MultiIndex<dim> host;   ///< cell of the middle after a nudge of 1e-6 of the shortest side along the normal;
                          ///< on triangulations (triangle, sub-triangle), (-1, 0) outside of the grid
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

/// The same at the edges of triangles and, if there is one, of the sub-triangles of their split, with 3 Gauss
/// points or 4 (exact to degree 7: products of cubic functions have 6).
void cut_piece(const Triangulation& mesh, const PowellSabinSplit* split, int points,
               const WallPiece<2>& piece, WallCut<2>& cut);

/// Adds one part with `points` (3 or 4) Gauss points.
void add_part(const Vec<2>& a, const Vec<2>& b, const Vec<2>& normal, const MultiIndex<2>& host, int points,
              WallCut<2>& cut);

}  // namespace wisp
