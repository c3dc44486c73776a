// Jumps of higher normal derivatives of Powell–Sabin splines: what a ghost penalty needs from them.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "basis/powell_sabin_cubic.h"
#include "basis/powell_sabin_quadratic.h"

namespace wisp {

/// The length in a penalty of jumps of order k, which stands there to the power 2 k + 1.
enum class JumpLength {
  element,  ///< the edge between triangles, sqrt(2 area) inside one; cubics: the larger of the two heights
  heights,  ///< of the sub-triangles on both sides, so that no size of a triangle enters
};
template <>
inline constexpr auto choices<JumpLength> = choice_list<JumpLength>({{"element", JumpLength::element},
                                                                     {"heights", JumpLength::heights}});

/// The functions on both sides of an edge, and rows with the jump of a normal derivative of each at a place
/// of it: the penalty of u is the sum over the rows of weight (sum_k jump[k] u_{function[k]})².
template <class Spline>
struct SplineJumps {
  static constexpr std::size_t most_functions = 2 * Spline::max_functions;
  static constexpr std::size_t most_rows = Spline::degree == 2 ? 2 : 6;
  struct Row {
    double weight = 0.0;                        ///< m^(2 k + 2) for jumps of the derivative of order k
    std::array<double, most_functions> jump{};  ///< 1/m^k
  };
  std::size_t n_functions = 0, n_rows = 0;
  std::array<int, most_functions> function{};
  std::array<Row, most_rows> row{};
};

namespace spline_jumps {

/// A side of a straight segment: a sub-triangle, and its coordinates at the segment's two ends.
struct Side {
  int triangle, edge, side;
  std::array<double, 3> from, to;
};

/// Distance of a sub-triangle's third corner from the segment, by the area of the sub-triangle.
template <class Spline>
double height(const Spline& basis, const Side& s, double length) {
  const auto& mesh = basis.triangulation();
  const Vec<2>& v = mesh.corner(s.triangle, (s.edge + s.side) % 3);
  const Vec<2> r = basis.split().edge_point(mesh.edge(s.triangle, s.edge)) - v;
  const Vec<2> z = basis.split().centre(s.triangle) - v;
  return std::abs(r[0] * z[1] - r[1] * z[0]) / length;
}

template <class Spline>
Vec<2> point(const Spline& basis, const Side& s, const std::array<double, 3>& share) {
  const auto& mesh = basis.triangulation();
  return share[0] * mesh.corner(s.triangle, (s.edge + s.side) % 3) +
         share[1] * basis.split().edge_point(mesh.edge(s.triangle, s.edge)) +
         share[2] * basis.split().centre(s.triangle);
}

/// Adds the rows of one segment to jumps whose functions begin with those of a's triangle; `second` tells
/// where b's are.
template <int order, class Spline>
void add_row(const Spline& basis, const Side& a, const Side& b, double place, const Vec<2>& normal,
             double weight, const std::array<std::size_t, Spline::max_functions>& second,
             SplineJumps<Spline>& jumps) {
  const auto at = [&](const Side& s) {
    SplitPoint p{s.edge, s.side, {}};
    for (std::size_t i = 0; i < 3; ++i) p.share[i] = (1.0 - place) * s.from[i] + place * s.to[i];
    return p;
  };
  const auto above = basis.template derivatives<order>(a.triangle, at(a), normal);
  const auto below = basis.template derivatives<order>(b.triangle, at(b), normal);
  auto& row = jumps.row[jumps.n_rows++];
  row.weight = weight;
  for (std::size_t i = 0; i < Spline::max_functions; ++i) {
    row.jump[i] += above[i];
    row.jump[second[i]] -= below[i];
  }
}

/// The jumps across one segment. Powell–Sabin splines are C1: second derivatives jump, of cubics also third.
template <class Spline>
void add_segment(const Spline& basis, const Side& a, const Side& b, double element_length, double share,
                 JumpLength length, const std::array<std::size_t, Spline::max_functions>& second,
                 SplineJumps<Spline>& jumps) {
  const Vec<2> along = point(basis, a, a.to) - point(basis, a, a.from);
  const double size = along.norm();
  const Vec<2> normal = Vec<2>(along[1], -along[0]) / size;
  const double above = height(basis, a, size), below = height(basis, b, size);
  // The square of a function with a jump of one in its second (third) derivative, integrated to a depth h:
  // int_0^h (x²/2)² dx = h^5/20, int_0^h (x³/6)² dx = h^7/252.
  const auto power = [&](int n, double per) {
    if (length == JumpLength::heights) return (std::pow(above, n) + std::pow(below, n)) / (6.0 * per);
    return std::pow(Spline::degree == 2 ? element_length : std::max(above, below), n) / per;
  };
  if constexpr (Spline::degree == 2) {
    add_row<2>(basis, a, b, 0.5, normal, share * size * power(5, 20.0), second, jumps);
  } else {
    // The second derivative's jump is linear along the segment: two Gauss points; the third's is constant.
    for (const double place : {0.5 - 0.28867513459481288225, 0.5 + 0.28867513459481288225})
      add_row<2>(basis, a, b, place, normal, share * 0.5 * size * power(5, 20.0), second, jumps);
    add_row<3>(basis, a, b, 0.5, normal, share * size * power(7, 252.0), second, jumps);
  }
}

}  // namespace spline_jumps

/// Jumps across the two halves of an inner edge of the triangulation.
template <class Spline>
SplineJumps<Spline> edge_jumps(const Spline& basis, int e, JumpLength length = JumpLength::element) {
  const auto& mesh = basis.triangulation();
  const auto& edge = mesh.edge(e);
  const int t = edge.triangle[0], u = edge.triangle[1];
  SplineJumps<Spline> jumps;
  std::array<std::size_t, Spline::max_functions> second{};
  const auto& first_functions = basis.functions(t);
  std::copy(first_functions.begin(), first_functions.end(), jumps.function.begin());
  jumps.n_functions = Spline::max_functions;
  for (std::size_t i = 0; i < second.size(); ++i) {
    const int function = basis.functions(u)[i];
    const auto known = std::find(first_functions.begin(), first_functions.end(), function);
    second[i] = static_cast<std::size_t>(known - first_functions.begin());
    if (known != first_functions.end()) continue;
    second[i] = jumps.n_functions;
    jumps.function[jumps.n_functions++] = function;
  }
  const auto index = [&](int triangle) {
    int k = 0;
    while (mesh.edge(triangle, k) != e) ++k;
    return k;
  };
  for (int half = 0; half < 2; ++half) {
    // The edge runs the other way round in the other triangle.
    const spline_jumps::Side a{t, index(t), half, {1, 0, 0}, {0, 1, 0}};
    const spline_jumps::Side b{u, index(u), 1 - half, {1, 0, 0}, {0, 1, 0}};
    spline_jumps::add_segment(basis, a, b, mesh.edge_length(e), 1.0, length, second, jumps);
  }
  return jumps;
}

/// Jumps across one of the six split edges inside triangle t: from Z to corner k (`to_corner`), or to the
/// split point of edge k. `share`: factor of the latter's weights.
template <class Spline>
SplineJumps<Spline> split_edge_jumps(const Spline& basis, int t, int k, bool to_corner,
                                     JumpLength length = JumpLength::element, double share = 1.0) {
  SplineJumps<Spline> jumps;
  std::array<std::size_t, Spline::max_functions> second{};
  for (std::size_t i = 0; i < second.size(); ++i) second[i] = i, jumps.function[i] = basis.functions(t)[i];
  jumps.n_functions = Spline::max_functions;
  const double size = std::sqrt(2.0 * basis.triangulation().area(t));
  if (to_corner) {
    const spline_jumps::Side a{t, k, 0, {0, 0, 1}, {1, 0, 0}}, b{t, (k + 2) % 3, 1, {0, 0, 1}, {1, 0, 0}};
    spline_jumps::add_segment(basis, a, b, size, 1.0, length, second, jumps);
  } else {
    const spline_jumps::Side a{t, k, 0, {0, 0, 1}, {0, 1, 0}}, b{t, k, 1, {0, 0, 1}, {0, 1, 0}};
    spline_jumps::add_segment(basis, a, b, size, share, length, second, jumps);
  }
  return jumps;
}

}  // namespace wisp
