#include "geometry/wall_line.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace wisp {
namespace {

using Point = Eigen::Vector2d;

double cross(const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Whether two closed segments have a point in common.
bool meet(const Point& a, const Point& b, const Point& c, const Point& d) {
  const auto side = [](const Point& p, const Point& q, const Point& r) {
    const double s = cross(q - p, r - p), size = (q - p).norm() * ((r - p).norm() + (q - p).norm());
    return s > 1e-14 * size ? 1 : s < -1e-14 * size ? -1 : 0;
  };
  const auto between = [](const Point& p, const Point& q, const Point& r) {
    return (r - p).dot(q - p) >= 0.0 && (r - q).dot(p - q) >= 0.0;
  };
  const int s1 = side(a, b, c), s2 = side(a, b, d), s3 = side(c, d, a), s4 = side(c, d, b);
  if (s1 * s2 < 0 && s3 * s4 < 0) return true;
  return (s1 == 0 && between(a, b, c)) || (s2 == 0 && between(a, b, d)) || (s3 == 0 && between(c, d, a)) ||
         (s4 == 0 && between(c, d, b));
}

/// Neighbours share a vertex and must share no more: the line must not turn back on itself.
bool turns_back(const Point& a, const Point& b, const Point& c) {
  const Point u = b - a, v = c - b;
  return u.dot(v) < 0.0 && std::abs(cross(u, v)) <= 1e-14 * u.norm() * v.norm();
}

}  // namespace

FacetedSurface<2> polyline_surface(const PolylineWall& line) {
  std::vector<Point> x;
  for (const auto& vertex : line.vertices) {
    if (vertex.size() != 2)
      input_error("polyline: vertex {} has {} {}, expected [x, y]", x.size() + 1, vertex.size(),
                  vertex.size() == 1 ? "number" : "numbers");
    if (!std::isfinite(vertex[0]) || !std::isfinite(vertex[1]))
      input_error("polyline: vertex {} is ({}, {}), expected finite numbers", x.size() + 1, vertex[0],
                  vertex[1]);
    x.emplace_back(vertex[0], vertex[1]);
    if (const std::size_t n = x.size(); n > 1 && x[n - 1] == x[n - 2])
      input_error("polyline: vertices {} and {} are both ({}, {}): a segment without length", n - 1, n,
                  vertex[0], vertex[1]);
  }
  if (x.size() < 2) input_error("polyline: {} vertices, expected at least 2", x.size());
  const bool closed = x.size() > 3 && x.front() == x.back();
  if (!closed && (line.solid == LineSide::inside || line.solid == LineSide::outside))
    input_error(
        "polyline: solid = \"{}\" needs a closed line, but the last vertex ({}, {}) is not the first ({}, "
        "{})",
        choice_name(line.solid), x.back().x(), x.back().y(), x.front().x(), x.front().y());
  const std::size_t n = x.size() - 1;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const bool next = j == i + 1, around = closed && i == 0 && j == n - 1;
      const bool bad = next     ? turns_back(x[i], x[j], x[j + 1])
                       : around ? turns_back(x[j], x[0], x[1])
                                : meet(x[i], x[i + 1], x[j], x[j + 1]);
      if (bad)
        input_error("polyline: segments {} and {} {}", i + 1, j + 1,
                    next || around ? "overlap" : "cross or touch");
    }
  bool left = line.solid == LineSide::left;
  if (closed && line.solid != LineSide::left && line.solid != LineSide::right) {
    double area = 0.0;
    for (std::size_t i = 0; i < n; ++i) area += cross(x[i] - x[0], x[i + 1] - x[0]);
    left = (area > 0.0) == (line.solid == LineSide::inside);
  }
  if (closed) x.pop_back();
  std::vector<std::array<int, 2>> facets;
  const int count = static_cast<int>(x.size());
  for (int i = 0; i < static_cast<int>(n); ++i) {
    const int a = i, b = (i + 1) % count;
    facets.push_back(left ? std::array{a, b} : std::array{b, a});
  }
  return FacetedSurface<2>(std::move(x), std::move(facets));
}

FacetedSurface<2> rings_surface(const Outline& outline, bool inside) {
  std::vector<Point> vertices;
  std::vector<std::array<int, 2>> facets;
  for (const Ring& ring : outline.rings()) {  // outer rings run counter-clockwise, holes clockwise
    const int first = static_cast<int>(vertices.size()), n = static_cast<int>(ring.size());
    vertices.insert(vertices.end(), ring.begin(), ring.end());
    for (int k = 0; k < n; ++k) {
      const int a = first + k, b = first + (k + 1) % n;
      facets.push_back(inside ? std::array{a, b} : std::array{b, a});
    }
  }
  return FacetedSurface<2>(std::move(vertices), std::move(facets));
}

}  // namespace wisp
