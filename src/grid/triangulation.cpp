#include "grid/triangulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>

#include "core/error.h"
#include "core/nearest.h"
#include "geometry/orientation.h"

namespace wisp {

namespace {
/// A list this long is searched faster by walking.
constexpr std::size_t long_list = 48;
constexpr int steps_from_hint = 12;

std::uint64_t pair_key(int a, int b) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) << 32 | static_cast<std::uint32_t>(b);
}
}  // namespace

Triangulation::Triangulation(std::vector<Vec<2>> vertices, std::vector<std::array<int, 3>> triangles,
                             std::string_view origin)
    : vertices_(std::move(vertices)), triangles_(std::move(triangles)) {
  check_vertices(origin);
  turn(origin);
  join(origin);
  list_around_vertices();
  measure();
  fill_bins();
  check_overlaps(origin);
}

void Triangulation::check_vertices(std::string_view origin) {
  if (triangles_.empty()) input_error("{}: there is no triangle", origin);
  for (int v = 0; v < n_vertices(); ++v)
    if (!vertex(v).allFinite())
      input_error("{}: the coordinates of vertex {} are not finite numbers", origin, v);
  std::vector<char> used(vertices_.size(), 0);
  for (int t = 0; t < n_triangles(); ++t)
    for (int v : triangle(t)) {
      if (v < 0 || v >= n_vertices())
        input_error("{}: triangle {} names vertex {}, expected 0 to {}", origin, t, v, n_vertices() - 1);
      used[index(v)] = 1;
    }
  const auto isolated = std::count(used.begin(), used.end(), char{0});
  if (isolated > 0) {
    const auto first = static_cast<int>(std::find(used.begin(), used.end(), char{0}) - used.begin());
    input_error("{}: {} of {} vertices belong to no triangle, the first is vertex {} at ({}, {})", origin,
                isolated, n_vertices(), first, vertex(first).x(), vertex(first).y());
  }
}

void Triangulation::turn(std::string_view origin) {
  int clockwise = 0, first = -1;
  for (int t = 0; t < n_triangles(); ++t) {
    const int side = orientation(corner(t, 0), corner(t, 1), corner(t, 2));
    if (side == 0) {
      const auto& v = triangle(t);
      input_error("{}: triangle {} (vertices {}, {}, {}) near ({:.6g}, {:.6g}) has no area", origin, t, v[0],
                  v[1], v[2], centroid(t).x(), centroid(t).y());
    }
    if (side < 0 && clockwise++ == 0) first = t;
  }
  if (clockwise == n_triangles()) {
    for (auto& v : triangles_) std::swap(v[1], v[2]);
  } else if (clockwise > 0) {
    input_error(
        "{}: {} of {} triangles are inverted (run clockwise), the first is triangle {} (vertices {}, {}, {}) "
        "near ({:.6g}, {:.6g})",
        origin, clockwise, n_triangles(), first, triangle(first)[0], triangle(first)[1], triangle(first)[2],
        centroid(first).x(), centroid(first).y());
  }
}

void Triangulation::join(std::string_view origin) {
  neighbours_.assign(triangles_.size(), {-1, -1, -1});
  edges_of_.assign(triangles_.size(), {-1, -1, -1});
  std::unordered_map<std::uint64_t, std::array<int, 2>> open;  // directed edge -> triangle and its edge
  open.reserve(3 * triangles_.size());
  for (int t = 0; t < n_triangles(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = triangle(t)[index(k)], b = triangle(t)[index((k + 1) % 3)];
      const auto [place, isnew] = open.try_emplace(pair_key(a, b), std::array<int, 2>{t, k});
      if (!isnew)
        input_error(
            "{}: triangles {} and {} overlap: both lie on the same side of the edge between vertices {} and "
            "{}, ({:.6g}, {:.6g}) to ({:.6g}, {:.6g})",
            origin, place->second[0], t, a, b, vertex(a).x(), vertex(a).y(), vertex(b).x(), vertex(b).y());
    }
  for (int t = 0; t < n_triangles(); ++t)
    for (int k = 0; k < 3; ++k) {
      if (edge(t, k) >= 0) continue;
      const int a = triangle(t)[index(k)], b = triangle(t)[index((k + 1) % 3)];
      const int e = n_edges();
      edges_of_[index(t)][index(k)] = e;
      edges_.push_back({{a, b}, {t, -1}});
      if (const auto other = open.find(pair_key(b, a)); other != open.end()) {
        const auto [u, m] = other->second;
        edges_.back().triangle[1] = u;
        neighbours_[index(t)][index(k)] = u;
        neighbours_[index(u)][index(m)] = t;
        edges_of_[index(u)][index(m)] = e;
      }
    }
}

void Triangulation::list_around_vertices() {
  std::vector<std::vector<std::array<int, 2>>> corners(vertices_.size());
  for (int t = 0; t < n_triangles(); ++t)
    for (int k = 0; k < 3; ++k) corners[index(triangle(t)[index(k)])].push_back({t, k});
  on_boundary_.assign(vertices_.size(), 0);
  around_.reserve(3 * triangles_.size());
  std::vector<char> listed(triangles_.size(), 0);
  for (int v = 0; v < n_vertices(); ++v) {
    around_start_.push_back(static_cast<int>(around_.size()));
    auto& here = corners[index(v)];
    // Fans that start at the boundary first; what is left then is one closed ring.
    std::stable_partition(here.begin(), here.end(), [&](const auto& c) { return neighbour(c[0], c[1]) < 0; });
    on_boundary_[index(v)] = neighbour(here.front()[0], here.front()[1]) < 0;
    for (auto [t, k] : here) {
      while (t >= 0 && !listed[index(t)]) {
        listed[index(t)] = 1;
        around_.push_back(t);
        t = neighbour(t, (k + 2) % 3);
        if (t >= 0)
          k = static_cast<int>(std::find(triangle(t).begin(), triangle(t).end(), v) - triangle(t).begin());
      }
    }
    for (const auto& c : here) listed[index(c[0])] = 0;
  }
  around_start_.push_back(static_cast<int>(around_.size()));
}

std::span<const int> Triangulation::triangles_of_vertex(int v) const {
  const auto first = index(around_start_[index(v)]), last = index(around_start_[index(v) + 1]);
  return std::span<const int>(around_).subspan(first, last - first);
}

double Triangulation::edge_length(int e) const {
  return (vertex(edge(e).vertex[1]) - vertex(edge(e).vertex[0])).norm();
}

double Triangulation::area(int t) const {
  const Vec<2> u = corner(t, 1) - corner(t, 0), w = corner(t, 2) - corner(t, 0);
  return 0.5 * (u.x() * w.y() - u.y() * w.x());
}

double Triangulation::height(int t, int k) const {
  return 2.0 * area(t) / (corner(t, (k + 1) % 3) - corner(t, k)).norm();
}

double Triangulation::total_area() const {
  double sum = 0.0;
  for (int t = 0; t < n_triangles(); ++t) sum += area(t);
  return sum;
}

void Triangulation::measure() {
  lower_ = upper_ = vertices_.front();
  for (const auto& x : vertices_) lower_ = lower_.cwiseMin(x), upper_ = upper_.cwiseMax(x);
  shortest_height_ = std::numeric_limits<double>::infinity();
  smallest_angle_ = std::numbers::pi;
  shapes_.resize(triangles_.size());
  for (int t = 0; t < n_triangles(); ++t) {
    const Vec<2> u = corner(t, 1) - corner(t, 0), w = corner(t, 2) - corner(t, 0);
    const double twice = u.x() * w.y() - u.y() * w.x();
    shapes_[index(t)] = {corner(t, 0), {Vec<2>(w.y(), -w.x()) / twice, Vec<2>(-u.y(), u.x()) / twice}};
    for (int k = 0; k < 3; ++k) {
      const Vec<2> p = corner(t, (k + 1) % 3) - corner(t, k), q = corner(t, (k + 2) % 3) - corner(t, k);
      shortest_height_ = std::min(shortest_height_, twice / p.norm());
      smallest_angle_ = std::min(smallest_angle_, std::atan2(twice, p.dot(q)));
    }
  }
}

std::array<int, 2> Triangulation::bin(const Vec<2>& x) const {
  std::array<int, 2> b{};
  for (int d = 0; d < 2; ++d) {
    const double s =
        (x[d] - lower_[d]) * per_bin_[d];  // monotone in x, so boxes meet the bins of their points
    b[index(d)] = s > 0.0 ? (s < bins_[index(d)] ? static_cast<int>(s) : bins_[index(d)] - 1) : 0;
  }
  return b;
}

std::span<const int> Triangulation::in_bin(const std::array<int, 2>& b) const {
  const auto i = index(b[0] + bins_[0] * b[1]);
  const auto first = index(bin_start_[i]), last = index(bin_start_[i + 1]);
  return std::span<const int>(bin_triangles_).subspan(first, last - first);
}

void Triangulation::fill_bins() {
  const Vec<2> extent = upper_ - lower_;
  const double side = std::sqrt(extent.prod() / n_triangles());
  for (int d = 0; d < 2; ++d) {
    bins_[index(d)] = std::clamp(static_cast<int>(extent[d] / side), 1, 2 * n_triangles());
    per_bin_[d] = bins_[index(d)] / extent[d];
  }
  const auto for_each_bin = [&](int t, auto&& f) {
    Vec<2> low = corner(t, 0), high = corner(t, 0);
    for (int k = 1; k < 3; ++k) low = low.cwiseMin(corner(t, k)), high = high.cwiseMax(corner(t, k));
    const Vec<2> margin = safely_inside * (high - low);
    const auto from = bin(low - margin), to = bin(high + margin);
    for (int j = from[1]; j <= to[1]; ++j)
      for (int i = from[0]; i <= to[0]; ++i) f(index(i + bins_[0] * j));
  };
  const auto n = index(bins_[0]) * index(bins_[1]);
  bin_start_.assign(n + 1, 0);
  for (int t = 0; t < n_triangles(); ++t) for_each_bin(t, [&](std::size_t b) { ++bin_start_[b + 1]; });
  for (std::size_t b = 0; b < n; ++b) bin_start_[b + 1] += bin_start_[b];
  bin_triangles_.resize(index(bin_start_[n]));
  std::vector<int> next(bin_start_.begin(), bin_start_.end() - 1);
  for (int t = 0; t < n_triangles(); ++t)
    for_each_bin(t, [&](std::size_t b) { bin_triangles_[index(next[b]++)] = t; });
}

void Triangulation::check_overlaps(std::string_view origin) const {
  std::vector<std::array<double, 4>> boxes;
  for (int t = 0; t < n_triangles(); ++t) {
    const Vec<2>&a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
    boxes.push_back({std::min({a.x(), b.x(), c.x()}), std::min({a.y(), b.y(), c.y()}),
                     std::max({a.x(), b.x(), c.x()}), std::max({a.y(), b.y(), c.y()})});
  }
  for (int j = 0; j < bins_[1]; ++j)
    for (int i = 0; i < bins_[0]; ++i) {
      const auto here = in_bin({i, j});
      for (std::size_t a = 0; a < here.size(); ++a)
        for (std::size_t b = a + 1; b < here.size(); ++b) {
          const auto &p = boxes[index(here[a])], &q = boxes[index(here[b])];
          const Vec<2> low(std::max(p[0], q[0]), std::max(p[1], q[1]));
          const Vec<2> high(std::min(p[2], q[2]), std::min(p[3], q[3]));
          // Each pair once: in the bin of the lower corner of the boxes' common part.
          if (low.x() <= high.x() && low.y() <= high.y() && bin(low) == std::array<int, 2>{i, j})
            check_pair(here[a], here[b], origin);
        }
    }
}

void Triangulation::check_pair(int s, int t, std::string_view origin) const {
  // Two convex shapes are apart if a side of one has the other on its far side.
  const auto separates = [&](int one, int other) {
    for (int k = 0; k < 3; ++k) {
      bool beyond = true;
      for (int m = 0; m < 3 && beyond; ++m)
        beyond = orientation(corner(one, k), corner(one, (k + 1) % 3), corner(other, m)) <= 0;
      if (beyond) return true;
    }
    return false;
  };
  const auto is_corner = [&](int one, int v) {
    return std::find(triangle(one).begin(), triangle(one).end(), v) != triangle(one).end();
  };
  const auto touch = [&](int one, int other) {
    for (int v : triangle(one))
      if (!is_corner(other, v) && holds(other, vertex(v))) {
        for (int w : triangle(other))
          if (vertex(v) == vertex(w))
            input_error("{}: vertices {} and {} coincide at ({}, {})", origin, std::min(v, w), std::max(v, w),
                        vertex(v).x(), vertex(v).y());
        input_error("{}: vertex {} at ({}, {}) lies on an edge of triangle {} without being its corner",
                    origin, v, vertex(v).x(), vertex(v).y(), other);
      }
  };
  if (!separates(s, t) && !separates(t, s))
    input_error("{}: triangles {} and {} overlap, near ({}, {})", origin, s, t, centroid(s).x(),
                centroid(s).y());
  touch(s, t);
  touch(t, s);
}

bool Triangulation::holds(int t, const Vec<2>& x) const {
  for (int k = 0; k < 3; ++k)
    if (orientation(corner(t, k), corner(t, (k + 1) % 3), x) < 0) return false;
  return true;
}

int Triangulation::locate_from(const Vec<2>& x, int hint) const {
  if (!x.allFinite()) return -1;
  if (hint >= 0)
    if (const int t = walk(x, hint, steps_from_hint); t >= 0) return lowest_holder(t, x);
  const auto here = in_bin(bin(x));
  if (here.size() > long_list) {
    const int steps = 4 * static_cast<int>(std::sqrt(static_cast<double>(here.size()))) + 16;
    if (const int t = walk(x, here[here.size() / 2], steps); t >= 0) return lowest_holder(t, x);
  }
  return search_bin(x);
}

int Triangulation::walk(const Vec<2>& x, int start, int most_steps) const {
  int t = start, before = -1;
  for (int step = 0; step < most_steps; ++step) {
    int next = t;
    for (int m = 0; m < 3; ++m) {
      const int k = (m + step) % 3;  // another edge first each time, or the walk may turn in circles
      const int u = neighbour(t, k);
      if (u == before && u >= 0) continue;
      if (orientation(corner(t, k), corner(t, (k + 1) % 3), x) < 0) {
        next = u;
        break;
      }
    }
    if (next == t) return t;
    if (next < 0) return -1;  // perhaps only around a corner of the domain: the bins know
    before = t;
    t = next;
  }
  return -1;
}

int Triangulation::lowest_holder(int t, const Vec<2>& x) const {
  int on_edge = -1;
  for (int k = 0; k < 3; ++k) {
    if (orientation(corner(t, k), corner(t, (k + 1) % 3), x) != 0) continue;
    if (on_edge < 0) {
      on_edge = k;
      continue;
    }
    const int shared = k == (on_edge + 1) % 3 ? k : on_edge;  // two edges at once: the corner between them
    const auto around = triangles_of_vertex(triangle(t)[index(shared)]);
    return *std::min_element(around.begin(), around.end());
  }
  if (on_edge < 0 || neighbour(t, on_edge) < 0) return t;
  return std::min(t, neighbour(t, on_edge));
}

int Triangulation::search_bin(const Vec<2>& x) const {
  const auto here = in_bin(bin(x));
  for (int t : here)
    if (holds(t, x)) return t;
  int nearest = -1;
  double least = -safely_inside;
  for (int t : here) {
    const auto b = barycentric(t, x);
    if (const double lowest = std::min({b[0], b[1], b[2]}); lowest >= least) {
      if (lowest == least && nearest >= 0) continue;
      least = lowest;
      nearest = t;
    }
  }
  return nearest;
}

int Triangulation::find_edge(int a, int b) const {
  if (a < 0 || a >= n_vertices()) return -1;
  for (int t : triangles_of_vertex(a))
    for (int k = 0; k < 3; ++k) {
      const auto& v = edge(edge(t, k)).vertex;
      if ((v[0] == a && v[1] == b) || (v[0] == b && v[1] == a)) return edge(t, k);
    }
  return -1;
}

void Triangulation::add_part(const std::string& name, std::span<const std::array<int, 2>> edges,
                             std::span<const int> vertices, std::span<const int> triangles) {
  const auto at = std::find_if(parts_.begin(), parts_.end(), [&](const auto& p) { return p.name == name; });
  NamedPart part = at == parts_.end() ? NamedPart{name, {}, {}, {}} : *at;
  for (const auto& [a, b] : edges) {
    const int e = find_edge(a, b);
    if (e < 0) input_error("boundary '{}': no edge joins vertices {} and {}", name, a, b);
    part.edges.push_back(e);
    part.vertices.insert(part.vertices.end(), {a, b});
  }
  for (int v : vertices) {
    if (v < 0 || v >= n_vertices()) input_error("boundary '{}': there is no vertex {}", name, v);
    part.vertices.push_back(v);
  }
  for (int t : triangles) {
    if (t < 0 || t >= n_triangles()) input_error("part '{}': there is no triangle {}", name, t);
    part.triangles.push_back(t);
  }
  for (auto* list : {&part.edges, &part.vertices, &part.triangles}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  if (at == parts_.end())
    parts_.push_back(std::move(part));
  else
    *at = std::move(part);
}

const NamedPart& Triangulation::part(std::string_view name) const {
  std::vector<std::string> names;
  for (const auto& p : parts_) {
    if (p.name == name) return p;
    names.push_back(p.name);
  }
  if (names.empty()) input_error("the triangulation names no boundaries, but '{}' is asked for", name);
  input_error("the triangulation has no boundary '{}'{}", name, suggestion(name, names));
}

}  // namespace wisp
