// Cubic Powell–Sabin splines: smooth, non-negative piecewise cubics on any triangulation.
#pragma once
#include "basis/powell_sabin.h"

namespace wisp {

/// Cubic Bezier polynomials of a sub-triangle (V, R, Z) from the ordinates next to the corners: RRR, RRZ, RZZ
/// are averages of V RR, V RZ, V ZZ over the edge's two corners, ZZZ that of V ZZ over all three.
struct CubicTerms {
  static constexpr int degree = 3, per_corner = 7, n_ordinates = 9;
  enum Ordinate { vvv, vvz, vzz, vvr, vrz, vrr };
  static constexpr std::array<int, 6> near{vvv, vvz, vzz, vvr, vrz, vrr};
  static constexpr std::array<int, 3> far{vzz, vrz, vrr};
  static constexpr int opposite = vzz;
  /// Number in the table: side 0 is the edge after the corner, 1 the one before.
  static constexpr int ordinate(int kind, int side) { return kind >= vvr ? kind + 3 * side : kind; }

  template <class T>
  static inline __attribute__((always_inline)) std::array<T, 10> weights(
      const T& v, const T& r, const T& z, const std::array<double, 2>& share,
      const std::array<double, 3>& centre) {
    const T rr = r * r, zz = z * z, vv = v * v, rrr = rr * r, rrz = 3.0 * (rr * z), rzz = 3.0 * (r * zz),
            zzz = z * zz;
    return {vv * v,
            3.0 * (vv * z),
            3.0 * (v * zz) + share[0] * rzz + centre[0] * zzz,
            3.0 * (vv * r),
            6.0 * (v * (r * z)) + share[0] * rrz,
            3.0 * (v * rr) + share[0] * rrr,
            share[1] * rzz + centre[1] * zzz,
            share[1] * rrz,
            share[1] * rrr,
            centre[2] * zzz};
  }
};

/// The full space of C1 cubics on the split with a non-negative basis that sums to one (Grošelj and Speleers
/// 2017; de Koster 2018, appendix A.3): three functions a vertex (3 v + q), two a corner of a triangle, two a
/// boundary edge.
class PowellSabinCubic : public PowellSabinSpline<CubicTerms> {
 public:
  /// `triangulation` must outlive the basis.
  explicit PowellSabinCubic(const Triangulation& triangulation, const ControlTriangleOptions& options = {});

  /// The function of corner k of triangle t towards the split point of the edge after (side 0) or before
  /// (side 1) it.
  int corner_function(int t, int k, int side) const {
    return 3 * triangulation().n_vertices() + 6 * t + 2 * k + side;
  }
  /// The function of a boundary edge at its vertex number `end` (0 or 1).
  int edge_function(int e, int end) const {
    return 3 * triangulation().n_vertices() + 6 * triangulation().n_triangles() +
           2 * boundary_number_[static_cast<std::size_t>(e)] + end;
  }

  /// A corner of a triangle: Z - V = a (R+ - V) + b (R- - V), R+ on the edge after the corner, R- on the one
  /// before. Its control triangle is P0 = (2V + Z)/3, P0 + s (R+ - V)/3, P0 + s (R- - V)/3; s = max(1, a + b)
  /// keeps (V + 2Z)/3 inside.
  struct Corner {
    double a = 0.0, b = 0.0, s = 1.0;
  };
  const Corner& corner(int t, int k) const { return corners_[static_cast<std::size_t>(3 * t + k)]; }

 private:
  void find_corners();
  void place_controls();
  void fill(int t, int k);
  void fill_edge(int t, int k, int side);

  std::vector<Corner> corners_;
  std::vector<int> boundary_number_;
};

}  // namespace wisp
