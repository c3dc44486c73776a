// Delaunay triangulation of points in the plane, and the Voronoi cells of points in a polygon.
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "geometry/outline.h"

namespace wisp {

/// Triangles (point numbers, counter-clockwise) of the convex hull of at least three points, with no point
/// inside the circle through a triangle's corners; where more than three points lie on one circle any of the
/// triangulations. By Qhull (Barber, Dobkin and Huhdanpaa 1996). Errors (InputError): fewer than three
/// points, points that are not finite or all on one line. Points that coincide with another, or nearly, may
/// be left out.
std::vector<std::array<int, 3>> delaunay(const std::vector<Eigen::Vector2d>& points);

/// Area (m²) of the part of the polygon that is nearer to each point than to the others; the areas sum to
/// that of the polygon. Errors (InputError): no points, two that coincide.
std::vector<double> voronoi_areas(const std::vector<Eigen::Vector2d>& points, const Outline& outline);

}  // namespace wisp
