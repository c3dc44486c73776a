// Jumps of the highest normal derivative of B-splines across facets: what a ghost penalty needs from them.
#pragma once
#include <array>

#include "basis/bspline.h"
#include "basis/facet.h"
#include "grid/quadrature.h"

namespace wisp {

/// Gauss points on a facet with the jump of the derivative of order `degree` along the normal of every
/// function of its two cells; those of lower order have none. `weight` (m2, in 2D m) includes the facet's
/// size; jump of u at Gauss point q is sum_k jump[q][k] u_{function[k]} (1/m^degree each).
template <int dim, int degree>
struct BSplineJumps {
  static constexpr int order = degree;  ///< of the derivative
  static constexpr int along = dim == 2 ? degree + 1 : (degree + 1) * (degree + 1);
  static constexpr int n_functions = (degree + 2) * along;
  static constexpr int n_points = along;
  std::array<int, n_functions> function;
  std::array<double, n_points> weight;
  std::array<std::array<double, n_functions>, n_points> jump;
  double normal_extent = 0.0;  ///< h, mean of the two cells' sides normal to the facet, m
};

/// degree + 1 Gauss points a direction integrate products of jumps exactly.
template <int dim, int degree>
BSplineJumps<dim, degree> bspline_jumps(const Space<dim>& space, const BSpline<dim, degree>& basis,
                                        const Facet& facet) {
  constexpr int n = degree + 1;
  const auto& grid = space.grid();
  const auto& strides = space.window().node_strides();
  const MultiIndex<dim> cell = space.window().cell_multi_index(facet.lower);
  const int normal = facet.direction;
  static const IntervalRule rule = gauss_legendre(n);

  BSplineJumps<dim, degree> out;
  out.normal_extent = 0.5 * (grid.spacing(normal, cell[normal]) + grid.spacing(normal, cell[normal] + 1));

  // Across the facet: functions first of the lower cell, one more of the upper.
  std::array<double, n + 1> across{};
  const auto below = basis.knots(normal).template highest_derivative<degree>(cell[normal]);
  const auto above = basis.knots(normal).template highest_derivative<degree>(cell[normal] + 1);
  for (std::size_t k = 0; k < n; ++k) across[k] -= below[k], across[k + 1] += above[k];

  std::array<std::array<std::array<double, n>, n>, 2> tangential{};  // direction, Gauss point, function
  std::array<int, 2> direction{(normal + 1) % dim, (normal + 2) % dim};
  for (int t = 0; t < dim - 1; ++t)
    for (std::size_t q = 0; q < n; ++q) {
      const auto at = static_cast<std::size_t>(t);
      const int d = direction[at], c = cell[d];
      std::array<double, n> slope;
      basis.knots(d).template evaluate<degree>(c, grid.line(d, c) + rule.place[q] * grid.spacing(d, c),
                                               tangential[at][q], slope);
    }
  for (int q = 0; q < BSplineJumps<dim, degree>::n_points; ++q) {
    const auto point = static_cast<std::size_t>(q), q1 = static_cast<std::size_t>(q % n),
               q2 = static_cast<std::size_t>(q / n);
    out.weight[point] = grid.spacing(direction[0], cell[direction[0]]) * rule.weight[q1];
    if (dim == 3) out.weight[point] *= grid.spacing(direction[1], cell[direction[1]]) * rule.weight[q2];
    std::size_t k = 0;
    for (int a = 0; a <= n; ++a)
      for (int t = 0; t < BSplineJumps<dim, degree>::along; ++t, ++k) {
        double value =
            across[static_cast<std::size_t>(a)] * tangential[0][q1][static_cast<std::size_t>(t % n)];
        int function =
            space.window().node_index(cell) + a * strides[normal] + (t % n) * strides[direction[0]];
        if constexpr (dim == 3) {
          value *= tangential[1][q2][static_cast<std::size_t>(t / n)];
          function += (t / n) * strides[direction[1]];
        }
        out.function[k] = function, out.jump[point][k] = value;
      }
  }
  return out;
}

}  // namespace wisp
