// Boxes cut by shapes and planes: volume, centroid and spread of what is left.
#pragma once
#include <array>
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

/// What is left of a triangle.
struct ClippedTriangle {
  double area = 0.0;                                     ///< m2
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();    ///< m
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< m2, mean of (x - centroid)(x - centroid)^T
  std::vector<Eigen::Vector2d> corners;                  ///< m
};

/// The same of a triangle, counter-clockwise corners: over triangles that tile the shape the areas sum to its
/// own. Throws InputError for balls.
ClippedTriangle clip_triangle(const Region<2>& shape, const std::vector<HalfSpace<2>>& cuts,
                              const std::array<Eigen::Vector2d, 3>& corners);
/// A whole triangle.
ClippedTriangle whole_triangle(const std::array<Eigen::Vector2d, 3>& corners);

/// Three points that, with a third of the area each, integrate polynomials of degree 2 over what is left:
/// they have its centroid and covariance. In a triangle this is Gauss' rule of 3 inner points; they lie in
/// every convex part, on the largest of the ellipses like its ellipse of inertia that fit for certain
/// (Kannan et al. 1995, theorem 4.1). None for a part without thickness.
std::vector<Eigen::Vector2d> gauss_points(const ClippedTriangle& part);

}  // namespace wisp
