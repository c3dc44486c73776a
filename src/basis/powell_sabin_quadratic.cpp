#include "basis/powell_sabin_quadratic.h"

namespace wisp {

PowellSabinQuadratic::PowellSabinQuadratic(const Triangulation& triangulation,
                                           const ControlTriangleOptions& options)
    : PowellSabinSpline(triangulation, options) {
  using enum QuadraticTerms::Ordinate;
  for (int t = 0; t < triangulation.n_triangles(); ++t) {
    Table& table = tables_[static_cast<std::size_t>(t)];
    for (int k = 0; k < 3; ++k) {
      const auto corner = static_cast<std::size_t>(k);
      const int v = triangulation.triangle(t)[corner];
      const Vec<2>& x = triangulation.vertex(v);
      auto& rows = table.ordinate[corner];
      set_linear(v, Vec<2>::Zero(), rows[vv]);
      set_linear(v, (split_.centre(t) - x) / 2.0, rows[vz]);
      for (int side = 0; side < 2; ++side) {
        const int e = triangulation.edge(t, side == 0 ? k : (k + 2) % 3);
        set_linear(v, (split_.edge_point(e) - x) / 2.0,
                   rows[static_cast<std::size_t>(QuadraticTerms::ordinate(vr, side))]);
      }
      for (int q = 0; q < 3; ++q) table.function[corner * 3 + static_cast<std::size_t>(q)] = 3 * v + q;
    }
  }
}

}  // namespace wisp
