// Quadratic Powell–Sabin splines: smooth, non-negative functions on any triangulation.
#pragma once
#include "basis/powell_sabin.h"

namespace wisp {

/// Quadratic Bezier polynomials of a sub-triangle (V, R, Z) from the ordinates V, VZ and VR next to the
/// corners (de Koster 2018, figure 3.22): c(R) = s VR + s' V'R, c(RZ) = s VZ + s' V'Z, c(Z) = sum a_i V_iZ.
struct QuadraticTerms {
  static constexpr int degree = 2, per_corner = 3, n_ordinates = 4;
  enum Ordinate { vv, vz, vr };  ///< vr: towards the split point of the edge, two of them
  static constexpr std::array<int, 3> near{vv, vz, vr};
  static constexpr std::array<int, 2> far{vz, vr};
  static constexpr int opposite = vz;
  /// Number in the table: side 0 is the edge after the corner, 1 the one before.
  static constexpr int ordinate(int kind, int side) { return kind == vr ? vr + side : kind; }

  template <class T>
  static inline __attribute__((always_inline)) std::array<T, 6> weights(const T& v, const T& r, const T& z,
                                                                        const std::array<double, 2>& share,
                                                                        const std::array<double, 3>& centre) {
    const T rr = r * r, rz = 2.0 * (r * z), zz = z * z;
    return {v * v,
            2.0 * (v * z) + share[0] * rz + centre[0] * zz,
            2.0 * (v * r) + share[0] * rr,
            share[1] * rz + centre[1] * zz,
            share[1] * rr,
            centre[2] * zz};
  }
};

/// Three functions a vertex: number 3 v + q belongs to corner q of the control triangle of vertex v (Dierckx
/// 1997; de Koster 2018, section 3.5).
class PowellSabinQuadratic : public PowellSabinSpline<QuadraticTerms> {
 public:
  /// `triangulation` must outlive the basis.
  explicit PowellSabinQuadratic(const Triangulation& triangulation,
                                const ControlTriangleOptions& options = {});
};

}  // namespace wisp
