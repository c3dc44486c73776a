#include "grid/powell_sabin_split.h"

#include <algorithm>

#include <cmath>

#include "core/error.h"

namespace wisp {

PowellSabinSplit::PowellSabinSplit(const Triangulation& triangulation) : triangulation_(&triangulation) {
  centres_.reserve(static_cast<std::size_t>(triangulation.n_triangles()));
  for (int t = 0; t < triangulation.n_triangles(); ++t) {
    // The incentre weighs each corner with the length of the opposite side.
    std::array<double, 3> a{};
    double perimeter = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double length = triangulation.edge_length(triangulation.edge(t, k));
      a[static_cast<std::size_t>(next(next(k)))] = length, perimeter += length;
    }
    for (double& share : a) share /= perimeter;
    centres_.push_back(a);
  }
  for (int e = 0; e < triangulation.n_edges(); ++e) {
    const auto& edge = triangulation.edge(e);
    if (edge.boundary()) {
      edge_shares_.push_back(0.5), centre_shares_.push_back(1.0);
      continue;
    }
    const Vec<2>& from = triangulation.vertex(edge.vertex[0]);
    const Vec<2> along = triangulation.vertex(edge.vertex[1]) - from;
    const Vec<2> z0 = centre(edge.triangle[0]) - from, z1 = centre(edge.triangle[1]) - from;
    const double d0 = std::abs(along[0] * z0[1] - along[1] * z0[0]);
    const double d1 = std::abs(along[0] * z1[1] - along[1] * z1[0]);
    const double lambda = d1 / (d0 + d1);
    const Vec<2> r = lambda * z0 + (1.0 - lambda) * z1;
    edge_shares_.push_back(1.0 - r.dot(along) / along.squaredNorm()), centre_shares_.push_back(lambda);
  }
}

namespace {

/// The boundary's edges at a vertex as lines with the domain on their left: the one that leaves, the one that
/// comes. False where the boundary passes the vertex more than once.
bool boundary_lines(const Triangulation& triangulation, int v, std::array<DirectedLine, 2>& lines) {
  int n_edges = 0;
  for (const int t : triangulation.triangles_of_vertex(v))
    for (int k = 0; k < 3; ++k) {
      if (triangulation.neighbour(t, k) >= 0) continue;
      const int from = triangulation.triangle(t)[static_cast<std::size_t>(k)];
      const int to = triangulation.triangle(t)[static_cast<std::size_t>(PowellSabinSplit::next(k))];
      if (from != v && to != v) continue;
      const Vec<2> along = triangulation.vertex(to) - triangulation.vertex(from);
      lines[from == v ? 0 : 1] = {triangulation.vertex(v), along.normalized()};
      ++n_edges;
    }
  return n_edges == 2;
}

/// At a corner V that turns inwards: sides from V along the two boundary edges, continued into the inside,
/// and a third beyond all points that lie between them.
ControlTriangle inward_triangle(const std::vector<Vec<2>>& points, const std::array<DirectedLine, 2>& lines) {
  const Vec<2>& v = lines[0].point;
  Mat<2> sides;
  sides.col(0) = lines[1].direction, sides.col(1) = -lines[0].direction;
  const Mat<2> shares = sides.inverse();
  double size = 0.0;
  for (const auto& p : points) size = std::max(size, (shares * (p - v)).sum());
  return {v, Vec<2>(v + size * sides.col(0)), Vec<2>(v + size * sides.col(1))};
}

}  // namespace

std::vector<ControlTriangle> control_triangles(const PowellSabinSplit& split, int degree,
                                               const ControlTriangleOptions& options) {
  constexpr double straight = 1e-9, blunt = 0.98480775301220806;  // cosine of a turn by 10 degrees
  const auto& triangulation = split.triangulation();
  std::vector<ControlTriangle> all;
  std::vector<Vec<2>> points;
  for (int v = 0; v < triangulation.n_vertices(); ++v) {
    const Vec<2>& x = triangulation.vertex(v);
    points.assign(1, x);
    for (const int t : triangulation.triangles_of_vertex(v)) {
      points.emplace_back(x + (split.centre(t) - x) / degree);
      for (int k = 0; k < 3; ++k) {
        const auto& edge = triangulation.edge(triangulation.edge(t, k));
        if (edge.vertex[0] == v || edge.vertex[1] == v)
          points.emplace_back(x + (split.edge_point(triangulation.edge(t, k)) - x) / degree);
      }
    }
    ControlTriangleSearch search;
    std::array<DirectedLine, 2> lines;
    if (options.on_boundary && triangulation.on_boundary(v) && boundary_lines(triangulation, v, lines)) {
      const Vec<2>&out = lines[0].direction, &in = lines[1].direction;
      const double turn = in[0] * out[1] - in[1] * out[0], along = in.dot(out);
      if (std::abs(turn) < straight && along > 0.0)
        search = find_control_triangle(points, options.rule, std::span(lines).first(1));
      else if (turn > 0.0 && along <= blunt)
        search = find_control_triangle(points, options.rule, lines);
      else if (turn < 0.0 && along <= blunt && options.rule == ControlTriangleRule::corner_sides)
        search = {true, inward_triangle(points, lines)};
    }
    if (!search.found) search = find_control_triangle(points, options.rule);
    if (!search.found)
      run_error("no control triangle at vertex {} ({}, {}): its triangles are too flat", v, x[0], x[1]);
    all.push_back(search.triangle);
  }
  return all;
}

}  // namespace wisp
