// Jumps of normal derivatives across facets: what a ghost penalty needs from a basis.
#pragma once
#include <array>
#include <vector>

#include "basis/space.h"

namespace wisp {

/// A facet between cell `lower` (local index) and its upper neighbour in `direction`. On triangulations
/// `lower` is the number of an edge (direction 0), or of a triangle with all that lies inside it (direction
/// 1).
struct Facet {
  int lower = 0;
  int direction = 0;
};

/// Which edges of the grid are held by conditions, so that bodies have no free edge there.
template <int dim>
struct HeldEdges {
  std::array<bool, 2 * dim>
      side{};              ///< structured grids: entry 2 d + side, side 0 the lower edge of direction d
  std::vector<char> edge;  ///< triangulations: flags of edges; those beyond its end are free

  HeldEdges() = default;
  HeldEdges(const std::array<bool, 2 * dim>& sides) : side(sides) {}  // NOLINT: an array says it all
  bool holds(int e) const {
    return static_cast<std::size_t>(e) < edge.size() && edge[static_cast<std::size_t>(e)];
  }
};

/// h^(2 p + 1) / ((2 p + 1) (p!)^2), what makes the square of the jump of the derivative of order p a mass
/// per density (Burman 2010; h^3/3 of Coombs 2023): the integral over a length h of the square of x^p / p!.
constexpr double jump_moment(int p, double h) {
  double moment = h;
  for (int k = 1; k <= p; ++k) moment *= h * h / (k * k);
  return moment / (2 * p + 1);
}

/// Gauss points on a facet with the jump of the normal derivative of every function of its two cells:
/// `weight` (m2, in 2D m) includes the facet's size; jump of u at Gauss point q is sum_k jump[q][k]
/// u_{function[k]} (1/m each).
template <int dim>
struct FacetJumps {
  static constexpr int order = 1;  ///< of the derivative
  static constexpr int n_functions = dim == 2 ? 6 : 12;
  static constexpr int n_points = dim == 2 ? 2 : 4;
  std::array<int, n_functions> function;
  std::array<double, n_points> weight;
  std::array<std::array<double, n_functions>, n_points> jump;
  double normal_extent = 0.0;  ///< h_n, mean of the two cells' sides normal to the facet, m
};

/// Jumps of the grid's linear functions, which the linear basis is and GIMP is made from (Coombs 2023, eq.
/// 21-23). Two Gauss points a direction integrate products of jumps exactly.
template <int dim>
FacetJumps<dim> facet_jumps(const Space<dim>& space, const Facet& facet) {
  constexpr double gauss[2] = {0.5 - 0.28867513459481288225, 0.5 + 0.28867513459481288225};
  const auto& window = space.window();
  const auto& grid = space.grid();
  const MultiIndex<dim> cell = window.cell_multi_index(facet.lower);
  const int n = facet.direction;
  const double h_lower = grid.spacing(n, cell[n]), h_upper = grid.spacing(n, cell[n] + 1);
  const double normal[3] = {1.0 / h_lower, -1.0 / h_lower - 1.0 / h_upper, 1.0 / h_upper};

  FacetJumps<dim> out;
  out.normal_extent = 0.5 * (h_lower + h_upper);
  const int base = window.node_index(cell);
  const int t1 = (n + 1) % dim, t2 = (n + 2) % dim;  // t2 only in 3D
  const int tangential = dim == 2 ? 2 : 4;
  const double area = grid.spacing(t1, cell[t1]) * (dim == 3 ? grid.spacing(t2, cell[t2]) : 1.0);
  for (int k = 0; k < 3; ++k)
    for (int t = 0; t < tangential; ++t) {
      int function = base + k * window.node_strides()[n] + (t & 1) * window.node_strides()[t1];
      if constexpr (dim == 3) function += (t >> 1) * window.node_strides()[t2];
      out.function[static_cast<std::size_t>(k * tangential + t)] = function;
    }
  for (int q = 0; q < tangential; ++q) {
    out.weight[static_cast<std::size_t>(q)] = area / tangential;
    const double r1 = gauss[q & 1], r2 = gauss[q >> 1];
    for (int k = 0; k < 3; ++k)
      for (int t = 0; t < tangential; ++t) {
        double value = (t & 1) ? r1 : 1.0 - r1;
        if (dim == 3) value *= (t >> 1) ? r2 : 1.0 - r2;
        out.jump[static_cast<std::size_t>(q)][static_cast<std::size_t>(k * tangential + t)] =
            normal[k] * value;
      }
  }
  return out;
}

}  // namespace wisp
