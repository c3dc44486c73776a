// Ghost stabilisation on triangulations: which edges and triangles are penalised.
#pragma once
#include <vector>

#include "stabilise/ghost.h"

namespace wisp {

/// Edges (direction 0) and, for splines, triangles with the edges of their split inside (direction 1).
///
/// `boundary`: as on structured grids, edges between two active triangles of which one is a boundary
/// triangle. `ring`, `ring_all`: A* are the triangles that share a vertex with an active one; B those of A*
/// with a vertex on a triangle that is not active or on a free edge of the grid, or all of A*; penalised are
/// the edges between two of A* of which at least one is in B. The split inside a triangle is penalised in
/// boundary triangles, or B.
std::vector<GhostFacet> triangle_ghost_facets(const Space<2>& space, const ActiveCells& active,
                                              const std::vector<Body<2>>& bodies, const HeldEdges<2>& held,
                                              GhostElements elements);

/// The cells whose functions take part: with `ring` and `ring_all` those of A*, else the active ones.
ActiveCells triangle_ghost_cells(const Space<2>& space, const ActiveCells& active, GhostElements elements);

void add_triangle_ghost_pattern(const Space<2>& space, const std::vector<GhostFacet>& facets,
                                BlockMatrix& matrix);
void add_triangle_ghost(const Space<2>& space, const std::vector<GhostFacet>& facets,
                        const GhostOptions& options, GhostMatrix kind, BlockMatrix& matrix);

}  // namespace wisp
