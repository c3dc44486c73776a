// Points of bodies on triangulations.
#pragma once
#include <filesystem>

#include "grid/triangulation.h"
#include "particle/body.h"
#include "particle/body_options.h"

namespace wisp {

/// All points of a body. Method `cells` puts n² points evenly into every triangle, the centroids of the n²
/// equal triangles that it divides into, `random` n² at random; the triangles are the grid's, of which points
/// outside the shape are left out, or those of the body's own mesh. `gauss` puts three Gauss points into each
/// of n² equal parts of each of the six triangles of the Powell-Sabin split, on which all functions are
/// polynomials. With `clip` or `cuts` the parts of these two are cut and nothing is left out. `divisions`
/// lays rows and columns over the bounding box. Volumes: equal shares of a triangle or box, or the Voronoi
/// cells of the points in the shape. Ids count from `first_id`. `folder`: where relative file names start.
/// Errors (InputError): no point lies in the shape, a point outside the grid, a method that needs a
/// structured grid, Voronoi volumes of a mesh in several pieces.
Body<2> sample(const BodyOptions& options, const Triangulation& grid, std::int64_t first_id,
               const std::filesystem::path& folder);

/// n² points evenly in a triangle, row by row from corner 0.
std::vector<Vec<2>> even_points(const Triangulation& triangulation, int t, int n);

}  // namespace wisp
