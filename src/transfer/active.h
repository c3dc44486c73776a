// Which cells the bodies fill, and which functions therefore take part.
#pragma once
#include <vector>

#include "basis/space.h"
#include "particle/body.h"

namespace wisp {

/// One word of bits for each cell of the window: bit b is set if a point of body b, with its domain, overlaps
/// the cell (open intersection; touching by rounding does not count). At most 31 bodies.
struct ActiveCells {
  std::vector<int> bits;
};

/// Marks the cells; owners and ghosts agree. Of a triangulation the triangles in which points lie, as found
/// by `locate`. Collective. Errors (InputError): more than 31 bodies.
template <int dim>
ActiveCells active_cells(const Space<dim>& space, const std::vector<Body<dim>>& bodies);

/// Flags of the functions of active cells (n_functions); owners and ghosts agree. Collective.
template <int dim>
std::vector<char> active_functions(const Space<dim>& space, const ActiveCells& active);

}  // namespace wisp
