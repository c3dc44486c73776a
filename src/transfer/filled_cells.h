// Cells that a body fills, with Gauss points and the Taylor basis of each: where fields of the points are
// reconstructed.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <span>
#include <vector>

#include "basis/space.h"
#include "grid/quadrature.h"
#include "particle/body.h"
#include "transfer/active.h"

namespace wisp {

template <int dim>
struct GaussPoint {
  Vec<dim> x;
  double weight;  ///< m2, m3
};

/// Points of a triangle, exact for polynomials of a degree.
inline void add_triangle(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const TriangleRule& rule,
                         std::vector<GaussPoint<2>>& list) {
  const double area = 0.5 * std::abs((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
  for (std::size_t q = 0; q < rule.weight.size(); ++q) {
    const auto& s = rule.place[q];
    list.push_back({s[0] * a + s[1] * b + s[2] * c, area * rule.weight[q]});
  }
}

/// Gauss points of the pieces of a triangle on which the functions are polynomials.
template <class Basis>
void gauss_points(const Basis& basis, int t, const TriangleRule& rule, std::vector<GaussPoint<2>>& list) {
  const Triangulation& mesh = basis.triangulation();
  list.clear();
  if constexpr (requires { basis.split(); }) {
    for (int k = 0; k < 3; ++k) {
      const Vec<2> r = basis.split().edge_point(mesh.edge(t, k)), z = basis.split().centre(t);
      add_triangle(mesh.corner(t, k), r, z, rule, list);
      add_triangle(r, mesh.corner(t, (k + 1) % 3), z, rule, list);
    }
  } else {
    add_triangle(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), rule, list);
  }
}

/// Points of a cell of a structured grid.
template <int dim>
void gauss_points(const StructuredGrid<dim>& grid, const MultiIndex<dim>& cell, const IntervalRule& rule,
                  std::vector<GaussPoint<dim>>& list) {
  list.clear();
  const auto n = static_cast<int>(rule.place.size());
  const MultiIndex<dim> points = MultiIndex<dim>::Constant(n);
  for_each_in(IndexBox<dim>{MultiIndex<dim>::Zero(), points}, [&](const MultiIndex<dim>& k) {
    GaussPoint<dim> g{Vec<dim>::Zero(), 1.0};
    for (int d = 0; d < dim; ++d) {
      const double h = grid.spacing(d, cell[d]);
      const auto q = static_cast<std::size_t>(k[d]);
      g.x[d] = grid.line(d, cell[d]) + h * rule.place[q];
      g.weight *= h * rule.weight[q];
    }
    list.push_back(g);
  });
}

/// The rule of three points, or that of a drawn-together square, on a triangle.
inline TriangleRule triangle_rule_of_degree(int degree) {
  if (degree > 2) return triangle_rule((degree + 3) / 2);
  TriangleRule rule;
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<double, 3> place{1.0 / 6, 1.0 / 6, 1.0 / 6};
    place[k] = 2.0 / 3;
    rule.place.push_back(place), rule.weight.push_back(1.0 / 3);
  }
  return rule;
}

/// Calls f(cell, its Gauss points) for the cells with a flag, with points that are exact for polynomials of
/// `degree` (in each direction on structured grids).
template <int dim, class Basis, class F>
void for_each_cell(const Space<dim>& space, const Basis& basis, const std::vector<char>& flags, int degree,
                   F&& f) {
  std::vector<GaussPoint<dim>> gauss;
  if constexpr (is_on_triangles<Basis>) {
    const TriangleRule rule = triangle_rule_of_degree(degree);
    for (int t = 0; t < space.n_cells(); ++t)
      if (flags[static_cast<std::size_t>(t)]) gauss_points(basis.basis(), t, rule, gauss), f(t, gauss);
  } else {
    const IntervalRule rule = gauss_legendre((degree + 2) / 2);
    for_each_in(space.window().owned_cells(), [&](const MultiIndex<dim>& c) {
      const int index = space.window().cell_index(c);
      if (flags[static_cast<std::size_t>(index)])
        gauss_points<dim>(space.grid(), c, rule, gauss), f(index, gauss);
    });
  }
}

/// Degree of linear stress times gradients of the functions.
template <class Basis>
inline constexpr int force_degree = is_on_triangles<Basis> ? Basis::degree : Basis::degree + 1;
/// Degree of linear density times products of functions.
template <class Basis>
inline constexpr int mass_degree = 2 * Basis::degree + 1;

/// Flags of the cells that hold points of the body `number` alone, as do all cells around their vertices.
template <int dim>
std::vector<char> cells_inside(const Space<dim>& space, const ActiveCells& cells, std::size_t number);

/// Points of each cell of the window, cell by cell.
class PointsOfCells {
 public:
  PointsOfCells(const std::vector<int>& cell, int n_cells);
  std::span<const int> of(int c) const {
    const auto i = static_cast<std::size_t>(c);
    return std::span(list_).subspan(static_cast<std::size_t>(start_[i]),
                                    static_cast<std::size_t>(start_[i + 1] - start_[i]));
  }

 private:
  std::vector<int> start_, list_;
};

/// The Taylor basis {1, (x - c)/h} of a cell, c its centroid and h^dim its volume: the linear functions have
/// no integral over the cell (Wobbes et al. 2019).
template <int dim>
struct TaylorBasis {
  static constexpr int terms = dim + 1;
  using Terms = Eigen::Matrix<double, terms, 1>;
  using Square = Eigen::Matrix<double, terms, terms>;
  Vec<dim> centre = Vec<dim>::Zero();
  double volume = 0.0, size = 1.0;

  explicit TaylorBasis(const std::vector<GaussPoint<dim>>& gauss) {
    for (const auto& g : gauss) volume += g.weight, centre += g.weight * g.x;
    centre /= volume, size = std::pow(volume, 1.0 / dim);
  }
  Terms at(const Vec<dim>& x) const {
    Terms t;
    t << 1.0, (x - centre) / size;
    return t;
  }
};

/// Present volume of a point over its initial one: small-strain laws neglect the change.
template <int dim>
double volume_ratio(const Particles<dim>& points, bool finite_strain, std::size_t p) {
  return finite_strain ? points.deformation_gradient[p].determinant() : 1.0;
}

/// Points of a cell with its Taylor basis: what a fit to values of these points needs.
template <int dim>
struct FilledCell {
  std::span<const int> points;
  const std::vector<GaussPoint<dim>>& gauss;
  TaylorBasis<dim> taylor;
  typename TaylorBasis<dim>::Square inverse;  ///< of sum_p t(x_p) t(x_p)^T
};

/// Share of a cell's volume that its points must have to count as filling it. A triangle of a regular lattice
/// with points on its edges can lose a quarter of them when these change sides; a limit near that share lets
/// such a triangle go in and out with every oscillation, each time with a jump of its forces.
inline constexpr double filled_share = 0.5;

/// Whether the points of a cell determine a linear function and fill it; if so, `inverse` is set.
template <int dim>
bool determine(const Particles<dim>& points, bool finite_strain, FilledCell<dim>& cell);

/// Calls f(basis, cell) for the cells that a body fills: those inside whose points determine a linear
/// function and have at least `filled_share` of the volume. Gauss points are exact to degree(basis). Bases
/// without domains only.
template <int dim, class Degree, class F>
void for_each_filled(const Space<dim>& space, const Body<dim>& body, const std::vector<char>& inside,
                     Degree&& degree, F&& f) {
  const PointsOfCells of_cells(body.points.cell, space.n_cells());
  const bool finite_strain = body.finite_strain();
  std::visit(
      [&](const auto& basis) {
        if constexpr (!std::decay_t<decltype(basis)>::uses_domains) {
          for_each_cell<dim>(space, basis, inside, degree(basis),
                             [&](int c, const std::vector<GaussPoint<dim>>& gauss) {
                               FilledCell<dim> cell{of_cells.of(c), gauss, TaylorBasis<dim>(gauss), {}};
                               if (determine(body.points, finite_strain, cell)) f(basis, cell);
                             });
        }
      },
      space.basis());
}

}  // namespace wisp
