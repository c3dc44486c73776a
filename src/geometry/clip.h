// Boxes cut by shapes and planes: volume, centroid and spread of what is left.
#pragma once
#include <vector>

#include "geometry/region.h"

namespace wisp {

/// Keeps the side of a plane (2D: line) that its normal points to.
template <int dim>
struct HalfSpace {
  using Vector = Eigen::Matrix<double, dim, 1>;
  Vector point, normal;
};

/// What is left of a box.
template <int dim>
struct ClippedBox {
  using Vector = Eigen::Matrix<double, dim, 1>;
  double volume = 0.0;               ///< m3 (2D m2)
  Vector centroid = Vector::Zero();  ///< m
  Vector variance = Vector::Zero();  ///< m2, mean of (x - centroid)^2 in each direction; l^2/3 of a box
};

/// The part of the box [lower, upper] in a shape and in half-spaces, exact to rounding: over boxes that tile
/// the shape the volumes sum to its own. Polygons ring by ring (see clip_cell); boxes in 3D as convex
/// polyhedra cut plane by plane, solids by their triangles. Throws InputError for balls, which are no
/// polygons.
template <int dim>
ClippedBox<dim> clip_box(const Region<dim>& shape, const std::vector<HalfSpace<dim>>& cuts,
                         const Eigen::Matrix<double, dim, 1>& lower,
                         const Eigen::Matrix<double, dim, 1>& upper);

}  // namespace wisp
