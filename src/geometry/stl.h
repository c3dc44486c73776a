// Triangulated surfaces from STL files.
#pragma once
#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <vector>

namespace wisp {

/// Triangles that share vertices, normals outwards by the right-hand rule.
struct Triangles {
  std::vector<Eigen::Vector3d> vertices;      ///< m
  std::vector<std::array<int, 3>> triangles;  ///< vertex numbers
};

/// Reads an STL file, text or binary, and joins equal vertices. The surface must be closed; if all of it is
/// turned inside out it is turned back. The normals that the file states are not used: they follow from the
/// order of the vertices. Throws InputError "file: ..." (text: "file:line: ...") for files that are missing,
/// empty, cut short or no STL, numbers that are not finite, triangles without area, holes, edges of more than
/// two triangles, and triangles that are flipped against their neighbour.
Triangles read_stl(const std::filesystem::path& path);

}  // namespace wisp
