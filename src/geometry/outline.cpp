#include "geometry/outline.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

// Boost 1.74 includes one of its own deprecated headers and would say so in each build.
#define BOOST_ALLOW_DEPRECATED_HEADERS
// After inlining g++ 12 takes a number of Boost's for uninitialised, system header or not.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <boost/geometry/algorithms/intersection.hpp>
#include <boost/geometry/algorithms/is_valid.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/geometry/geometries/segment.hpp>
#pragma GCC diagnostic pop

namespace wisp {
namespace {

namespace bg = boost::geometry;
using BoostPoint = bg::model::d2::point_xy<double>;
using BoostPolygon = bg::model::polygon<BoostPoint, false, true>;  // counter-clockwise, closed
using BoostSegment = bg::model::segment<BoostPoint>;

/// First moments of a ring about `centre`: signed area and area times centroid (counter-clockwise positive).
struct Moments {
  double area = 0.0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
};

void add_moments(const Ring& ring, const Eigen::Vector2d& centre, Moments& sum) {
  if (ring.empty()) return;
  Eigen::Vector2d a = ring.back() - centre;
  for (const Eigen::Vector2d& vertex : ring) {
    const Eigen::Vector2d b = vertex - centre;
    const double cross = a.x() * b.y() - a.y() * b.x();
    sum.area += 0.5 * cross;
    sum.first += cross / 6.0 * (a + b);
    a = b;
  }
}

double signed_area(const Ring& ring) {
  Moments sum;
  add_moments(ring, ring.front(), sum);
  return sum.area;
}

BoostPoint boost_point(const Eigen::Vector2d& x) { return {x.x(), x.y()}; }

BoostPolygon boost_polygon(const std::vector<Ring>& rings) {
  BoostPolygon polygon;
  polygon.inners().resize(rings.size() - 1);
  for (std::size_t r = 0; r < rings.size(); ++r) {
    auto& ring = r == 0 ? polygon.outer() : polygon.inners()[r - 1];
    for (const auto& x : rings[r]) ring.push_back(boost_point(x));
    ring.push_back(boost_point(rings[r].front()));
  }
  return polygon;
}

std::string edge_text(const BoostSegment& s) {
  return fmt::format("({:.6g}, {:.6g})-({:.6g}, {:.6g})", s.first.x(), s.first.y(), s.second.x(),
                     s.second.y());
}

/// The text " near (x, y), where edge ... meets edge ..." of the first pair of edges that meet where they
/// should not; empty if none is found. Edges are named by coordinates, because orientation has renumbered the
/// vertices.
std::string crossing(const std::vector<Ring>& rings, const std::vector<std::string>& labels) {
  struct Edge {
    std::size_t ring;
    std::size_t i;
    BoostSegment segment;
  };
  std::vector<Edge> edges;
  for (std::size_t r = 0; r < rings.size(); ++r)
    for (std::size_t i = 0; i < rings[r].size(); ++i)
      edges.push_back({r, i, {boost_point(rings[r][i]), boost_point(rings[r][(i + 1) % rings[r].size()])}});
  for (std::size_t a = 0; a < edges.size(); ++a) {
    for (std::size_t b = a + 1; b < edges.size(); ++b) {
      const std::size_t n = rings[edges[a].ring].size();
      const bool neighbours = edges[a].ring == edges[b].ring &&
                              (edges[b].i - edges[a].i == 1 || edges[b].i - edges[a].i == n - 1);
      if (neighbours) continue;
      std::vector<BoostPoint> points;
      bg::intersection(edges[a].segment, edges[b].segment, points);
      if (points.empty()) continue;
      return fmt::format(" near ({:.6g}, {:.6g}), where edge {} of the {} meets edge {} of the {}",
                         points[0].x(), points[0].y(), edge_text(edges[a].segment), labels[edges[a].ring],
                         edge_text(edges[b].segment), labels[edges[b].ring]);
    }
  }
  return "";
}

std::string reason(bg::validity_failure_type failure, const std::vector<Ring>& rings,
                   const std::vector<std::string>& labels) {
  switch (failure) {
    case bg::failure_spikes:
      return "has a spike: an edge runs back along the one before it";
    case bg::failure_self_intersections:
      return rings.size() > 1 ? "has edges that cross or touch" + crossing(rings, labels)
                              : "crosses or touches itself" + crossing(rings, labels);
    case bg::failure_interior_rings_outside:
      return "has a hole outside the outer ring";
    case bg::failure_nested_interior_rings:
      return "has a hole inside another hole";
    case bg::failure_disconnected_interior:
      return "falls into several parts, because holes touch each other or the outer ring at more than one "
             "point";
    case bg::failure_wrong_orientation: {
      // The rings are oriented by their signed area before, so it is zero: a figure of eight, or all in one
      // line.
      const std::string where = crossing(rings, labels);
      return where.empty() ? "has no area" : "crosses or touches itself" + where;
    }
    case bg::failure_wrong_topological_dimension:
      return "has no area";
    default:
      return fmt::format("is not a valid polygon: {}", bg::validity_failure_type_message(failure));
  }
}

/// Drops repeated neighbours, the closing vertex included, and checks what must hold for each ring on its
/// own.
void tidy_ring(Ring& ring, const std::string& origin, const std::string& label) {
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (!ring[i].allFinite())
      input_error("{}: vertex {} of the {} is ({}, {}), expected finite numbers", origin, i + 1, label,
                  ring[i].x(), ring[i].y());
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  while (ring.size() > 1 && ring.back() == ring.front()) ring.pop_back();
  if (ring.size() < 3)
    input_error("{}: the {} has {} different {}, expected at least 3", origin, label, ring.size(),
                ring.size() == 1 ? "vertex" : "vertices");
}

/// Where the line "component = limit" cuts a-b. The order of the end points does not matter, so that the
/// cells on both sides of the line find the same point.
Eigen::Vector2d cut(Eigen::Vector2d a, Eigen::Vector2d b, int component, double limit) {
  if (a[component] > b[component]) std::swap(a, b);
  const int other = 1 - component;
  const double s = (limit - a[component]) / (b[component] - a[component]);
  Eigen::Vector2d x;
  x[component] = limit;
  x[other] = a[other] + s * (b[other] - a[other]);
  return x;
}

/// Keeps the part of a ring where side * x[component] <= side * limit.
void clip_half_plane(const Ring& ring, int component, double limit, double side, Ring& out) {
  out.clear();
  if (ring.empty()) return;
  Eigen::Vector2d a = ring.back();
  bool a_inside = side * a[component] <= side * limit;
  for (const Eigen::Vector2d& b : ring) {
    const bool b_inside = side * b[component] <= side * limit;
    if (a_inside != b_inside) out.push_back(cut(a, b, component, limit));
    if (b_inside) out.push_back(b);
    a = b;
    a_inside = b_inside;
  }
}

}  // namespace

Outline::Outline(std::vector<Ring> rings, const std::string& origin, std::vector<std::string> labels)
    : rings_(std::move(rings)) {
  if (rings_.empty()) input_error("{}: no vertices, expected at least 3", origin);
  for (std::size_t r = labels.size(); r < rings_.size(); ++r)
    labels.push_back(r == 0 ? "outer ring" : fmt::format("hole {}", r));
  for (std::size_t r = 0; r < rings_.size(); ++r) {
    Ring& ring = rings_[r];
    tidy_ring(ring, origin, labels[r]);
    if ((signed_area(ring) > 0.0) != (r == 0))
      std::reverse(ring.begin() + 1, ring.end());  // vertex 1 stays first
    // One ring at a time first, so that the message can say which one.
    std::vector<Ring> alone{ring};
    if (r > 0) std::reverse(alone[0].begin() + 1, alone[0].end());
    bg::validity_failure_type failure{};
    if (!bg::is_valid(boost_polygon(alone), failure))
      input_error("{}: the {} {}", origin, labels[r], reason(failure, alone, {labels[r]}));
  }
  bg::validity_failure_type failure{};
  if (!bg::is_valid(boost_polygon(rings_), failure))
    input_error("{}: the polygon {}", origin, reason(failure, rings_, labels));

  lower_ = upper_ = rings_[0][0];
  for (const auto& x : rings_[0]) {
    lower_ = lower_.cwiseMin(x);
    upper_ = upper_.cwiseMax(x);
  }
  Moments sum;
  for (const auto& ring : rings_) add_moments(ring, 0.5 * (lower_ + upper_), sum);
  area_ = sum.area;
}

bool Outline::contains(const Eigen::Vector2d& x) const {
  if ((x.array() < lower_.array()).any() || (x.array() > upper_.array()).any()) return false;
  bool inside = false;
  for (const auto& ring : rings_) {
    const Eigen::Vector2d* a = &ring.back();
    for (const auto& b : ring) {
      if ((a->y() > x.y()) != (b.y() > x.y())) {
        // Ordered end points: a shared edge gives the same number whichever polygon asks.
        const Eigen::Vector2d& low = a->y() < b.y() ? *a : b;
        const Eigen::Vector2d& high = a->y() < b.y() ? b : *a;
        const double at = low.x() + (x.y() - low.y()) / (high.y() - low.y()) * (high.x() - low.x());
        if (x.x() < at) inside = !inside;
      }
      a = &b;
    }
  }
  return inside;
}

ClippedCell clip_cell(const Outline& outline, const Eigen::Vector2d& lower, const Eigen::Vector2d& upper) {
  if (!(lower.array() < upper.array()).all())
    input_error("clipping: the cell's lower corner ({}, {}) is not below its upper corner ({}, {})",
                lower.x(), lower.y(), upper.x(), upper.y());
  ClippedCell result;
  const Eigen::Vector2d centre = 0.5 * (lower + upper);
  result.centroid = centre;
  if ((outline.lower().array() >= upper.array()).any() || (outline.upper().array() <= lower.array()).any())
    return result;
  Moments sum;
  Ring a, b;
  for (const Ring& ring : outline.rings()) {
    clip_half_plane(ring, 0, upper.x(), 1.0, a);
    clip_half_plane(a, 0, lower.x(), -1.0, b);
    clip_half_plane(b, 1, upper.y(), 1.0, a);
    clip_half_plane(a, 1, lower.y(), -1.0, b);
    add_moments(b, centre, sum);
  }
  const double whole = (upper - lower).prod();
  // Cancellation of a hole against the outer ring leaves rounding of the cell's area, of either sign.
  if (sum.area <= 1e-15 * whole) return result;
  result.area = std::min(sum.area, whole);
  result.centroid = (centre + sum.first / sum.area).cwiseMax(lower).cwiseMin(upper);
  return result;
}

double clipped_area(const Outline& outline, const Eigen::Vector2d& centre,
                    const std::vector<HalfPlane>& sides) {
  Moments sum;
  Ring a, b;
  for (const Ring& ring : outline.rings()) {
    a = ring;
    for (const HalfPlane& side : sides) {
      b.clear();
      if (a.empty()) break;
      Eigen::Vector2d from = a.back();
      double before = side.normal.dot(from - side.point);
      for (const Eigen::Vector2d& to : a) {
        const double now = side.normal.dot(to - side.point);
        if ((before <= 0.0) != (now <= 0.0)) b.push_back(from + before / (before - now) * (to - from));
        if (now <= 0.0) b.push_back(to);
        from = to, before = now;
      }
      std::swap(a, b);
    }
    if (!a.empty()) add_moments(a, centre, sum);
  }
  return std::max(sum.area, 0.0);
}

}  // namespace wisp
