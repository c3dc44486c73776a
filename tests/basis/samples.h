// Grids, points and domain sizes on which every basis has to keep its contract.
#pragma once
#include <random>
#include <vector>

#include "basis/space.h"

namespace wisp::basis_test {

template <int dim>
StructuredGrid<dim> equal_grid() {
  return {Vec<dim>::Constant(-0.3), Vec<dim>::Constant(1.8), MultiIndex<dim>::Constant(7)};
}

template <int dim>
StructuredGrid<dim> unequal_grid() {
  std::array<std::vector<double>, dim> lines;
  for (int d = 0; d < dim; ++d) {
    double x = 0.1 * d;
    for (const double h : {0.3, 0.25, 0.5, 0.3, 0.6, 0.25, 0.4})
      lines[static_cast<std::size_t>(d)].push_back(x), x += h * (1.0 + 0.2 * d);
    lines[static_cast<std::size_t>(d)].push_back(x);
  }
  return StructuredGrid<dim>(lines);
}

/// Positions inside the grid: random ones, and combinations of edges, grid lines and places next to them.
template <int dim>
std::vector<Vec<dim>> positions(const StructuredGrid<dim>& grid, int n_random) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Vec<dim>> list;
  for (int k = 0; k < n_random; ++k) {
    Vec<dim> x;
    for (int d = 0; d < dim; ++d) x[d] = grid.lower()[d] + unit(random) * (grid.upper()[d] - grid.lower()[d]);
    list.push_back(x);
  }
  const auto special = [&](int d, int k) {
    const double low = grid.lower()[d], high = grid.upper()[d], h = grid.shortest_side();
    const double places[] = {low,
                             high,
                             grid.line(d, 3),
                             low + 1e-13,
                             high - 0.3 * h,
                             low + 0.4 * h,
                             grid.line(d, 5),
                             grid.line(d, 2) - 1e-15,
                             0.5 * (low + high)};
    return places[k % 9];
  };
  for (int k = 0; k < 81; ++k) {
    Vec<dim> x;
    for (int d = 0; d < dim; ++d) x[d] = special(d, d == 0 ? k : d == 1 ? k / 9 : 5 * k + 1);
    list.push_back(x);
  }
  return list;
}

/// Half-lengths that a basis of this width promises to carry, from zero up; h is the shortest side.
inline std::vector<double> half_lengths(int width, double h) {
  std::vector<double> list{0.0,      1e-300,    1e-16 * h, 1e-12 * h,  1e-9 * h,
                           1e-3 * h, 0.125 * h, 0.25 * h,  0.4999 * h, 0.5 * h};
  if (width == 5)
    for (const double l : {0.5001, 0.75, 1.0, 1.25, 1.4999, 1.5}) list.push_back(l * h);
  return list;
}

/// Values and gradients of all functions of a space at a point.
template <int dim>
struct Evaluation {
  std::vector<double> phi;
  std::vector<Vec<dim>> dphi;
};

template <int dim, class Basis>
Evaluation<dim> evaluate(const Space<dim>& space, const Basis& basis, const Vec<dim>& x, const Vec<dim>& l) {
  Evaluation<dim> e{std::vector<double>(static_cast<std::size_t>(space.n_functions()), 0.0),
                    std::vector<Vec<dim>>(static_cast<std::size_t>(space.n_functions()), Vec<dim>::Zero())};
  basis.tabulate(x, l).for_each([&](int, int i, double phi, const Vec<dim>& dphi) {
    e.phi[static_cast<std::size_t>(i)] += phi, e.dphi[static_cast<std::size_t>(i)] += dphi;
  });
  return e;
}

}  // namespace wisp::basis_test
