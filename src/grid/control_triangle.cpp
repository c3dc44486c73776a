#include "grid/control_triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wisp {

namespace {

double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

/// Points that differ by less than this share of the set's extent count as one, turns as straight.
constexpr double same = 1e-10;

double extent_of(std::span<const Vec<2>> points) {
  Vec<2> low = points[0], high = points[0];
  for (const auto& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).norm();
}

/// Corners of the convex hull, counter-clockwise, without points on straight stretches.
std::vector<Vec<2>> convex_hull(std::span<const Vec<2>> points, double extent) {
  std::vector<Vec<2>> sorted(points.begin(), points.end());
  std::sort(sorted.begin(), sorted.end(),
            [](const Vec<2>& a, const Vec<2>& b) { return a[0] < b[0] || (a[0] == b[0] && a[1] < b[1]); });
  std::vector<Vec<2>> hull;
  const auto half = [&](auto first, auto last) {
    const std::size_t start = hull.size();
    for (auto p = first; p != last; ++p) {
      while (hull.size() >= start + 2 && cross(hull.back() - hull[hull.size() - 2], *p - hull.back()) <=
                                             same * extent * (*p - hull[hull.size() - 2]).norm())
        hull.pop_back();
      if (hull.size() == start || (*p - hull.back()).norm() > same * extent) hull.push_back(*p);
    }
    hull.pop_back();
  };
  half(sorted.begin(), sorted.end());
  half(sorted.rbegin(), sorted.rend());
  return hull;
}

Vec<2> meet(const DirectedLine& a, const DirectedLine& b) {
  const double t = cross(b.point - a.point, b.direction) / cross(a.direction, b.direction);
  return a.point + t * a.direction;
}

class Search {
 public:
  Search(std::span<const Vec<2>> points, ControlTriangleRule rule, std::span<const DirectedLine> required)
      : rule_(rule), extent_(extent_of(points)), hull_(convex_hull(points, extent_)) {
    // Required lines come first, so that their numbers are known; hull edges on them are the same lines.
    for (const auto& line : required) lines_.push_back({line.point, line.direction.normalized()});
    n_required_ = lines_.size();
    for (std::size_t k = 0; k < hull_.size(); ++k) {
      const Vec<2>& from = hull_[k];
      const Vec<2>& to = hull_[(k + 1) % hull_.size()];
      const bool known =
          std::any_of(lines_.begin(), lines_.begin() + static_cast<std::ptrdiff_t>(n_required_),
                      [&](const DirectedLine& line) {
                        return std::abs(cross(line.direction, from - line.point)) < same * extent_ &&
                               std::abs(cross(line.direction, to - line.point)) < same * extent_;
                      });
      if (!known) lines_.push_back({from, (to - from).normalized()});
    }
  }

  ControlTriangleSearch run() {
    for (std::size_t i = 0; i < n_required_; ++i)
      for (const auto& p : hull_)
        if (cross(lines_[i].direction, p - lines_[i].point) < -same * extent_) return {};
    for (std::size_t i = 0; i < lines_.size(); ++i)
      for (std::size_t j = i + 1; j < lines_.size(); ++j) {
        if (n_required_ >= 1 && i != 0) continue;
        if (n_required_ == 2 && j != 1) continue;
        for (std::size_t k = j + 1; k < lines_.size(); ++k) try_three(lines_[i], lines_[j], lines_[k]);
        const double turn = cross(lines_[i].direction, lines_[j].direction);
        if (turn > same)
          try_two(lines_[i], lines_[j]);
        else if (turn < -same)
          try_two(lines_[j], lines_[i]);
      }
    if (best_.found) sort_corners();
    return best_;
  }

 private:
  /// Three supporting lines enclose the hull if each turns left into the next.
  void try_three(const DirectedLine& a, const DirectedLine& b, const DirectedLine& c) {
    if (encloses(a, b, c))
      keep(a, b, c);
    else if (encloses(a, c, b))
      keep(a, c, b);
  }

  static bool encloses(const DirectedLine& a, const DirectedLine& b, const DirectedLine& c) {
    return cross(a.direction, b.direction) > same && cross(b.direction, c.direction) > same &&
           cross(c.direction, a.direction) > same;
  }

  /// The wedge between two lines, b to the left after a, closed by a third side.
  void try_two(const DirectedLine& a, const DirectedLine& b) {
    const Vec<2> apex = meet(a, b), along_a = -a.direction, along_b = b.direction;
    if (rule_ != ControlTriangleRule::minimum_area) {
      const Vec<2> bisector = (along_a + along_b).normalized();
      const auto farthest = std::max_element(
          hull_.begin(), hull_.end(),
          [&](const Vec<2>& p, const Vec<2>& q) { return bisector.dot(p) < bisector.dot(q); });
      keep(a, b, {*farthest, Vec<2>(-bisector[1], bisector[0])});
      return;
    }
    const double turn = cross(along_b, along_a);
    std::vector<Vec<2>> shares;  // along a and b
    for (const auto& p : hull_)
      shares.emplace_back(cross(along_b, p - apex) / turn, cross(p - apex, along_a) / turn);
    for (const auto& middle : shares) {
      if (!(middle[0] > same * extent_ && middle[1] > same * extent_)) continue;
      const bool outside = std::any_of(shares.begin(), shares.end(), [&](const Vec<2>& s) {
        return s[0] / (2.0 * middle[0]) + s[1] / (2.0 * middle[1]) > 1.0 + same;
      });
      if (outside) continue;
      const Vec<2> on_a = apex + 2.0 * middle[0] * along_a, on_b = apex + 2.0 * middle[1] * along_b;
      keep(a, b, {on_b, (on_a - on_b).normalized()});
    }
  }

  void keep(const DirectedLine& a, const DirectedLine& b, const DirectedLine& c) {
    const ControlTriangle triangle{meet(a, b), meet(b, c), meet(c, a)};
    const double area = signed_area(triangle);
    // Equal triangles of a regular grid must not be told apart by rounding.
    if (!(area > 0.0) || !(area < least_ * (1.0 - 1e-9))) return;
    least_ = area;
    best_ = {true, triangle};
  }

  /// The order that `find_control_triangle` promises.
  void sort_corners() {
    if (n_required_ == 0) return;
    auto& q = best_.triangle;
    const auto distance = [&](const DirectedLine& line, const Vec<2>& p) {
      return std::abs(cross(line.direction, p - line.point));
    };
    // With one line the corner off it comes last, with two the corner on both comes first.
    const auto rank = [&](const Vec<2>& p) {
      return n_required_ == 1 ? -distance(lines_[0], p)
                              : std::max(distance(lines_[0], p), distance(lines_[1], p));
    };
    const auto first = std::min_element(q.begin(), q.end(),
                                        [&](const Vec<2>& a, const Vec<2>& b) { return rank(a) < rank(b); });
    std::rotate(q.begin(), n_required_ == 1 ? first + 1 : first, q.end());
  }

  ControlTriangleRule rule_;
  double extent_;
  std::vector<Vec<2>> hull_;
  std::vector<DirectedLine> lines_;
  std::size_t n_required_ = 0;
  double least_ = std::numeric_limits<double>::infinity();
  ControlTriangleSearch best_;
};

}  // namespace

double signed_area(const ControlTriangle& q) { return 0.5 * cross(q[1] - q[0], q[2] - q[0]); }

ControlTriangleSearch find_control_triangle(std::span<const Vec<2>> points, ControlTriangleRule rule,
                                            std::span<const DirectedLine> required) {
  return Search(points, rule, required).run();
}

}  // namespace wisp
