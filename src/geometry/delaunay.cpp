#include "geometry/delaunay.h"

#include <libqhull_r/qhull_ra.h>  // the C interface: the headers of Qhull's C++ classes (2020.2) are not C++20

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>

#include "core/error.h"

namespace wisp {

namespace {

/// A run of Qhull with its memory; text of the program goes nowhere.
class Qhull {
 public:
  Qhull(std::vector<double>& coordinates, const char* command) : silence_(std::tmpfile()) {
    qh_zero(&qh_, silence_);
    std::string text = command;
    const int n = static_cast<int>(coordinates.size() / 2);
    status_ = qh_new_qhull(&qh_, 2, n, coordinates.data(), False, text.data(), nullptr, silence_);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;
  ~Qhull() {
    qh_freeqhull(&qh_, !qh_ALL);
    int blocks = 0, bytes = 0;
    qh_memfreeshort(&qh_, &blocks, &bytes);
    if (silence_) std::fclose(silence_);
  }
  int status() const { return status_; }

  /// Point numbers of the triangles of the lower hull, in any sense.
  std::vector<std::array<int, 3>> triangles() {
    std::vector<std::array<int, 3>> list;
    qhT* const qh = &qh_;
    for (facetT* facet = qh->facet_list; facet && facet->next; facet = facet->next) {
      if (facet->upperdelaunay) continue;
      std::array<int, 3> t{};
      std::size_t k = 0;
      for (void** v = &facet->vertices->e[0].p; *v && k < 3; ++v)
        t[k++] = qh_pointid(qh, static_cast<vertexT*>(*v)->point);
      if (k == 3) list.push_back(t);
    }
    return list;
  }

 private:
  std::FILE* silence_;
  qhT qh_{};
  int status_ = 0;
};

bool on_one_line(const std::vector<Eigen::Vector2d>& points) {
  // The farthest point from the first gives the line with the least rounding.
  const auto& a = points.front();
  const auto far = *std::max_element(points.begin(), points.end(), [&](const auto& p, const auto& q) {
    return (p - a).squaredNorm() < (q - a).squaredNorm();
  });
  const double length = (far - a).norm();
  return std::all_of(points.begin(), points.end(), [&](const auto& p) {
    const Eigen::Vector2d u = far - a, w = p - a;
    return std::abs(u.x() * w.y() - u.y() * w.x()) <= 1e-13 * length * length;
  });
}

/// For every point the points across its edges. Of points on one line, the ones before and after.
std::vector<std::vector<int>> neighbours(const std::vector<Eigen::Vector2d>& points) {
  std::vector<std::vector<int>> lists(points.size());
  const auto join = [&](int a, int b) {
    lists[static_cast<std::size_t>(a)].push_back(b);
    lists[static_cast<std::size_t>(b)].push_back(a);
  };
  if (points.size() < 3 || on_one_line(points)) {
    std::vector<int> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
      const auto &p = points[static_cast<std::size_t>(a)], &q = points[static_cast<std::size_t>(b)];
      return p.x() != q.x() ? p.x() < q.x() : p.y() < q.y();
    });
    for (std::size_t i = 1; i < order.size(); ++i) join(order[i - 1], order[i]);
    return lists;
  }
  for (const auto& t : delaunay(points))
    for (std::size_t k = 0; k < 3; ++k) join(t[k], t[(k + 1) % 3]);
  for (auto& list : lists) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return lists;
}

}  // namespace

std::vector<std::array<int, 3>> delaunay(const std::vector<Eigen::Vector2d>& points) {
  if (points.size() < 3)
    input_error("Delaunay triangulation: expected at least 3 points, found {}", points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite())
      input_error("Delaunay triangulation: the coordinates of point {} are not finite numbers", i);
  if (on_one_line(points))
    input_error("Delaunay triangulation: all {} points lie on one line", points.size());
  // About the centre, so that the squares that Qhull works with lose no digits to a distant origin.
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const auto& p : points) centre += p / static_cast<double>(points.size());
  std::vector<double> coordinates;
  coordinates.reserve(2 * points.size());
  for (const auto& p : points)
    coordinates.insert(coordinates.end(), {p.x() - centre.x(), p.y() - centre.y()});
  // d Delaunay, Qbb scaled, Qt triangulated where points lie on one circle, Qz a point at infinity for points
  // that all do, Q12 no error where rounding makes facets wide.
  Qhull qhull(coordinates, "qhull d Qbb Qt Qz Q12");
  if (qhull.status() != 0)
    input_error("Delaunay triangulation: Qhull cannot triangulate the {} points (its status {})",
                points.size(), qhull.status());
  std::vector<std::array<int, 3>> triangles = qhull.triangles();
  std::erase_if(triangles, [&](auto& t) {
    const auto n = static_cast<int>(points.size());
    if (std::max({t[0], t[1], t[2]}) >= n) return true;  // the point at infinity
    const auto &a = points[static_cast<std::size_t>(t[0])], &b = points[static_cast<std::size_t>(t[1])],
               &c = points[static_cast<std::size_t>(t[2])];
    const Eigen::Vector2d u = b - a, w = c - a;
    const double twice = u.x() * w.y() - u.y() * w.x();
    // Points on the hull's straight sides leave triangles without area there.
    const double longest = std::max({u.squaredNorm(), w.squaredNorm(), (c - b).squaredNorm()});
    if (std::abs(twice) <= 1e-12 * longest) return true;
    if (twice < 0) std::swap(t[1], t[2]);
    return false;
  });
  return triangles;
}

std::vector<double> voronoi_areas(const std::vector<Eigen::Vector2d>& points, const Outline& outline) {
  if (points.empty()) input_error("Voronoi diagram: there are no points");
  std::map<std::pair<double, double>, std::size_t> seen;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (const auto [at, isnew] = seen.try_emplace({points[i].x(), points[i].y()}, i); !isnew)
      input_error("Voronoi diagram: points {} and {} coincide at ({}, {})", at->second, i, points[i].x(),
                  points[i].y());
  const auto lists = neighbours(points);
  std::vector<double> areas;
  std::vector<HalfPlane> sides;
  for (std::size_t i = 0; i < points.size(); ++i) {
    sides.clear();
    for (const int j : lists[i]) {
      const auto& other = points[static_cast<std::size_t>(j)];
      sides.push_back({other - points[i], 0.5 * (points[i] + other)});
    }
    areas.push_back(clipped_area(outline, points[i], sides));
  }
  return areas;
}

}  // namespace wisp
