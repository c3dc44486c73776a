#include "boundary/wall_cut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace wisp {

namespace {

constexpr double nudge = 1e-6;       // of the shortest side
constexpr double negligible = 1e-9;  // of the shortest side: cuts closer together are one

template <int dim>
MultiIndex<dim> host_cell(const StructuredGrid<dim>& grid, const Vec<dim>& middle, const Vec<dim>& normal) {
  const Vec<dim> x = middle + nudge * grid.shortest_side() * normal;
  MultiIndex<dim> cell;
  for (int d = 0; d < dim; ++d) cell[d] = grid.locate_inside(d, x[d]);
  return cell;
}

void add_segment(const StructuredGrid<2>& grid, const Vec<2>& a, const Vec<2>& b, const Vec<2>& normal,
                 WallCut<2>& cut) {
  add_part(a, b, normal, host_cell<2>(grid, 0.5 * (a + b), normal), 3, cut);
}

void cut_segment(const StructuredGrid<2>& grid, const WallPiece<2>& piece, WallCut<2>& cut) {
  const Vec<2> a = piece.vertex[0], side = piece.vertex[1] - a;
  const double shortest = negligible * grid.shortest_side() / side.norm();
  std::vector<double> at{0.0};
  for (int d = 0; d < 2; ++d) {
    const double low = std::min(a[d], a[d] + side[d]), high = std::max(a[d], a[d] + side[d]);
    for (int i = grid.locate(d, low); i <= grid.locate(d, high); ++i) {
      const double t = (grid.line(d, i) - a[d]) / side[d];
      if (t > shortest && t < 1.0 - shortest) at.push_back(t);  // never where side[d] is zero
    }
  }
  std::sort(at.begin(), at.end());
  double last = 0.0;
  for (std::size_t k = 1; k < at.size(); ++k) {
    if (at[k] - last < shortest) continue;
    add_segment(grid, a + last * side, a + at[k] * side, piece.normal, cut);
    last = at[k];
  }
  add_segment(grid, a + last * side, piece.vertex[1], piece.normal, cut);
}

using Corners = std::vector<Vec<3>>;

/// What of a convex polygon lies between two planes normal to a direction (Sutherland and Hodgman 1974).
Corners between(const Corners& corners, int d, double low, double high) {
  Corners in = corners, out;
  for (const double sign : {1.0, -1.0}) {
    const double plane = sign > 0 ? low : high;
    out.clear();
    for (std::size_t k = 0; k < in.size(); ++k) {
      const Vec<3>&a = in[k], &b = in[(k + 1) % in.size()];
      const double fa = sign * (a[d] - plane), fb = sign * (b[d] - plane);
      if (fa >= 0.0) out.push_back(a);
      if ((fa > 0.0 && fb < 0.0) || (fa < 0.0 && fb > 0.0)) {
        Vec<3> x = a + fa / (fa - fb) * (b - a);
        x[d] = plane;
        out.push_back(x);
      }
    }
    in.swap(out);
  }
  return in;
}

void add_polygon(const StructuredGrid<3>& grid, const Corners& corners, const Vec<3>& normal,
                 WallCut<3>& cut) {
  constexpr double a[2] = {0.44594849091596488632, 0.09157621350977074346};
  constexpr double w[2] = {0.22338158967801146570, 0.10995174365532186764};
  const double shortest = negligible * grid.shortest_side();
  double area = 0.0;
  Vec<3> middle = Vec<3>::Zero();
  const std::size_t first = cut.position.size();
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    const double part = 0.5 * (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]).norm();
    area += part;
    middle += part / 3.0 * (corners[0] + corners[k] + corners[k + 1]);
    if (part < shortest * shortest) continue;
    for (int rule = 0; rule < 2; ++rule)
      for (int q = 0; q < 3; ++q) {
        double share[3] = {a[rule], a[rule], a[rule]};
        share[q] = 1.0 - 2.0 * a[rule];
        cut.position.emplace_back(share[0] * corners[0] + share[1] * corners[k] + share[2] * corners[k + 1]);
        cut.weight.push_back(w[rule] * part);
      }
  }
  if (cut.position.size() == first) return;  // touched in a line or a point
  middle /= area;
  cut.parts.push_back(
      {middle, normal, host_cell<3>(grid, middle, normal), first, cut.position.size() - first});
}

void cut_corners(const StructuredGrid<3>& grid, const Corners& corners, int d, const Vec<3>& normal,
                 WallCut<3>& cut) {
  if (d == 3) return add_polygon(grid, corners, normal, cut);
  double low = corners[0][d], high = low;
  for (const auto& x : corners) low = std::min(low, x[d]), high = std::max(high, x[d]);
  // In a grid plane up to rounding: there is nothing to cut.
  if (high - low < negligible * grid.shortest_side()) return cut_corners(grid, corners, d + 1, normal, cut);
  for (int i = grid.locate(d, low); i <= grid.locate(d, high); ++i) {
    const bool first = i == -StructuredGrid<3>::padding;
    const bool last = i == grid.cells(d) + StructuredGrid<3>::padding - 1;
    const Corners part =
        between(corners, d, first ? low : grid.line(d, i), last ? high : grid.line(d, i + 1));
    if (part.size() >= 3) cut_corners(grid, part, d + 1, normal, cut);
  }
}

}  // namespace

void add_part(const Vec<2>& a, const Vec<2>& b, const Vec<2>& normal, const MultiIndex<2>& host, int points,
              WallCut<2>& cut) {
  constexpr double r[2][4] = {
      {-0.77459666924148337704, 0.0, 0.77459666924148337704, 0.0},
      {-0.86113631159405257522, -0.33998104358485626480, 0.33998104358485626480, 0.86113631159405257522}};
  constexpr double w[2][4] = {
      {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0, 0.0},
      {0.17392742256872692869, 0.32607257743127307131, 0.32607257743127307131, 0.17392742256872692869}};
  const Vec<2> middle = 0.5 * (a + b), half = 0.5 * (b - a);
  cut.parts.push_back({middle, normal, host, cut.position.size(), static_cast<std::size_t>(points)});
  for (int q = 0; q < points; ++q) {
    cut.position.emplace_back(middle + r[points - 3][q] * half);
    cut.weight.push_back(2.0 * half.norm() * w[points - 3][q]);
  }
}

template <>
void cut_piece<2>(const StructuredGrid<2>& grid, const WallPiece<2>& piece, WallCut<2>& cut) {
  cut_segment(grid, piece, cut);
}

template <>
void cut_piece<3>(const StructuredGrid<3>& grid, const WallPiece<3>& piece, WallCut<3>& cut) {
  cut_corners(grid, {piece.vertex.begin(), piece.vertex.end()}, 0, piece.normal, cut);
}

}  // namespace wisp
