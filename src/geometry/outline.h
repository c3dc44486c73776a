// A polygon with holes, checked: point in polygon, area, and clipping by cells.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

namespace wisp {

/// Vertices of a closed ring, the first not repeated at the end, in m.
using Ring = std::vector<Eigen::Vector2d>;

/// A valid polygon: the outer ring runs counter-clockwise, holes run clockwise, no ring crosses itself or
/// another one, each hole lies inside the outer ring and outside the other holes.
class Outline {
 public:
  /// rings[0] is the outer ring, the others are holes, each in either sense, closed or not; repeated
  /// neighbours are dropped. `origin` starts the messages; `labels[i]` names ring i there ("outer ring",
  /// "hole 1", ... if left out). Throws InputError for no ring, fewer than 3 different vertices, numbers that
  /// are not finite, no area, crossings, spikes, and holes that are outside or inside one another.
  explicit Outline(std::vector<Ring> rings, const std::string& origin = "polygon",
                   std::vector<std::string> labels = {});

  const std::vector<Ring>& rings() const { return rings_; }
  const Eigen::Vector2d& lower() const { return lower_; }
  const Eigen::Vector2d& upper() const { return upper_; }
  /// Area without the holes, m² (shoelace formula).
  double area() const { return area_; }
  /// True inside. The boundary is half-open, so that of polygons that share an edge exactly one holds a point
  /// of it: a point of a left or lower side is inside, of a right or upper side outside.
  bool contains(const Eigen::Vector2d& x) const;

 private:
  std::vector<Ring> rings_;
  Eigen::Vector2d lower_, upper_;
  double area_ = 0.0;
};

/// The part of a polygon in a cell.
struct ClippedCell {
  double area = 0.0;         ///< m²
  Eigen::Vector2d centroid;  ///< m; the centre of the cell if the area is zero
};

/// Area and centroid of the part of the polygon in the cell [lower, upper], exact to rounding; over the cells
/// of a grid that covers the polygon the areas sum to the area of the polygon. Throws InputError unless lower
/// < upper.
///
/// Each ring is clipped by the four half-planes in turn (Sutherland and Hodgman 1974). Where a ring falls
/// into several parts this joins them by edges along the cell's side that are passed in both directions; they
/// add nothing to the integrals. Boost.Geometry is not used here: 1.74 works with rounded
/// coordinates, and the sum over a grid misses by 4e-8.
/// intersections to an integer grid.
ClippedCell clip_cell(const Outline& outline, const Eigen::Vector2d& lower, const Eigen::Vector2d& upper);

/// The points x with normal·(x - point) <= 0.
struct HalfPlane {
  Eigen::Vector2d normal, point;
};

/// Area of the part of the polygon in a convex cell, the intersection of half-planes, m²; see clip_cell.
/// `centre` is a point in the cell, about which moments are taken.
double clipped_area(const Outline& outline, const Eigen::Vector2d& centre,
                    const std::vector<HalfPlane>& sides);

}  // namespace wisp
