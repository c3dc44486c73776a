#include "basis/powell_sabin_cubic.h"

#include <algorithm>

namespace wisp {

namespace {
/// Positions in a corner's functions: three of the vertex, then its own and its edges', by side.
constexpr std::size_t own = 3, across = 5;
using enum CubicTerms::Ordinate;

constexpr std::size_t at(int kind, int side) {
  return static_cast<std::size_t>(CubicTerms::ordinate(kind, side));
}
int edge_at(int k, int side) { return side == 0 ? k : (k + 2) % 3; }
}  // namespace

PowellSabinCubic::PowellSabinCubic(const Triangulation& triangulation, const ControlTriangleOptions& options)
    : PowellSabinSpline(triangulation, options) {
  int n_boundary = 0;
  for (int e = 0; e < triangulation.n_edges(); ++e)
    boundary_number_.push_back(triangulation.edge(e).boundary() ? n_boundary++ : -1);
  n_functions_ = 3 * triangulation.n_vertices() + 6 * triangulation.n_triangles() + 2 * n_boundary;
  find_corners();
  place_controls();
  for (int t = 0; t < triangulation.n_triangles(); ++t)
    for (int k = 0; k < 3; ++k) fill(t, k);
  // Across an edge the neighbour's ordinates are needed, so they come last.
  for (int t = 0; t < triangulation.n_triangles(); ++t)
    for (int k = 0; k < 3; ++k)
      for (int side = 0; side < 2; ++side) fill_edge(t, k, side);
}

void PowellSabinCubic::find_corners() {
  for (int t = 0; t < triangulation().n_triangles(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Vec<2>& v = triangulation().corner(t, k);
      Mat<2> arms;
      arms.col(0) = split_.edge_point(triangulation().edge(t, edge_at(k, 0))) - v;
      arms.col(1) = split_.edge_point(triangulation().edge(t, edge_at(k, 1))) - v;
      const Vec<2> c = arms.inverse() * (split_.centre(t) - v);
      corners_.push_back({c[0], c[1], std::max(1.0, c[0] + c[1])});
    }
}

void PowellSabinCubic::place_controls() {
  control_points_.resize(static_cast<std::size_t>(n_functions_));
  for (int t = 0; t < triangulation().n_triangles(); ++t)
    for (int k = 0; k < 3; ++k)
      for (int side = 0; side < 2; ++side) {
        const Vec<2>& v = triangulation().corner(t, k);
        const Vec<2> r = split_.edge_point(triangulation().edge(t, edge_at(k, side)));
        control_points_[static_cast<std::size_t>(corner_function(t, k, side))] =
            (2.0 * v + split_.centre(t) + corner(t, k).s * (r - v)) / 3.0;
      }
  for (int e = 0; e < triangulation().n_edges(); ++e)
    if (triangulation().edge(e).boundary())
      for (int end = 0; end < 2; ++end)
        control_points_[static_cast<std::size_t>(edge_function(e, end))] =
            (triangulation().vertex(triangulation().edge(e).vertex[static_cast<std::size_t>(end)]) +
             2.0 * split_.edge_point(e)) /
            3.0;
}

/// Ordinates of corner k that its own functions give.
void PowellSabinCubic::fill(int t, int k) {
  const auto i = static_cast<std::size_t>(k);
  Table& table = tables_[static_cast<std::size_t>(t)];
  auto& rows = table.ordinate[i];
  const int vertex = triangulation().triangle(t)[i];
  const Vec<2>& v = triangulation().vertex(vertex);
  const Corner& c = corner(t, k);
  set_linear(vertex, Vec<2>::Zero(), rows[vvv]);
  set_linear(vertex, (split_.centre(t) - v) / 3.0, rows[vvz]);
  for (std::size_t q = 0; q < 3; ++q) {
    table.function[7 * i + q] = 3 * vertex + static_cast<int>(q);
    rows[vzz][q] = clean((1.0 - (c.a + c.b) / c.s) * rows[vvz][q]);
  }
  rows[vzz][own] = c.a / c.s, rows[vzz][own + 1] = c.b / c.s;
  for (int side = 0; side < 2; ++side) {
    const auto s = static_cast<std::size_t>(side);
    table.function[7 * i + own + s] = corner_function(t, k, side);
    set_linear(vertex, (split_.edge_point(triangulation().edge(t, edge_at(k, side))) - v) / 3.0,
               rows[at(vvr, side)]);
    for (std::size_t q = 0; q < 3; ++q) rows[at(vrz, side)][q] = clean((1.0 - 1.0 / c.s) * rows[vvz][q]);
    rows[at(vrz, side)][own + s] = 1.0 / c.s;
  }
}

/// V RR: on an inner edge an average of V RZ of both triangles, else a function of its own.
void PowellSabinCubic::fill_edge(int t, int k, int side) {
  const auto i = static_cast<std::size_t>(k), s = static_cast<std::size_t>(side);
  Table& table = tables_[static_cast<std::size_t>(t)];
  auto& rows = table.ordinate[i];
  auto& row = rows[at(vrr, side)];
  int& function = table.function[7 * i + across + s];
  const int e = triangulation().edge(t, edge_at(k, side));
  const auto& edge = triangulation().edge(e);
  const int vertex = triangulation().triangle(t)[i];
  if (edge.boundary()) {
    function = edge_function(e, edge.vertex[0] == vertex ? 0 : 1);
    row[across + s] = 1.0;
    return;
  }
  const int u = edge.triangle[0] == t ? edge.triangle[1] : edge.triangle[0];
  const double lambda = edge.triangle[0] == t ? split_.centre_share(e) : 1.0 - split_.centre_share(e);
  const auto& around = triangulation().triangle(u);
  const auto j = static_cast<std::size_t>(std::find(around.begin(), around.end(), vertex) - around.begin());
  const int k_there = static_cast<int>(j), side_there = triangulation().edge(u, k_there) == e ? 0 : 1;
  const auto& there = tables_[static_cast<std::size_t>(u)].ordinate[j][at(vrz, side_there)];
  for (std::size_t f = 0; f < across; ++f) row[f] = lambda * rows[at(vrz, side)][f];
  for (std::size_t q = 0; q < 3; ++q) row[q] += (1.0 - lambda) * there[q];
  row[across + s] = (1.0 - lambda) * there[own + static_cast<std::size_t>(side_there)];
  function = corner_function(u, k_there, side_there);
}

}  // namespace wisp
