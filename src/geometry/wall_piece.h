// The flat pieces that walls are made of, and the answer to "how far is the wall".
#pragma once
#include <Eigen/Core>
#include <array>

namespace wisp {

/// A segment (2D) or a triangle (3D) of a wall. The normal is the unit normal into the solid side: the
/// segment turned by +90 degrees, or (v1 - v0) x (v2 - v0).
template <int dim>
struct WallPiece {
  using Vector = Eigen::Matrix<double, dim, 1>;
  std::array<Vector, dim> vertex;  ///< m
  Vector normal;
};

/// Where a point lies with respect to a wall.
template <int dim>
struct WallDistance {
  using Vector = Eigen::Matrix<double, dim, 1>;
  double distance = 0.0;  ///< m, positive on the solid side
  Vector closest;         ///< m, on the wall
  Vector normal;          ///< unit, gradient of the distance: into the solid side
  bool beyond = false;    ///< past the open end of a wall: nothing of it lies opposite the point
};

}  // namespace wisp
