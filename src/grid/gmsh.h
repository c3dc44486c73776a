// Triangulations from Gmsh files.
#pragma once
#include <filesystem>

#include "grid/triangulation.h"

namespace wisp {

/// Reads the three-node triangles of a .msh file, format 2.x or 4.x, ASCII or binary (not 4.0), in the plane
/// z = const; coordinates are multiplied by `scale`. Physical groups of points, lines and surfaces become
/// parts under their names, or "physical N" without one. Errors (InputError), one line "file:line: ...": not
/// a readable .msh file, another format, cut short, elements of second order or with four sides, nodes named
/// twice or not at all, nodes without a triangle, and all that Triangulation refuses.
Triangulation read_gmsh(const std::filesystem::path& file, double scale = 1.0);

}  // namespace wisp
