// Jumps of normal derivatives across edges of triangles and of the pieces that splines split them into: what
// a ghost penalty needs from a basis of a triangulation.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "basis/lagrange_quadratic.h"
#include "basis/linear_triangle.h"
#include "basis/powell_sabin_cubic.h"
#include "basis/powell_sabin_quadratic.h"

namespace wisp {

/// J_G of one segment: sum_q weight[q] (jump_q u) (jump_q w) with jump_q u = sum_k jump[q n + k]
/// u_{function[k]}, n functions. The weights hold the segment's length and the powers of its `extent` h that
/// make sum rho J_G a mass: (h³/3), (h⁵/20), (h⁷/252) for jumps of the first, second and third normal
/// derivative.
struct JumpRows {
  std::vector<int> function;
  std::vector<double> weight;
  std::vector<double> jump;
  double extent = 0.0;  ///< h, m
};

namespace jumps {

constexpr double gauss[2] = {0.21132486540518711775, 0.78867513459481288225};
/// Weight of order k over h^(2k+1): the square of x^k/k!-ish growth over the neighbour, integrated.
constexpr double factor(int order) { return order == 1 ? 1.0 / 3.0 : order == 2 ? 1.0 / 20.0 : 1.0 / 252.0; }

/// Adds one row: derivatives of the functions on side 0 minus those on side 1.
template <std::size_t n>
void add_row(JumpRows& rows, const std::array<int, n>& functions0, const std::array<double, n>& values0,
             const std::array<int, n>& functions1, const std::array<double, n>& values1, double weight) {
  const std::size_t size = rows.function.size();
  const std::size_t start = rows.jump.size();
  rows.jump.resize(start + size, 0.0);
  const auto add = [&](int i, double v) {
    const auto at = std::lower_bound(rows.function.begin(), rows.function.end(), i) - rows.function.begin();
    rows.jump[start + static_cast<std::size_t>(at)] += v;
  };
  for (std::size_t k = 0; k < n; ++k) add(functions0[k], values0[k]), add(functions1[k], -values1[k]);
  rows.weight.push_back(weight);
}

template <std::size_t n>
JumpRows start_rows(const std::array<int, n>& functions0, const std::array<int, n>& functions1,
                    double extent) {
  JumpRows rows;
  rows.function.assign(functions0.begin(), functions0.end());
  rows.function.insert(rows.function.end(), functions1.begin(), functions1.end());
  std::sort(rows.function.begin(), rows.function.end());
  rows.function.erase(std::unique(rows.function.begin(), rows.function.end()), rows.function.end());
  rows.extent = extent;
  return rows;
}

/// The corner of triangle t at which its edge e starts.
inline int local_edge(const Triangulation& mesh, int t, int e) {
  for (int k = 0; k < 3; ++k)
    if (mesh.edge(t, k) == e) return k;
  return 0;
}

/// Unit normal of an edge.
inline Vec<2> normal(const Triangulation& mesh, int e) {
  const auto& v = mesh.edge(e).vertex;
  const Vec<2> t = (mesh.vertex(v[1]) - mesh.vertex(v[0])).normalized();
  return {t.y(), -t.x()};
}

/// Mean of the two triangles' heights over an edge.
inline double mean_height(const Triangulation& mesh, int e) {
  const auto& edge = mesh.edge(e);
  double sum = 0.0;
  for (const int t : edge.triangle) sum += mesh.height(t, local_edge(mesh, t, e));
  return 0.5 * sum;
}

}  // namespace jumps

/// Linear functions: the normal derivative jumps by a constant.
inline std::vector<JumpRows> edge_jumps(const LinearTriangle& basis, int e) {
  const Triangulation& mesh = basis.triangulation();
  const auto& [t, u] = mesh.edge(e).triangle;
  const double h = jumps::mean_height(mesh, e);
  const Vec<2> n = jumps::normal(mesh, e);
  JumpRows rows = jumps::start_rows(basis.functions(t), basis.functions(u), h);
  std::array<std::array<double, 3>, 2> slope{};
  for (std::size_t side = 0; side < 2; ++side) {
    const auto gradient = mesh.barycentric_gradients(mesh.edge(e).triangle[side]);
    for (std::size_t k = 0; k < 3; ++k) slope[side][k] = gradient[k].dot(n);
  }
  jumps::add_row(rows, basis.functions(t), slope[0], basis.functions(u), slope[1],
                 mesh.edge_length(e) * jumps::factor(1) * h * h * h);
  return {rows};
}

/// Quadratic Lagrange functions: the first derivative jumps linearly, the second by a constant.
inline std::vector<JumpRows> edge_jumps(const LagrangeQuadratic& basis, int e) {
  const Triangulation& mesh = basis.triangulation();
  const auto& [t, u] = mesh.edge(e).triangle;
  const auto& ends = mesh.edge(e).vertex;
  const double h = jumps::mean_height(mesh, e), length = mesh.edge_length(e);
  const Vec<2> n = jumps::normal(mesh, e);
  JumpRows rows = jumps::start_rows(basis.functions(t), basis.functions(u), h);
  using Values = std::array<double, 6>;
  for (const double s : jumps::gauss) {
    const Vec<2> x = (1.0 - s) * mesh.vertex(ends[0]) + s * mesh.vertex(ends[1]);
    std::array<Values, 2> slope{};
    for (std::size_t side = 0; side < 2; ++side)
      basis.tabulate_in(mesh.edge(e).triangle[side], x).for_each([&](int k, int, double, const Vec<2>& dphi) {
        slope[side][static_cast<std::size_t>(k)] = dphi.dot(n);
      });
    jumps::add_row(rows, basis.functions(t), slope[0], basis.functions(u), slope[1],
                   0.5 * length * jumps::factor(1) * h * h * h);
  }
  std::array<Values, 2> bend{};
  for (std::size_t side = 0; side < 2; ++side) {
    const auto g = mesh.barycentric_gradients(mesh.edge(e).triangle[side]);
    for (std::size_t k = 0; k < 3; ++k) {
      const double a = g[k].dot(n), b = g[(k + 1) % 3].dot(n);
      bend[side][k] = 4.0 * a * a, bend[side][3 + k] = 8.0 * a * b;
    }
  }
  jumps::add_row(rows, basis.functions(t), bend[0], basis.functions(u), bend[1],
                 length * jumps::factor(2) * std::pow(h, 5));
  return {rows};
}

namespace jumps {

/// One segment between two sub-triangles of the split, as each of them sees it: side by side the place of a
/// parameter s in [0, 1].
struct SplitSegment {
  std::array<int, 2> triangle;
  std::array<std::array<int, 2>, 2> sub;  ///< edge, side
  std::array<std::size_t, 2> ends;        ///< coordinates (near, R, Z) that are 1 at s = 0 and s = 1
};

template <class Terms, int order>
void add_order(const PowellSabinSpline<Terms>& basis, const SplitSegment& segment, const Vec<2>& normal,
               double length, double factor, JumpRows& rows) {
  // Derivatives of this order are polynomials of degree `degree - order` along the segment: one point or two.
  constexpr bool constant = Terms::degree == order;
  for (int q = 0; q < (constant ? 1 : 2); ++q) {
    const double s = constant ? 0.5 : gauss[q];
    typename PowellSabinSpline<Terms>::Values value[2];
    for (std::size_t side = 0; side < 2; ++side) {
      SplitPoint p;
      p.edge = segment.sub[side][0], p.side = segment.sub[side][1];
      p.share[segment.ends[0]] = 1.0 - s, p.share[segment.ends[1]] = s;
      value[side] = basis.template derivatives<order>(segment.triangle[side], p, normal);
    }
    add_row(rows, basis.functions(segment.triangle[0]), value[0], basis.functions(segment.triangle[1]),
            value[1], (constant ? 1.0 : 0.5) * length * factor);
  }
}

template <class Terms>
JumpRows segment_jumps(const PowellSabinSpline<Terms>& basis, const SplitSegment& segment, const Vec<2>& from,
                       const Vec<2>& to, double extent, double share) {
  JumpRows rows =
      start_rows(basis.functions(segment.triangle[0]), basis.functions(segment.triangle[1]), extent);
  const Vec<2> along = to - from, normal = Vec<2>(along.y(), -along.x()).normalized();
  const double h5 = std::pow(extent, 5);
  add_order<Terms, 2>(basis, segment, normal, along.norm(), share * factor(2) * h5, rows);
  if constexpr (Terms::degree == 3)
    add_order<Terms, 3>(basis, segment, normal, along.norm(), share * factor(3) * h5 * extent * extent, rows);
  return rows;
}

}  // namespace jumps

/// Splines have no jump of the first derivative. Quadratic ones are weighted with the edge's length h. Of
/// cubic ones the second and third derivative count, with the larger height of the two sub-triangles.
template <class Terms>
std::vector<JumpRows> edge_jumps(const PowellSabinSpline<Terms>& basis, int e) {
  const Triangulation& mesh = basis.triangulation();
  const auto& [t, u] = mesh.edge(e).triangle;
  const int k = jumps::local_edge(mesh, t, e), m = jumps::local_edge(mesh, u, e);
  const Vec<2> split = basis.split().edge_point(e);
  double extent = mesh.edge_length(e);
  if constexpr (Terms::degree == 3) {
    const Vec<2> n = jumps::normal(mesh, e);
    extent = std::max(std::abs((basis.split().centre(t) - split).dot(n)),
                      std::abs((basis.split().centre(u) - split).dot(n)));
  }
  // The edge runs the other way round in the second triangle, so that its sides change places.
  return {jumps::segment_jumps(basis, {{t, u}, {{{k, 0}, {m, 1}}}, {0, 1}}, mesh.corner(t, k), split, extent,
                               1.0),
          jumps::segment_jumps(basis, {{t, u}, {{{k, 1}, {m, 0}}}, {0, 1}}, mesh.corner(t, (k + 1) % 3),
                               split, extent, 1.0)};
}

inline std::vector<JumpRows> inner_jumps(const LinearTriangle&, int) { return {}; }
inline std::vector<JumpRows> inner_jumps(const LagrangeQuadratic&, int) { return {}; }

/// The six segments of the split inside a triangle: corner to Z, and R to Z. Quadratic: h = sqrt(2 area of
/// the triangle); cubic: the larger height, R-Z with a hundredth of the weight.
template <class Terms>
std::vector<JumpRows> inner_jumps(const PowellSabinSpline<Terms>& basis, int t) {
  constexpr bool cubic = Terms::degree == 3;
  const Triangulation& mesh = basis.triangulation();
  const Vec<2> centre = basis.split().centre(t);
  const auto distance = [&](const Vec<2>& x, const Vec<2>& from) {
    const Vec<2> along = (centre - from).normalized();
    return std::abs((x - from).x() * along.y() - (x - from).y() * along.x());
  };
  std::vector<JumpRows> list;
  const double side = std::sqrt(2.0 * mesh.area(t));
  for (int k = 0; k < 3; ++k) {
    const int before = (k + 2) % 3;
    const Vec<2>&v = mesh.corner(t, k), &next = mesh.corner(t, (k + 1) % 3);
    const Vec<2> split = basis.split().edge_point(mesh.edge(t, k)),
                 other = basis.split().edge_point(mesh.edge(t, before));
    list.push_back(jumps::segment_jumps(basis, {{t, t}, {{{k, 0}, {before, 1}}}, {0, 2}}, v, centre,
                                        cubic ? std::max(distance(split, v), distance(other, v)) : side,
                                        1.0));
    list.push_back(jumps::segment_jumps(basis, {{t, t}, {{{k, 0}, {k, 1}}}, {1, 2}}, split, centre,
                                        cubic ? std::max(distance(v, split), distance(next, split)) : side,
                                        cubic ? 0.01 : 1.0));
  }
  return list;
}

}  // namespace wisp
