#include "geometry/solid.h"

#include <Eigen/Geometry>

namespace wisp {

Solid::Solid(Triangles mesh) : surface_(std::move(mesh.vertices), std::move(mesh.triangles)) {
  const Eigen::Vector3d origin = surface_.vertices().front();
  for (int f = 0; f < surface_.size(); ++f) {
    const auto v = surface_.piece(f).vertex;
    volume_ += (v[0] - origin).dot((v[1] - origin).cross(v[2] - origin)) / 6.0;
  }
}

}  // namespace wisp
