#include "particle/triangle_sampling.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>

#include "core/error.h"
#include "geometry/clip.h"
#include "geometry/delaunay.h"
#include "geometry/region.h"
#include "grid/gmsh.h"
#include "grid/powell_sabin_split.h"
#include "particle/initial_state.h"
#include "particle/sampling.h"

namespace wisp {

namespace {

struct Layout {
  std::vector<Vec<2>> position, velocity;
  std::vector<double> volume;
};

/// Uniform in [0, 1), the same on every machine, which the standard's distributions are not.
class Uniform {
 public:
  explicit Uniform(int seed) : random_(static_cast<unsigned>(seed)) {}
  double operator()() { return static_cast<double>(random_()) / 4294967296.0; }

 private:
  std::mt19937 random_;
};

/// Puts points into one triangle, those that `keep` accepts.
template <class Keep>
void fill_triangle(const Triangulation& mesh, int t, const Sampling& sampling, Uniform& random, Keep&& keep,
                   Layout& out) {
  const int n = sampling.points_per_cell;
  std::vector<Vec<2>> points;
  if (sampling.method == SamplingMethod::random) {
    for (int k = 0; k < n * n; ++k) {
      double a = random(), b = random();
      if (a + b > 1.0) a = 1.0 - a, b = 1.0 - b;  // the other half of the parallelogram
      points.push_back(mesh.point(t, {1.0 - a - b, a, b}));
    }
  } else {
    points = even_points(mesh, t, n);
  }
  for (const auto& x : points)
    if (keep(x)) out.position.push_back(x), out.volume.push_back(mesh.area(t) / (n * n));
}

void fill_divisions(const BodyOptions& options, const Region<2>& shape, Layout& out) {
  const auto& divisions = options.sampling.divisions;
  if (divisions.size() != 2)
    input_error("body '{}': sampling by divisions needs `divisions` with 2 values", options.label);
  const auto box = bounds(shape);
  const Vec<2> step = (box.upper - box.lower).cwiseQuotient(Vec<2>(divisions[0], divisions[1]));
  for (int j = 0; j < divisions[1]; ++j)
    for (int i = 0; i < divisions[0]; ++i) {
      const Vec<2> x = box.lower + step.cwiseProduct(Vec<2>(i + 0.5, j + 0.5));
      if (contains(shape, x)) out.position.push_back(x), out.volume.push_back(step.prod());
    }
}

/// A shape as a polygon; a disc by one of 720 corners and the same area.
Outline polygon_of(const Region<2>& shape) {
  if (const auto* outline = std::get_if<Outline>(&shape)) return *outline;
  if (const auto* box = std::get_if<Block<2>>(&shape))
    return Outline(
        {{box->lower, {box->upper.x(), box->lower.y()}, box->upper, {box->lower.x(), box->upper.y()}}});
  const auto& disc = std::get<Sphere<2>>(shape);
  constexpr int corners = 720;
  constexpr double angle = 2.0 * std::numbers::pi / corners;
  const double radius = disc.radius * std::sqrt(angle / std::sin(angle));
  Ring ring;
  for (int i = 0; i < corners; ++i)
    ring.push_back(disc.centre + radius * Vec<2>(std::cos(i * angle), std::sin(i * angle)));
  return Outline({ring});
}

/// The edge of some triangles of a mesh as a polygon, with holes. Errors (InputError): they are not in one
/// piece, or touch at a vertex alone.
Outline outline_of(const Triangulation& mesh, const std::vector<int>& triangles, const std::string& label) {
  std::map<int, int> next;  // vertices along the edges that one triangle alone has, the inside on the left
  std::vector<char> chosen(static_cast<std::size_t>(mesh.n_triangles()), 0);
  for (const int t : triangles) chosen[static_cast<std::size_t>(t)] = 1;
  for (const int t : triangles)
    for (int k = 0; k < 3; ++k) {
      const int u = mesh.neighbour(t, k);
      if (u >= 0 && chosen[static_cast<std::size_t>(u)]) continue;
      const auto& corners = mesh.triangle(t);
      const int from = corners[static_cast<std::size_t>(k)],
                to = corners[static_cast<std::size_t>((k + 1) % 3)];
      if (!next.emplace(from, to).second)
        input_error("body '{}': its triangles touch at ({}, {}) alone; volumes must be share", label,
                    mesh.vertex(from).x(), mesh.vertex(from).y());
    }
  std::vector<Ring> rings;
  std::size_t outer = 0;
  double greatest = 0.0;
  while (!next.empty()) {
    Ring ring;
    double area = 0.0;
    for (auto at = next.begin(); at != next.end();) {
      const Vec<2>&a = mesh.vertex(at->first), &b = mesh.vertex(at->second);
      ring.push_back(a), area += 0.5 * (a.x() * b.y() - a.y() * b.x());
      const int to = at->second;
      next.erase(at);
      at = next.find(to);
    }
    if (area > 0.0 && greatest > 0.0)
      input_error("body '{}': its triangles are in more than one piece; volumes must be share", label);
    if (area > 0.0) greatest = area, outer = rings.size();
    rings.push_back(std::move(ring));
  }
  std::swap(rings[0], rings[outer]);
  return Outline(std::move(rings), "body '" + label + "'");
}

Layout fill_mesh(const BodyOptions& options, const MeshShape& shape, const std::filesystem::path& folder) {
  const Triangulation mesh = read_gmsh(folder / shape.file, shape.scale);
  if (options.sampling.method == SamplingMethod::divisions ||
      options.sampling.method == SamplingMethod::gauss || options.sampling.clip ||
      !options.sampling.cuts.empty())
    input_error("body '{}': a mesh is sampled triangle by triangle: method cells or random, without clip",
                options.label);
  Layout out;
  Uniform random(options.sampling.seed);
  const auto all = [](const Vec<2>&) { return true; };
  std::vector<int> triangles(static_cast<std::size_t>(mesh.n_triangles()));
  std::iota(triangles.begin(), triangles.end(), 0);
  if (!shape.surface.empty()) triangles = mesh.part(shape.surface).triangles;
  for (const int t : triangles) fill_triangle(mesh, t, options.sampling, random, all, out);
  if (options.sampling.volumes == PointVolumes::voronoi && !triangles.empty())
    out.volume = voronoi_areas(out.position, outline_of(mesh, triangles, options.label));
  return out;
}

/// Calls f(corners) for the n² equal triangles that a triangle divides into.
template <class F>
void for_each_part(const std::array<Vec<2>, 3>& corners, int n, F&& f) {
  const auto at = [&](int i, int j) -> Vec<2> {
    return corners[0] + static_cast<double>(i) / n * (corners[1] - corners[0]) +
           static_cast<double>(j) / n * (corners[2] - corners[0]);
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n - j; ++i) {
      f(std::array<Vec<2>, 3>{at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + j < n - 1) f(std::array<Vec<2>, 3>{at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
}

bool inside(const std::array<Vec<2>, 3>& corners, const Vec<2>& x) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec<2> side = corners[(k + 1) % 3] - corners[k], d = x - corners[k];
    if (side[0] * d[1] - side[1] * d[0] <= 0.0) return false;
  }
  return true;
}

/// Equal parts of the triangles, or of the six that a Powell-Sabin split makes of each, on which the
/// functions are polynomials: three Gauss points a part. `clip`: cut at the shape; what has no thickness, or
/// is so hollow that a Gauss point lies outside of the part, gets one point in its centroid.
void fill_parts(const BodyOptions& options, const Triangulation& grid, const Region<2>& shape,
                const std::vector<HalfSpace<2>>& cuts, Layout& out) {
  const Sampling& sampling = options.sampling;
  const bool gauss = sampling.method == SamplingMethod::gauss, clip = sampling.clip || !cuts.empty();
  const auto box = bounds(shape);
  const auto fill = [&](const std::array<Vec<2>, 3>& corners) {
    const ClippedTriangle whole = whole_triangle(corners);
    const ClippedTriangle part = clip ? clip_triangle(shape, cuts, corners) : whole;
    if (!(part.area > 1e-14 * whole.area)) return;
    std::vector<Vec<2>> points = gauss ? gauss_points(part) : std::vector<Vec<2>>{};
    if (!std::all_of(points.begin(), points.end(), [&](const Vec<2>& x) { return inside(corners, x); }))
      points.clear();
    if (points.empty()) points = {part.centroid};
    for (const auto& x : points)
      if (clip || contains(shape, x))
        out.position.push_back(x), out.volume.push_back(part.area / static_cast<double>(points.size()));
  };
  const std::optional<PowellSabinSplit> split =
      gauss ? std::make_optional<PowellSabinSplit>(grid) : std::nullopt;
  for (int t = 0; t < grid.n_triangles(); ++t) {
    const std::array<Vec<2>, 3> v{grid.corner(t, 0), grid.corner(t, 1), grid.corner(t, 2)};
    const Vec<2> low = v[0].cwiseMin(v[1]).cwiseMin(v[2]), high = v[0].cwiseMax(v[1]).cwiseMax(v[2]);
    if ((low.array() > box.upper.array()).any() || (high.array() < box.lower.array()).any()) continue;
    if (!split) {
      for_each_part(v, sampling.points_per_cell, fill);
      continue;
    }
    const Vec<2> z = split->centre(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec<2> r = split->edge_point(grid.edge(t, static_cast<int>(k)));
      for_each_part({v[k], r, z}, sampling.points_per_cell, fill);
      for_each_part({r, v[(k + 1) % 3], z}, sampling.points_per_cell, fill);
    }
  }
}

Layout lay_out(const BodyOptions& options, const Triangulation& grid, const std::filesystem::path& folder) {
  const SamplingMethod method = options.sampling.method;
  const bool clip = options.sampling.clip || !options.sampling.cuts.empty();
  if (clip && method != SamplingMethod::cells && method != SamplingMethod::gauss)
    input_error("body '{}': clip and cuts on triangles need method cells or gauss", options.label);
  if (clip && options.sampling.volumes == PointVolumes::voronoi)
    input_error("body '{}': cut points have the volumes that the cut leaves; volumes must be share",
                options.label);
  Layout out;
  if (const auto* file = std::get_if<PointFile>(&options.shape)) {
    PointTable<2> table = read_points<2>(*file, folder);
    out.position = std::move(table.positions), out.volume = std::move(table.volumes);
    out.velocity = std::move(table.velocities);
    return out;
  }
  if (const auto* mesh = std::get_if<MeshShape>(&options.shape)) return fill_mesh(options, *mesh, folder);
  const Region<2> shape = region<2>(options.shape, folder);
  if (clip || method == SamplingMethod::gauss) {
    fill_parts(options, grid, shape, cuts_of<2>(options), out);
  } else if (method == SamplingMethod::divisions) {
    fill_divisions(options, shape, out);
  } else {
    Uniform random(options.sampling.seed);
    const auto inside = [&](const Vec<2>& x) { return contains(shape, x); };
    for (int t = 0; t < grid.n_triangles(); ++t)
      fill_triangle(grid, t, options.sampling, random, inside, out);
  }
  if (options.sampling.volumes == PointVolumes::voronoi && !out.position.empty())
    out.volume = voronoi_areas(out.position, polygon_of(shape));
  return out;
}

}  // namespace

std::vector<Vec<2>> even_points(const Triangulation& triangulation, int t, int n) {
  std::vector<Vec<2>> points;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n - j; ++i) {
      const auto add = [&](double a, double b) {
        points.push_back(triangulation.point(t, {1.0 - (a + b) / n, a / n, b / n}));
      };
      add(i + 1.0 / 3.0, j + 1.0 / 3.0);
      if (i + j < n - 1) add(i + 2.0 / 3.0, j + 2.0 / 3.0);
    }
  return points;
}

Body<2> sample(const BodyOptions& options, const Triangulation& grid, std::int64_t first_id,
               const std::filesystem::path& folder) {
  const Layout layout = lay_out(options, grid, folder);
  if (layout.position.empty())
    input_error(
        "body '{}': no point lies in its shape; check the shape, or use more points per cell or divisions",
        options.label);
  InitialState<2> state(options);
  int hint = -1;
  for (std::size_t p = 0; p < layout.position.size(); ++p) {
    const Vec<2>& x = layout.position[p];
    hint = grid.locate(x, hint);
    if (hint < 0)
      input_error("body '{}': a point at ({}, {}) lies outside the grid", options.label, x.x(), x.y());
    state.add(first_id + static_cast<std::int64_t>(p), x, layout.volume[p],
              layout.velocity.empty() ? Vec<2>::Zero().eval() : layout.velocity[p]);
  }
  return state.take();
}

}  // namespace wisp
