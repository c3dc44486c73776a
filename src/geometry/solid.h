// A body from a triangulated surface.
#pragma once
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/describe.h"
#include "geometry/faceted_surface.h"
#include "geometry/stl.h"

namespace wisp {

/// Solid (3D only) as a case file gives it: a closed surface of triangles, placed at scale * x + offset.
struct StlSolid {
  static constexpr std::string_view name = "stl";
  static constexpr std::string_view summary = "solid bounded by the triangles of an STL file (3D)";
  static constexpr std::string_view source = "";

  std::string file{};                         ///< relative to the folder of the case
  double scale = 1.0;                         ///< positive
  std::vector<double> offset{0.0, 0.0, 0.0};  ///< [3], m, added after scaling

  static constexpr auto keys() {
    return std::tuple{key("file", &StlSolid::file, "",
                          "closed surface, text or binary STL, relative to the folder of the case")
                          .required()
                          .existing_file(),
                      key("scale", &StlSolid::scale, "-", "factor on all coordinates").positive(),
                      key("offset", &StlSolid::offset, "m", "shift added after scaling").per_direction()};
  }
};

/// What a closed surface of triangles encloses.
class Solid {
 public:
  /// Normals of the triangles point outwards, as read_stl leaves them.
  explicit Solid(Triangles mesh);

  const FacetedSurface<3>& surface() const { return surface_; }
  /// m3, by the divergence theorem.
  double volume() const { return volume_; }
  /// By the sign of the distance, which is exact beside edges and vertices too; the surface is inside.
  bool contains(const Eigen::Vector3d& x) const { return distance(x) >= 0.0; }
  /// m, positive inside.
  double distance(const Eigen::Vector3d& x) const { return -surface_.signed_distance(x).distance; }

 private:
  FacetedSurface<3> surface_;
  double volume_ = 0.0;
};

}  // namespace wisp
