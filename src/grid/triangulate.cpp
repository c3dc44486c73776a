#include "grid/triangulate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "core/error.h"
#include "geometry/delaunay.h"
#include "grid/gmsh.h"

namespace wisp {

namespace {

constexpr double sliver_angle = 5.0 * std::numbers::pi / 180.0;
constexpr int smoothing_passes = 8;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

Triangulation triangulate_blocks(const StructuredGrid<2>& blocks, BlockSplit split) {
  const int nx = blocks.cells(0), ny = blocks.cells(1);
  const auto node = [&](int i, int j) { return i + (nx + 1) * j; };
  std::vector<Vec<2>> vertices;
  std::vector<std::array<int, 3>> triangles;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) vertices.push_back(blocks.node({i, j}));
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int a = node(i, j), b = node(i + 1, j), c = node(i + 1, j + 1), d = node(i, j + 1);
      if (split == BlockSplit::four) {
        const int m = static_cast<int>(vertices.size());
        vertices.emplace_back(0.5 * (vertices[at(a)] + vertices[at(c)]));
        triangles.insert(triangles.end(), {{a, b, m}, {b, c, m}, {c, d, m}, {d, a, m}});
      } else if (split == BlockSplit::two || (i + j) % 2 == 0) {
        triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
      } else {
        triangles.insert(triangles.end(), {{a, b, d}, {b, c, d}});
      }
    }
  Triangulation result(std::move(vertices), std::move(triangles));
  std::vector<std::array<int, 2>> left, right, bottom, top;
  for (int j = 0; j < ny; ++j) left.push_back({node(0, j), node(0, j + 1)});
  for (int j = 0; j < ny; ++j) right.push_back({node(nx, j), node(nx, j + 1)});
  for (int i = 0; i < nx; ++i) bottom.push_back({node(i, 0), node(i + 1, 0)});
  for (int i = 0; i < nx; ++i) top.push_back({node(i, ny), node(i + 1, ny)});
  result.add_part("left", left), result.add_part("right", right);
  result.add_part("bottom", bottom), result.add_part("top", top);
  return result;
}

namespace {

double distance_to_segment(const Vec<2>& x, const Vec<2>& a, const Vec<2>& b) {
  const double s = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (x - a - s * (b - a)).norm();
}

/// The vertices of a polygon's triangulation, with the segments that must become edges.
class PolygonMesh {
 public:
  PolygonMesh(const Outline& outline, const PolygonVertices& wanted) : outline_(outline), wanted_(wanted) {
    tolerance_ = 1e-10 * (outline.upper() - outline.lower()).norm();
    divide_sides();
    n_boundary_ = vertices_.size();
    add_given();
    n_fixed_ = vertices_.size();
    if (wanted.spacing > 0) fill();
  }

  Triangulation triangulate() {
    // Smoothing moves inner vertices only; the segments of the sides are mended at the end.
    for (int pass = 0; pass < smoothing_passes && wanted_.irregularity == 0.0 && vertices_.size() > n_fixed_;
         ++pass)
      smooth(inner_triangles());
    constexpr int most_rounds = 30;
    for (int round = 0; round < most_rounds; ++round) {
      const auto triangles = inner_triangles();
      if (!mend(triangles)) return finish(triangles);
    }
    input_error("polygon: its sides cannot be triangulated: they come too close to one another");
  }

 private:
  struct Segment {
    int a, b;
    int ring, side;
  };

  /// Corners, given vertices that lie on sides, and equal parts between them.
  void divide_sides() {
    std::vector<char> used(wanted_.given.size(), 0);
    for (std::size_t r = 0; r < outline_.rings().size(); ++r) {
      const Ring& ring = outline_.rings()[r];
      const int first = static_cast<int>(vertices_.size());
      for (std::size_t s = 0; s < ring.size(); ++s) {
        const Vec<2>&a = ring[s], &b = ring[(s + 1) % ring.size()];
        std::vector<double> stops{0.0};
        for (std::size_t g = 0; g < wanted_.given.size(); ++g)
          if (!used[g] && distance_to_segment(wanted_.given[g], a, b) <= tolerance_) {
            used[g] = 1;
            const double along = (wanted_.given[g] - a).dot(b - a) / (b - a).squaredNorm();
            if ((wanted_.given[g] - a).norm() > tolerance_ && (wanted_.given[g] - b).norm() > tolerance_)
              stops.push_back(along);
          }
        std::sort(stops.begin(), stops.end());
        stops.push_back(1.0);
        for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
          const double length = (stops[k + 1] - stops[k]) * (b - a).norm();
          const int parts = wanted_.spacing > 0
                                ? std::max(1, static_cast<int>(std::ceil(length / wanted_.spacing - 1e-9)))
                                : 1;
          for (int q = 0; q < parts; ++q) {
            const double t = stops[k] + (stops[k + 1] - stops[k]) * q / parts;
            const int v = static_cast<int>(vertices_.size());
            vertices_.push_back(t == 0.0 ? a : Vec<2>(a + t * (b - a)));
            segments_.push_back({v, v + 1, static_cast<int>(r), static_cast<int>(s)});
          }
        }
      }
      segments_.back().b = first;
    }
    for (std::size_t g = 0; g < used.size(); ++g)
      if (!used[g]) inside_.push_back(wanted_.given[g]);
  }

  void add_given() {
    std::set<std::pair<double, double>> seen;
    for (const auto& x : inside_) {
      if (!outline_.contains(x)) input_error("polygon: the given vertex ({}, {}) lies outside", x.x(), x.y());
      if (!seen.insert({x.x(), x.y()}).second)
        input_error("polygon: the given vertex ({}, {}) is listed twice", x.x(), x.y());
      vertices_.push_back(x);
    }
  }

  bool close_to_fixed(const Vec<2>& x, double distance) const {
    for (const auto& s : segments_)
      if (distance_to_segment(x, vertices_[at(s.a)], vertices_[at(s.b)]) < distance) return true;
    for (std::size_t v = n_boundary_; v < n_fixed_; ++v)
      if ((vertices_[v] - x).norm() < distance) return true;
    return false;
  }

  /// Rows of equilateral triangles.
  void fill() {
    const double h = wanted_.spacing, row = h * std::sqrt(0.75);
    const Vec<2> extent = outline_.upper() - outline_.lower();
    const int rows = static_cast<int>(extent.y() / row) + 1, columns = static_cast<int>(extent.x() / h) + 1;
    std::mt19937 random(wanted_.seed);
    const auto shift = [&] {  // own scaling: the standard's distributions differ between libraries
      return wanted_.irregularity * h * (2.0 * static_cast<double>(random()) / 4294967296.0 - 1.0);
    };
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i) {
        Vec<2> x = outline_.lower() + Vec<2>((i + (j % 2 ? 0.5 : 0.0)) * h, (j + 0.5) * row);
        if (wanted_.irregularity > 0) x += Vec<2>(shift(), shift());
        if (outline_.contains(x) && !close_to_fixed(x, 0.55 * h)) vertices_.push_back(x);
      }
  }

  std::vector<std::array<int, 3>> inner_triangles() const {
    auto triangles = delaunay(vertices_);
    std::erase_if(triangles, [&](const auto& t) {
      return !outline_.contains((vertices_[at(t[0])] + vertices_[at(t[1])] + vertices_[at(t[2])]) / 3.0);
    });
    return triangles;
  }

  void smooth(const std::vector<std::array<int, 3>>& triangles) {
    std::vector<Vec<2>> sum(vertices_.size(), Vec<2>::Zero());
    std::vector<int> count(vertices_.size(), 0);
    for (const auto& t : triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        sum[at(t[k])] += vertices_[at(t[(k + 1) % 3])] + vertices_[at(t[(k + 2) % 3])];
        count[at(t[k])] += 2;
      }
    for (std::size_t v = n_fixed_; v < vertices_.size(); ++v)
      if (count[v] > 0) vertices_[v] = sum[v] / count[v];
  }

  /// Halves the segments that are no edges; whether there were any.
  bool mend(const std::vector<std::array<int, 3>>& triangles) {
    std::set<std::pair<int, int>> edges;
    for (const auto& t : triangles)
      for (std::size_t k = 0; k < 3; ++k) edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
    std::vector<Segment> all;
    for (const auto& s : segments_) {
      if (edges.contains(std::minmax(s.a, s.b))) {
        all.push_back(s);
        continue;
      }
      const int middle = static_cast<int>(vertices_.size());
      vertices_.emplace_back(0.5 * (vertices_[at(s.a)] + vertices_[at(s.b)]));
      all.push_back({s.a, middle, s.ring, s.side});
      all.push_back({middle, s.b, s.ring, s.side});
    }
    const bool mended = all.size() > segments_.size();
    segments_ = std::move(all);
    return mended;
  }

  Triangulation finish(const std::vector<std::array<int, 3>>& triangles) const {
    Triangulation result(vertices_, triangles, "Delaunay triangulation");
    if (std::abs(result.total_area() - outline_.area()) > 1e-9 * outline_.area())
      input_error("Delaunay triangulation: its area is {} m2, that of the polygon {} m2", result.total_area(),
                  outline_.area());
    std::map<std::string, std::vector<std::array<int, 2>>> parts;
    for (const auto& s : segments_) {
      parts[s.ring == 0 ? "outer" : "hole " + std::to_string(s.ring)].push_back({s.a, s.b});
      if (s.ring == 0) parts["side " + std::to_string(s.side + 1)].push_back({s.a, s.b});
    }
    for (const auto& [name, edges] : parts) result.add_part(name, edges);
    return result;
  }

  const Outline& outline_;
  const PolygonVertices& wanted_;
  std::vector<Vec<2>> vertices_, inside_;
  std::vector<Segment> segments_;
  std::size_t n_boundary_ = 0, n_fixed_ = 0;  ///< vertices on sides, and with those that are given
  double tolerance_ = 0.0;
};

}  // namespace

Triangulation triangulate_polygon(const Outline& outline, const PolygonVertices& vertices) {
  return PolygonMesh(outline, vertices).triangulate();
}

Triangulation make_triangulation(const AnyTriangulationOptions& options,
                                 const std::filesystem::path& folder) {
  if (const auto* blocks = std::get_if<TriangleBlocksOptions>(&options)) {
    StructuredGridOptions lines;
    lines.lower = blocks->lower, lines.upper = blocks->upper, lines.cells = blocks->cells;
    lines.coordinates = blocks->coordinates;
    return triangulate_blocks(StructuredGrid<2>(lines), blocks->split);
  }
  if (const auto* gmsh = std::get_if<GmshOptions>(&options))
    return read_gmsh(folder / gmsh->file, gmsh->scale);
  const auto& delaunay = std::get<DelaunayOptions>(options);
  PolygonVertices vertices;
  vertices.spacing = delaunay.spacing, vertices.irregularity = delaunay.irregularity;
  vertices.seed = static_cast<unsigned>(delaunay.seed);
  for (const auto& x : delaunay.vertices) {
    if (x.size() != 2) input_error("grid: each of vertices needs 2 numbers, found {}", x.size());
    vertices.given.emplace_back(x[0], x[1]);
  }
  return triangulate_polygon(outline(delaunay.outline, folder), vertices);
}

namespace {

double smallest_angle(const Triangulation& triangulation, int t) {
  double least = std::numbers::pi;
  for (int k = 0; k < 3; ++k) {
    const Vec<2> p = triangulation.corner(t, (k + 1) % 3) - triangulation.corner(t, k),
                 q = triangulation.corner(t, (k + 2) % 3) - triangulation.corner(t, k);
    least = std::min(least, std::atan2(2.0 * triangulation.area(t), p.dot(q)));
  }
  return least;
}

}  // namespace

std::string quality_line(const Triangulation& triangulation) {
  return fmt::format("{} triangles, {} vertices; smallest angle {:.3g} degrees, shortest height {:.4g} m",
                     triangulation.n_triangles(), triangulation.n_vertices(),
                     triangulation.smallest_angle() * 180.0 / std::numbers::pi,
                     triangulation.shortest_height());
}

std::string sliver_warning(const Triangulation& triangulation) {
  int count = 0, worst = 0;
  double least = std::numbers::pi;
  for (int t = 0; t < triangulation.n_triangles(); ++t) {
    const double angle = smallest_angle(triangulation, t);
    count += angle < sliver_angle;
    if (angle < least) least = angle, worst = t;
  }
  if (count == 0) return {};
  const Vec<2> x = triangulation.centroid(worst);
  return fmt::format(
      "warning: {} triangle{} {} an angle below 5 degrees (slivers), the smallest is {:.3g} degrees near "
      "({:.6g}, "
      "{:.6g}): time steps become short and solutions poor there",
      count, count == 1 ? "" : "s", count == 1 ? "has" : "have", least * 180.0 / std::numbers::pi, x.x(),
      x.y());
}

}  // namespace wisp
