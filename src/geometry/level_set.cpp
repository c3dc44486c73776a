#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "geometry/wall_line.h"
#include "geometry/wall_shape.h"

namespace wisp {
namespace {

using Point = Eigen::Vector2d;

/// Signed distance to a shape, positive outside, and its gradient.
struct Away {
  double distance;
  Point gradient;
};

Away away(const Block<2>& box, const Point& x) {
  const Point centre = 0.5 * (box.lower + box.upper), half = 0.5 * (box.upper - box.lower);
  const Point r = x - centre;
  const Point q = r.cwiseAbs() - half, sign(r.x() < 0.0 ? -1.0 : 1.0, r.y() < 0.0 ? -1.0 : 1.0);
  const Point out = q.cwiseMax(0.0);
  if (out.squaredNorm() > 0.0) return {out.norm(), out.normalized().cwiseProduct(sign)};
  const int d = q.x() > q.y() ? 0 : 1;
  Point gradient = Point::Zero();
  gradient[d] = sign[d];
  return {q[d], gradient};
}

Away away(const Sphere<2>& disc, const Point& x) {
  const Point r = x - disc.centre;
  const double length = r.norm();
  return {length - disc.radius, length > 0.0 ? Point(r / length) : Point(1.0, 0.0)};
}

Away away(const FacetedSurface<2>& rings, const Point& x) {
  const WallDistance<2> d = rings.signed_distance(x);
  return {-d.distance, -d.normal};
}

}  // namespace

LevelSet::LevelSet(const std::vector<Region<2>>& shapes, double offset, double sign)
    : offset_(offset), sign_(sign) {
  constexpr double far = std::numeric_limits<double>::infinity();
  box_ = {Point::Constant(far), Point::Constant(-far)};
  for (const auto& any : shapes) {
    const Block<2> box = wisp::bounds(any);
    box_.lower = box_.lower.cwiseMin((box.lower.array() - offset).matrix());
    box_.upper = box_.upper.cwiseMax((box.upper.array() + offset).matrix());
    if (const auto* outline = std::get_if<Outline>(&any)) {
      shapes_.push_back(Rings{rings_surface(*outline, true)});
    } else if (const auto* block = std::get_if<Block<2>>(&any)) {
      shapes_.push_back(*block);
    } else {
      shapes_.push_back(std::get<Sphere<2>>(any));
    }
  }
  if (!(box_.lower.array() < box_.upper.array()).all())
    input_error("level-set: nothing is left of the shapes at an 'offset' of {}", offset);
}

WallDistance<2> LevelSet::signed_distance(const Point& x) const {
  Away least{std::numeric_limits<double>::infinity(), Point::Zero()};
  for (const auto& any : shapes_) {
    const Away here = std::visit(
        [&]<class Shape>(const Shape& s) {
          if constexpr (std::is_same_v<Shape, Rings>)
            return away(s.surface, x);
          else
            return away(s, x);
        },
        any);
    if (here.distance < least.distance) least = here;
  }
  const double d = least.distance - offset_;
  return {-sign_ * d, x - d * least.gradient, -sign_ * least.gradient, false};
}

std::vector<WallPiece<2>> LevelSet::pieces(double length) const {
  // One cell more around, shifted so that straight sides do not fall on the cells' lines.
  const Point first = box_.lower.array() - 1.37 * length;
  const int nx = static_cast<int>(std::ceil((box_.upper.x() - first.x()) / length)) + 1,
            ny = static_cast<int>(std::ceil((box_.upper.y() - first.y()) / length)) + 1;
  const auto node = [&](int i, int j) { return Point(first + length * Point(i, j)); };
  const auto value = [&](const Point& x) { return signed_distance(x).distance; };
  const auto crossing = [&](Point a, Point b) {
    if (value(a) > value(b)) std::swap(a, b);  // the same from both cells
    for (int k = 0; k < 60; ++k) {
      const Point middle = 0.5 * (a + b);
      (value(middle) < 0.0 ? a : b) = middle;
    }
    return Point(0.5 * (a + b));
  };
  std::vector<double> values(static_cast<std::size_t>((nx + 1) * (ny + 1)));
  const auto number = [&](int i, int j) { return static_cast<std::size_t>(j * (nx + 1) + i); };
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) values[number(i, j)] = value(node(i, j));
  std::vector<WallPiece<2>> result;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const std::array<std::array<int, 2>, 4> corner{{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
      std::vector<Point> into, out_of;  // counter-clockwise: crossings into the solid and out of it
      std::vector<int> order;
      for (std::size_t k = 0; k < 4; ++k) {
        const auto a = corner[k], b = corner[(k + 1) % 4];
        const bool sa = values[number(a[0], a[1])] >= 0.0, sb = values[number(b[0], b[1])] >= 0.0;
        if (sa == sb) continue;
        const Point x = crossing(node(a[0], a[1]), node(b[0], b[1]));
        (sb ? into : out_of).push_back(x);
        order.push_back(sb ? 1 : -1);
      }
      // The solid lies on the left of the way from an exit to an entry... of the same solid corner, or, in a
      // saddle with a solid middle, to the other one's.
      const bool joined =
          into.size() == 2 &&
          value(0.25 * (node(i, j) + node(i + 1, j) + node(i + 1, j + 1) + node(i, j + 1))) >= 0.0;
      const std::size_t shift = !order.empty() && order.front() < 0 ? 1 : 0;
      for (std::size_t k = 0; k < into.size(); ++k) {
        // Entry k is followed by exit k (shift 0) or exit k + 1 (shift 1): the same solid corner.
        const std::size_t other = (k + shift + (joined ? into.size() - 1 : 0)) % into.size();
        const Point a = out_of[other], b = into[k];
        if ((b - a).norm() <= 1e-9 * length) continue;
        WallPiece<2> piece{{a, b}, signed_distance(0.5 * (a + b)).normal};
        result.push_back(piece);
      }
    }
  return result;
}

}  // namespace wisp
