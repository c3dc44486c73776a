// Where bodies and walls stand: whether a body lies beside the walls at all, a wall in the grid.
#pragma once
#include <filesystem>
#include <vector>

#include "boundary/wall_options.h"
#include "geometry/region.h"
#include "grid/triangulation.h"
#include "particle/body_options.h"

namespace wisp {

/// Points spread over the inside of a body: those of its file, the middles of its triangles, or the middles
/// of a lattice over its bounding box that lie inside it; none if it is too slender for the lattice. Errors
/// (InputError): those of its shape.
template <int dim>
std::vector<Vec<dim>> points_inside(const BodyOptions& body, const std::filesystem::path& folder);

/// Throws InputError, one line, if no point of `inside`, taken from a body, lies on the solid side of a wall
/// that can hold it: of every plane and obstacle, of any one of the containers, of an open wall if the body
/// is within `reach` (m) of it. Walls with a motion of their own are passed over: they may come from
/// elsewhere.
template <int dim>
void check_beside_walls(const BodyOptions& body, const std::vector<Vec<dim>>& inside,
                        const std::vector<WallOptions>& walls, double reach,
                        const std::filesystem::path& folder);

/// Throws InputError if no part of a wall at rest lies in the grid, which is `within` (m).
template <int dim>
void check_in_grid(const WallOptions& wall, const Block<dim>& within, const std::filesystem::path& folder);

/// Throws InputError if a point of a body lies on no triangle: that part of it would be lost.
void check_on_triangles(const BodyOptions& body, const std::vector<Vec<2>>& inside,
                        const Triangulation& grid);

}  // namespace wisp
