#pragma once
#include <string>
#include <string_view>
#include <tuple>

#include "core/describe.h"

namespace wisp {

/// Triangles of a Gmsh file (2D only) as a case file gives them; points are put into each of them.
struct MeshShape {
  static constexpr std::string_view name = "mesh";
  static constexpr std::string_view summary =
      "the triangles of a Gmsh file, or those of one of its surfaces (2D)";
  static constexpr std::string_view source = "";

  std::string file{};     ///< .msh, relative to the folder of the case
  std::string surface{};  ///< name of a physical surface; empty: all triangles
  double scale = 1.0;     ///< positive

  static constexpr auto keys() {
    return std::tuple{
        key("file", &MeshShape::file, "", "the .msh file (format 2 or 4)").required(),
        key("surface", &MeshShape::surface, "", "physical group of the triangles (default: all triangles)"),
        key("scale", &MeshShape::scale, "-", "factor on all coordinates").positive()};
  }
};

}  // namespace wisp
