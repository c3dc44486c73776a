// What quadratic and cubic Powell–Sabin splines share: tables of Bezier ordinates and their evaluation.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "basis/list_stencil.h"
#include "basis/stencil.h"
#include "basis/taylor.h"
#include "grid/powell_sabin_split.h"

namespace wisp {

/// Smooth (C1) splines on the Powell–Sabin split of a triangulation. A function belongs to a corner of a
/// triangle as its neighbour does, so each corner has its own `Terms::per_corner` functions there. On the
/// sub-triangle (V, R, Z) at corner V = V_k with R = s V_k + s' V_far and Z = sum a_i V_i, the ordinates at R
/// and Z are averages of those next to the corners; a polynomial there is the sum over the three corners of
/// (weight x ordinate next to that corner). `Terms` gives the weights, a derived class the ordinates.
///
/// `Terms`: degree, per_corner, n_ordinates; near(side), far(side): numbers of the ordinates that the two
/// corners of the edge contribute, `opposite`: that of the third; weights(v, r, z, ...) their weights.
template <class Terms>
class PowellSabinSpline {
 public:
  static constexpr int dimension = 2;
  static constexpr int degree = Terms::degree;
  static constexpr int continuity = 1;
  static constexpr bool non_negative = true;
  static constexpr bool uses_domains = false;
  static constexpr int max_functions = 3 * Terms::per_corner;
  using Stencil = ListStencil<2, max_functions>;
  using Functions = std::array<int, max_functions>;
  using Values = std::array<double, max_functions>;

  const Triangulation& triangulation() const { return split_.triangulation(); }
  const PowellSabinSplit& split() const { return split_; }
  int n_functions() const { return n_functions_; }
  /// The functions of triangle t, corner by corner.
  const Functions& functions(int t) const { return tables_[static_cast<std::size_t>(t)].function; }
  const ControlTriangle& control_triangle(int vertex) const {
    return control_[static_cast<std::size_t>(vertex)];
  }
  /// Where a coefficient lives: sum of control_point(i) phi_i(x) = x.
  const Vec<2>& control_point(int function) const {
    return control_points_[static_cast<std::size_t>(function)];
  }
  /// Vertex function 3 v + q at its vertex: value, gradient (1/m); the triplet of de Koster 2018, eq. 3.34.
  ValueAndGradient triplet(int vertex, int q) const;

  /// Stencil at x, which must lie in the grid; `hint` is a triangle near x.
  Stencil tabulate(const Vec<2>& x, int hint) const {
    return tabulate_in(triangulation().locate(x, hint), x);
  }
  /// The same with the last triangle as hint: points come in the order of cells.
  Stencil tabulate(const Vec<2>& x, const Vec<2>& /*half_length*/) const {
    last_ = triangulation().locate(x, last_);
    return tabulate_in(last_, x);
  }
  /// Stencil at a point of triangle t.
  Stencil tabulate_in(int t, const Vec<2>& x) const {
    const Table& table = tables_[static_cast<std::size_t>(t)];
    return tabulate_at(
        t, PowellSabinSplit::locate(triangulation().barycentric(t, x), table.centre, table.share));
  }
  /// Stencil at a point of a sub-triangle: also on its edges as this sub-triangle sees it.
  Stencil tabulate_at(int t, const SplitPoint& p) const;

  /// Derivatives of the functions of triangle t along `direction` at a point of a sub-triangle, 1/m^order.
  template <int order>
  Values derivatives(int t, const SplitPoint& p, const Vec<2>& direction) const;
  /// Second derivatives of the functions of triangle t, 1/m².
  std::array<Mat<2>, max_functions> hessians(int t, const SplitPoint& p) const;

 protected:
  static constexpr int width = Terms::per_corner + 1;  // of a corner's functions in one register
  using Row = std::array<double, width>;

  struct Table {
    /// Ordinates next to corner k of its functions, the last entry zero.
    std::array<std::array<Row, Terms::n_ordinates>, 3> ordinate{};
    std::array<double, 3> centre{};  ///< barycentric coordinates of Z
    std::array<double, 3> share{};   ///< of V_k in R_k
    Functions function{};
  };

  PowellSabinSpline(const Triangulation& triangulation, const ControlTriangleOptions& options)
      : split_(triangulation), control_(control_triangles(split_, degree, options)) {
    for (int t = 0; t < triangulation.n_triangles(); ++t) {
      Table table;
      table.centre = split_.centre_barycentric(t);
      for (int k = 0; k < 3; ++k) table.share[static_cast<std::size_t>(k)] = split_.share(t, k);
      tables_.push_back(table);
    }
    for (const auto& triangle : control_)
      for (const auto& q : triangle) control_points_.push_back(q);
    n_functions_ = static_cast<int>(control_points_.size());
  }

  /// The first order of a vertex' functions: ordinate f + g . (x - V) step of each, written to a row.
  void set_linear(int vertex, const Vec<2>& offset, Row& row) const {
    for (int q = 0; q < 3; ++q) {
      const auto f = triplet(vertex, q);
      row[static_cast<std::size_t>(q)] = clean(f.value + f.x * offset[0] + f.y * offset[1]);
    }
  }
  /// Zero where only rounding makes a difference: ordinates are of order one.
  static double clean(double ordinate) { return std::abs(ordinate) < 1e-13 ? 0.0 : ordinate; }

  /// The three coordinates (near, R, Z) of a sub-triangle as functions of type T.
  template <class T>
  struct Place {
    T v, r, z;
    std::size_t near, far, opposite;
    double near_share;
  };
  template <class T, class Make>
  Place<T> place(int t, const SplitPoint& p, Make&& make) const;
  /// Calls f(corner, ordinate, weight) for every ordinate that counts.
  template <class T, class F>
  static void for_each_term(const Table& table, int side, const Place<T>& at, F&& f);

  PowellSabinSplit split_;
  std::vector<ControlTriangle> control_;
  std::vector<Vec<2>> control_points_;
  std::vector<Table> tables_;
  int n_functions_ = 0;
  mutable int last_ = -1;
};

template <class Terms>
ValueAndGradient PowellSabinSpline<Terms>::triplet(int vertex, int q) const {
  const auto& c = control_triangle(vertex);
  const Vec<2>&a = c[static_cast<std::size_t>((q + 1) % 3)], &b = c[static_cast<std::size_t>((q + 2) % 3)];
  const Vec<2> side = b - a, gradient = Vec<2>(-side[1], side[0]) / (2.0 * signed_area(c));
  return {clean(gradient.dot(triangulation().vertex(vertex) - a)), gradient};
}

template <class Terms>
template <class T, class Make>
inline __attribute__((always_inline)) auto PowellSabinSpline<Terms>::place(int t, const SplitPoint& p,
                                                                           Make&& make) const -> Place<T> {
  const Table& table = tables_[static_cast<std::size_t>(t)];
  const auto gradient = triangulation().barycentric_gradients(t);
  const auto first = static_cast<std::size_t>(p.edge),
             second = static_cast<std::size_t>(PowellSabinSplit::next(p.edge));
  Place<T> at;
  at.near = p.side == 0 ? first : second, at.far = p.side == 0 ? second : first;
  at.opposite = 3 - first - second;
  at.near_share = p.side == 0 ? table.share[first] : 1.0 - table.share[first];
  const Vec<2> dz = gradient[at.opposite] / table.centre[at.opposite];
  const Vec<2> dr = (gradient[at.far] - table.centre[at.far] * dz) / (1.0 - at.near_share);
  const Vec<2> dv = -dz - dr;
  at.v = make(p.share[0], dv), at.r = make(p.share[1], dr), at.z = make(p.share[2], dz);
  return at;
}

template <class Terms>
template <class T, class F>
inline __attribute__((always_inline)) void PowellSabinSpline<Terms>::for_each_term(const Table& table,
                                                                                   int side,
                                                                                   const Place<T>& at,
                                                                                   F&& f) {
  const std::array<double, 2> share{at.near_share, 1.0 - at.near_share};
  const std::array<double, 3> centre{table.centre[at.near], table.centre[at.far], table.centre[at.opposite]};
  const auto weights = Terms::template weights<T>(at.v, at.r, at.z, share, centre);
  constexpr auto near = Terms::near;
  constexpr auto far = Terms::far;
  for (std::size_t i = 0; i < near.size(); ++i)
    f(at.near, static_cast<std::size_t>(Terms::ordinate(near[i], side)), weights[i]);
  for (std::size_t i = 0; i < far.size(); ++i)
    f(at.far, static_cast<std::size_t>(Terms::ordinate(far[i], 1 - side)), weights[near.size() + i]);
  f(at.opposite, static_cast<std::size_t>(Terms::opposite), weights[near.size() + far.size()]);
}

template <class Terms>
inline __attribute__((always_inline)) auto PowellSabinSpline<Terms>::tabulate_at(int t,
                                                                                 const SplitPoint& p) const
    -> Stencil {
  using Vector = Record<width>;
  const Table& table = tables_[static_cast<std::size_t>(t)];
  const auto at = place<ValueAndGradient>(
      t, p, [](double value, const Vec<2>& gradient) { return ValueAndGradient(value, gradient); });
  std::array<Vector, 3> value{}, x{}, y{};
  for_each_term(table, p.side, at, [&](std::size_t corner, std::size_t ordinate, const ValueAndGradient& w) {
    Vector row;
    load_record<width>(table.ordinate[corner][ordinate].data(), row);
    value[corner] += w.value * row, x[corner] += w.x * row, y[corner] += w.y * row;
  });
  Stencil s;
  s.cell = t;
  s.function = table.function;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    // The zero at the end of a row is overwritten by the next corner's.
    constexpr std::size_t step = Terms::per_corner;
    store_record<width>(value[corner], s.value.data() + corner * step);
    store_record<width>(x[corner], s.derivative[0].data() + corner * step);
    store_record<width>(y[corner], s.derivative[1].data() + corner * step);
  }
  return s;
}

template <class Terms>
template <int order>
auto PowellSabinSpline<Terms>::derivatives(int t, const SplitPoint& p, const Vec<2>& direction) const
    -> Values {
  const Table& table = tables_[static_cast<std::size_t>(t)];
  const auto at = place<Taylor<order>>(t, p, [&](double value, const Vec<2>& gradient) {
    return Taylor<order>(value, gradient.dot(direction));
  });
  Values out{};
  double factorial = 1.0;
  for (int i = 2; i <= order; ++i) factorial *= i;
  for_each_term(table, p.side, at, [&](std::size_t corner, std::size_t ordinate, const Taylor<order>& w) {
    for (std::size_t i = 0; i < Terms::per_corner; ++i)
      out[corner * Terms::per_corner + i] += factorial * w.c[order] * table.ordinate[corner][ordinate][i];
  });
  return out;
}

template <class Terms>
auto PowellSabinSpline<Terms>::hessians(int t, const SplitPoint& p) const
    -> std::array<Mat<2>, max_functions> {
  const auto xx = derivatives<2>(t, p, {1.0, 0.0}), yy = derivatives<2>(t, p, {0.0, 1.0});
  const auto both = derivatives<2>(t, p, {1.0, 1.0});
  std::array<Mat<2>, max_functions> out;
  for (std::size_t i = 0; i < max_functions; ++i) {
    const double xy = 0.5 * (both[i] - xx[i] - yy[i]);
    out[i] << xx[i], xy, xy, yy[i];
  }
  return out;
}

}  // namespace wisp
