// Walls checked and ready: one type for every geometry that a case file can name.
#pragma once
#include <filesystem>
#include <memory>
#include <variant>
#include <vector>

#include "geometry/faceted_surface.h"
#include "geometry/region.h"
#include "geometry/wall_options.h"
#include "geometry/wall_piece.h"

namespace wisp {

/// A circle or a part of it (2D); exact distances, chords as pieces.
struct RoundWall {
  Eigen::Vector2d centre;
  double radius = 0.0;  ///< m
  double from = 0.0;    ///< rad
  double sweep = 0.0;   ///< rad, counter-clockwise, 2 pi for the whole circle
  bool whole = false;
  double sign = 1.0;  ///< +1 if the solid lies inside

  WallDistance<2> signed_distance(const Eigen::Vector2d& x) const;
  std::vector<WallPiece<2>> pieces(double length) const;
};

/// A plane, in 2D a line, without bounds.
template <int dim>
struct FlatWall {
  using Vector = Eigen::Matrix<double, dim, 1>;
  Vector point, normal;

  WallDistance<dim> signed_distance(const Vector& x) const;
  /// What lies in the block, in 3D as a fan of triangles; nothing if the plane misses it.
  std::vector<WallPiece<dim>> pieces(const Block<dim>& within) const;
};

/// The line at a signed distance from a union of shapes (2D).
class LevelSet {
 public:
  LevelSet(const std::vector<Region<2>>& shapes, double offset, double sign);

  WallDistance<2> signed_distance(const Eigen::Vector2d& x) const;
  /// Marching squares on cells of the given length, vertices on the line to rounding; corners are cut there.
  std::vector<WallPiece<2>> pieces(double length) const;
  Block<2> bounds() const { return box_; }

 private:
  struct Rings {
    FacetedSurface<2> surface;
  };
  std::vector<std::variant<Block<2>, Sphere<2>, Rings>> shapes_;
  double offset_, sign_;
  Block<2> box_;
};

/// Geometry of one wall at rest: pieces to integrate over, signed distances to ask for.
template <int dim>
class WallShape {
 public:
  using Vector = Eigen::Matrix<double, dim, 1>;

  /// Checks a shape and makes it ready. `folder` is where relative file names start from. Throws InputError,
  /// which names shape and key, for a shape of the other dimension, wrong numbers of values, numbers that are
  /// not finite, lines with repeated vertices or crossings, open lines with `solid` inside or outside, and
  /// STL files that are cut short, have holes, flipped triangles or triangles without area.
  explicit WallShape(const AnyWallShape& shape, const std::filesystem::path& folder = {});

  /// Segments (2D) or triangles (3D). Curves are refined until no piece is longer than `length` (m,
  /// positive); walls without bounds are cut by `within`, all others come whole. Normals are exact: those of
  /// curves at the middle of a piece.
  std::vector<WallPiece<dim>> pieces(double length, const Block<dim>& within) const;

  WallDistance<dim> signed_distance(const Vector& x) const {
    return std::visit([&](const auto& s) { return s.signed_distance(x); }, shape_);
  }

  /// Smallest axis-aligned box; infinite for walls without bounds.
  Block<dim> bounds() const;

 private:
  using Any =
      std::conditional_t<dim == 2, std::variant<FacetedSurface<dim>, FlatWall<dim>, RoundWall, LevelSet>,
                         std::variant<FacetedSurface<dim>, FlatWall<dim>>>;
  static Any make(const AnyWallShape& shape, const std::filesystem::path& folder);
  Any shape_;
};

extern template class WallShape<2>;
extern template class WallShape<3>;

}  // namespace wisp
