// Triangulations from blocks, polygons and case files.
#pragma once
#include <filesystem>
#include <string>

#include "geometry/outline.h"
#include "grid/structured.h"
#include "grid/triangulation.h"
#include "grid/triangulation_options.h"

namespace wisp {

/// Splits every cell of a grid; names the boundaries left, right, bottom, top.
Triangulation triangulate_blocks(const StructuredGrid<2>& blocks, BlockSplit split);

/// Which vertices a polygon is triangulated with, besides its corners.
struct PolygonVertices {
  double spacing = 0.0;       ///< m, of generated vertices on the sides and inside; 0: none
  std::vector<Vec<2>> given;  ///< inside or on the sides
  double irregularity = 0.0;  ///< share of the spacing by which inner vertices are shifted; 0: smoothed
  unsigned seed = 1;
};

/// Delaunay triangulation of a polygon with holes. Generated vertices divide the sides and fill the inside in
/// rows; sides that are no edges are divided further. Names the boundaries outer, hole 1, ... and side 1, ...
/// of the outer ring in its order. Errors (InputError): a given vertex outside or twice.
Triangulation triangulate_polygon(const Outline& outline, const PolygonVertices& vertices);

/// From a case file; `folder`: where relative file names start. Errors: InputError.
Triangulation make_triangulation(const AnyTriangulationOptions& options, const std::filesystem::path& folder);

/// One line on size and quality: numbers, smallest angle, shortest height.
std::string quality_line(const Triangulation& triangulation);
/// A warning about slivers, triangles with an angle below 5 degrees: how many and where; empty if there are
/// none.
std::string sliver_warning(const Triangulation& triangulation);

}  // namespace wisp
