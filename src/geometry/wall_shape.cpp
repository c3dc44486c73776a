#include "geometry/wall_shape.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "geometry/polygon.h"
#include "geometry/stl.h"
#include "geometry/wall_line.h"

namespace wisp {
namespace {

constexpr double pi = std::numbers::pi;

template <int dim>
Eigen::Matrix<double, dim, 1> vector(const std::vector<double>& values, std::string_view shape,
                                     std::string_view key) {
  if (values.size() != static_cast<std::size_t>(dim))
    input_error("{}: '{}' has {} {}, expected {} in {}D", shape, key, values.size(),
                values.size() == 1 ? "value" : "values", dim, dim);
  for (const double v : values)
    if (!std::isfinite(v)) input_error("{}: '{}' holds {}, expected finite numbers", shape, key, v);
  return Eigen::Map<const Eigen::Matrix<double, dim, 1>>(values.data());
}

double positive(double value, std::string_view shape, std::string_view key) {
  if (!(value > 0.0) || !std::isfinite(value))
    input_error("{}: '{}' is {}, expected a positive finite number", shape, key, value);
  return value;
}

RoundWall round_wall(const ArcWall& arc) {
  const double degrees = arc.to - arc.from;
  if (!std::isfinite(degrees) || degrees <= 0.0 || degrees > 360.0)
    input_error("arc: 'from' is {} and 'to' is {} degrees, expected from < to <= from + 360", arc.from,
                arc.to);
  return {vector<2>(arc.centre, ArcWall::name, "centre"),
          positive(arc.radius, ArcWall::name, "radius"),
          std::remainder(arc.from, 360.0) * pi / 180.0,
          degrees * pi / 180.0,
          degrees == 360.0,
          arc.solid == SolidSide::inside ? 1.0 : -1.0};
}

RoundWall round_wall(const CircleWall& circle) {
  return {vector<2>(circle.centre, CircleWall::name, "centre"),
          positive(circle.radius, CircleWall::name, "radius"),
          0.0,
          2.0 * pi,
          true,
          circle.solid == SolidSide::inside ? 1.0 : -1.0};
}

/// Two triangles of a parallelogram.
FacetedSurface<3> parallelogram(const Eigen::Vector3d& corner, const Eigen::Vector3d& normal,
                                const std::vector<std::vector<double>>& edges) {
  if (edges.size() != 2) input_error("plane: 'edges' has {} vectors, expected 2", edges.size());
  Eigen::Vector3d a = vector<3>(edges[0], PlaneWall::name, "edges"),
                  b = vector<3>(edges[1], PlaneWall::name, "edges");
  const Eigen::Vector3d area = a.cross(b);
  if (area.norm() <= 1e-12 * a.norm() * b.norm()) input_error("plane: 'edges' span no area");
  if (area.cross(normal).norm() > 1e-6 * area.norm())
    input_error("plane: 'normal' is not perpendicular to both 'edges'");
  if (area.dot(normal) < 0.0) std::swap(a, b);
  return FacetedSurface<3>({corner, corner + a, corner + a + b, corner + b}, {{0, 1, 2}, {0, 2, 3}});
}

}  // namespace

WallDistance<2> RoundWall::signed_distance(const Eigen::Vector2d& x) const {
  const Eigen::Vector2d r = x - centre;
  const double length = r.norm();
  double angle = length > 0.0 ? std::atan2(r.y(), r.x()) : from + 0.5 * sweep;
  WallDistance<2> result;
  if (!whole) {
    double past = std::fmod(angle - from, 2.0 * pi);
    if (past < 0.0) past += 2.0 * pi;
    if (past > sweep) {
      // Past an end: the nearer one, by the angle.
      const double end = past - sweep < 2.0 * pi - past ? from + sweep : from;
      const Eigen::Vector2d out(std::cos(end), std::sin(end));
      result.closest = centre + radius * out;
      const Eigen::Vector2d away = x - result.closest;
      const double side = -sign * away.dot(out) >= 0.0 ? 1.0 : -1.0;
      result.distance = side * away.norm();
      result.normal = away.norm() > 0.0 ? Eigen::Vector2d(side * away.normalized()) : -sign * out;
      result.beyond = true;
      return result;
    }
  }
  const Eigen::Vector2d out =
      length > 0.0 ? Eigen::Vector2d(r / length) : Eigen::Vector2d(std::cos(angle), std::sin(angle));
  result.closest = centre + radius * out;
  result.distance = sign * (radius - length);
  result.normal = -sign * out;
  return result;
}

std::vector<WallPiece<2>> RoundWall::pieces(double length) const {
  // A chord over the angle a is 2 R sin(a/2) long; three at least keep a circle round.
  const double widest = 2.0 * std::asin(std::min(1.0, length / (2.0 * radius)));
  const int n = std::max(whole ? 8 : 1, static_cast<int>(std::ceil(sweep / widest - 1e-9)));
  const auto direction = [&](double k) {
    const double a = from + sweep * k / n;
    return Eigen::Vector2d(std::cos(a), std::sin(a));
  };
  std::vector<WallPiece<2>> result;
  for (int k = 0; k < n; ++k) {
    // Counter-clockwise has the inside on its left.
    Eigen::Vector2d a = centre + radius * direction(k),
                    b = centre + radius * direction(whole && k + 1 == n ? 0 : k + 1);
    if (sign < 0.0) std::swap(a, b);
    result.push_back({{a, b}, -sign * direction(k + 0.5)});
  }
  return result;
}

template <int dim>
WallDistance<dim> FlatWall<dim>::signed_distance(const Vector& x) const {
  const double d = (x - point).dot(normal);
  return {d, x - d * normal, normal, false};
}

template <int dim>
std::vector<WallPiece<dim>> FlatWall<dim>::pieces(const Block<dim>& within) const {
  // A patch of the plane wider than the block, cut by its sides (Sutherland and Hodgman 1974).
  const Vector middle = signed_distance(0.5 * (within.lower + within.upper)).closest;
  const double reach = 2.0 * (within.upper - within.lower).norm();
  std::vector<Vector> polygon, cut;
  if constexpr (dim == 2) {
    const Vector along(normal.y(), -normal.x());  // its left is the normal
    polygon = {middle - reach * along, middle + reach * along};
  } else {
    const Vector a = normal.unitOrthogonal(), b = normal.cross(a);
    polygon = {middle - reach * a - reach * b, middle + reach * a - reach * b, middle + reach * a + reach * b,
               middle - reach * a + reach * b};
  }
  for (int d = 0; d < dim; ++d)
    for (const double side : {-1.0, 1.0}) {
      const double limit = side > 0.0 ? within.upper[d] : within.lower[d];
      const auto out = [&](const Vector& v) { return side * (v[d] - limit); };
      cut.clear();
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vector &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double da = out(a), db = out(b);
        if (da <= 0.0) cut.push_back(a);
        if (dim == 2 && i == 1) break;  // a segment has no way back
        if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) {
          Vector v = a + da / (da - db) * (b - a);
          v[d] = limit;
          cut.push_back(v);
        }
      }
      polygon.swap(cut);
    }
  std::vector<WallPiece<dim>> result;
  if constexpr (dim == 2) {
    if (polygon.size() == 2 && (polygon[1] - polygon[0]).norm() > 1e-12 * reach)
      result.push_back({{polygon[0], polygon[1]}, normal});
  } else {
    for (std::size_t k = 2; k < polygon.size(); ++k)
      if ((polygon[k - 1] - polygon[0]).cross(polygon[k] - polygon[0]).norm() > 1e-14 * reach * reach)
        result.push_back({{polygon[0], polygon[k - 1], polygon[k]}, normal});
  }
  return result;
}

template <int dim>
typename WallShape<dim>::Any WallShape<dim>::make(const AnyWallShape& shape,
                                                  const std::filesystem::path& folder) {
  return std::visit(
      [&]<class Options>(const Options& o) -> Any {
        constexpr bool both = std::is_same_v<Options, PlaneWall>;
        constexpr bool spatial = std::is_same_v<Options, StlWall>;
        if constexpr (both) {
          const Vector point = vector<dim>(o.point, Options::name, "point");
          const Vector normal = vector<dim>(o.normal, Options::name, "normal");
          if (!(normal.norm() > 0.0)) input_error("plane: 'normal' has no length");
          if (o.edges.empty()) return FlatWall<dim>{point, normal.normalized()};
          if constexpr (dim == 3) return parallelogram(point, normal.normalized(), o.edges);
          input_error("plane: 'edges' are for 3D; bound a line in 2D by a polyline");
        } else if constexpr (spatial != (dim == 3)) {
          input_error("{}: a wall for {}D, but the case is {}D; expected {}", Options::name, spatial ? 3 : 2,
                      dim, dim == 2 ? "polyline, circle, arc, polygon, level-set or plane" : "plane or stl");
        } else if constexpr (std::is_same_v<Options, StlWall>) {
          Triangles mesh = read_stl(folder / o.file);
          const double scale = positive(o.scale, Options::name, "scale");
          const Eigen::Vector3d offset = vector<3>(o.offset, Options::name, "offset");
          for (auto& x : mesh.vertices) x = scale * x + offset;
          if (o.solid == SolidSide::inside)  // the normals of STL files point outwards
            for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
          return FacetedSurface<3>(std::move(mesh.vertices), std::move(mesh.triangles));
        } else if constexpr (std::is_same_v<Options, PolylineWall>) {
          return polyline_surface(o);
        } else if constexpr (std::is_same_v<Options, PolygonWall>) {
          const Outline rings = outline(
              Polygon{.vertices = o.vertices, .file = o.file, .scale = o.scale, .offset = o.offset}, folder);
          return rings_surface(rings, o.solid == SolidSide::inside);
        } else if constexpr (std::is_same_v<Options, LevelSetWall>) {
          if (o.shapes.empty()) input_error("level-set: 'shapes' is empty, expected at least one shape");
          if (!std::isfinite(o.offset))
            input_error("level-set: 'offset' is {}, expected a finite number", o.offset);
          std::vector<Region<2>> regions;
          for (const auto& s : o.shapes) regions.push_back(region<2>(s, folder));
          return LevelSet(regions, o.offset, o.solid == SolidSide::inside ? 1.0 : -1.0);
        } else {
          return round_wall(o);
        }
      },
      shape);
}

template <int dim>
WallShape<dim>::WallShape(const AnyWallShape& shape, const std::filesystem::path& folder)
    : shape_(make(shape, folder)) {}

template <int dim>
std::vector<WallPiece<dim>> WallShape<dim>::pieces(double length, const Block<dim>& within) const {
  return std::visit(
      [&]<class Shape>(const Shape& s) {
        if constexpr (std::is_same_v<Shape, FlatWall<dim>>) {
          return s.pieces(within);
        } else if constexpr (std::is_same_v<Shape, FacetedSurface<dim>>) {
          std::vector<WallPiece<dim>> all;
          for (int f = 0; f < s.size(); ++f) all.push_back(s.piece(f));
          return all;
        } else {
          return s.pieces(length);
        }
      },
      shape_);
}

template <int dim>
Block<dim> WallShape<dim>::bounds() const {
  return std::visit(
      []<class Shape>(const Shape& s) -> Block<dim> {
        if constexpr (std::is_same_v<Shape, FlatWall<dim>>) {
          const Vector far = Vector::Constant(std::numeric_limits<double>::infinity());
          return {-far, far};
        } else if constexpr (std::is_same_v<Shape, RoundWall>) {
          if (s.whole) return {s.centre.array() - s.radius, s.centre.array() + s.radius};
          // The ends, and the extremes of the circle that the arc passes.
          const auto on = [&](double a) {
            return Vector(s.centre + s.radius * Vector(std::cos(a), std::sin(a)));
          };
          Block<dim> box{on(s.from), on(s.from)};
          const auto include = [&](const Vector& x) {
            box.lower = box.lower.cwiseMin(x), box.upper = box.upper.cwiseMax(x);
          };
          include(on(s.from + s.sweep));
          for (int quarter = -8; quarter <= 8; ++quarter)
            if (const double a = 0.5 * pi * quarter; a > s.from && a < s.from + s.sweep) include(on(a));
          return box;
        } else {
          return s.bounds();
        }
      },
      shape_);
}

template struct FlatWall<2>;
template struct FlatWall<3>;
template class WallShape<2>;
template class WallShape<3>;

}  // namespace wisp
