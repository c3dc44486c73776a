#include "transfer/reconstruction.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "grid/quadrature.h"
#include "transfer/explicit_transfer.h"

namespace wisp {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

template <int dim>
struct GaussPoint {
  Vec<dim> x;
  double weight;  ///< m2, m3
};

/// Exact for polynomials of degree 2: linear stress times gradients of quadratic functions.
void add_triangle(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, std::vector<GaussPoint<2>>& list) {
  const double area = 0.5 * std::abs((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
  for (int k = 0; k < 3; ++k) {
    const double s[3] = {k == 0 ? 2.0 / 3 : 1.0 / 6, k == 1 ? 2.0 / 3 : 1.0 / 6, k == 2 ? 2.0 / 3 : 1.0 / 6};
    list.push_back({s[0] * a + s[1] * b + s[2] * c, area / 3.0});
  }
}

/// Gauss points of the pieces of a triangle on which the functions are polynomials.
template <class Basis>
void gauss_points(const Basis& basis, int t, std::vector<GaussPoint<2>>& list) {
  const Triangulation& mesh = basis.triangulation();
  list.clear();
  if constexpr (requires { basis.split(); }) {
    for (int k = 0; k < 3; ++k) {
      const Vec<2> r = basis.split().edge_point(mesh.edge(t, k)), z = basis.split().centre(t);
      add_triangle(mesh.corner(t, k), r, z, list);
      add_triangle(r, mesh.corner(t, (k + 1) % 3), z, list);
    }
  } else {
    add_triangle(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), list);
  }
}

/// Points of a cell of a structured grid that are exact for linear stress times gradients of functions of a
/// degree.
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
      g.x[d] = grid.line(d, cell[d]) + h * rule.place[at(k[d])];
      g.weight *= h * rule.weight[at(k[d])];
    }
    list.push_back(g);
  });
}

/// Bits of bodies that all cells around a cell's vertices share (`every`) and that any of them has (`any`).
struct Around {
  std::vector<int> every, any;
};

template <int dim>
Around bits_around(const Space<dim>& space, const ActiveCells& cells) {
  Around around{cells.bits, cells.bits};
  if constexpr (dim == 2)
    if (!space.structured()) {
      const Triangulation& mesh = space.triangulation();
      for (int v = 0; v < mesh.n_vertices(); ++v) {
        int every = ~0, any = 0;
        for (const int t : mesh.triangles_of_vertex(v)) every &= cells.bits[at(t)], any |= cells.bits[at(t)];
        for (const int t : mesh.triangles_of_vertex(v))
          around.every[at(t)] &= every, around.any[at(t)] |= any;
      }
      return around;
    }
  const auto& window = space.window();
  for_each_in(window.owned_cells(), [&](const MultiIndex<dim>& c) {
    const std::size_t here = at(window.cell_index(c));
    for_each_in(IndexBox<dim>{c - MultiIndex<dim>::Ones(), c + MultiIndex<dim>::Constant(2)},
                [&](const MultiIndex<dim>& n) {
                  if (!window.cell_in_grid(n)) return;
                  const int bits = cells.bits[at(window.cell_index(n))];
                  around.every[here] &= bits, around.any[here] |= bits;
                });
  });
  return around;
}

/// Cauchy stress and present volume of a point.
template <int dim, class Law, class State>
std::pair<Mat<dim>, double> stress_and_volume(const Particles<dim>& points, std::size_t p,
                                              const State& state) {
  const double ratio = Law::finite_strain ? points.deformation_gradient[p].determinant() : 1.0;
  return {matrix<dim>(state.stress) / ratio, points.volume[p] * ratio};
}

/// The fit in one cell: sigma_h(x) = sum_a coefficient[a] taylor_a(x).
template <int dim>
struct Fit {
  static constexpr int terms = dim + 1;
  Vec<dim> centre = Vec<dim>::Zero();
  double size = 1.0;
  std::array<Mat<dim>, terms> coefficient{};

  Eigen::Matrix<double, terms, 1> taylor(const Vec<dim>& x) const {
    Eigen::Matrix<double, terms, 1> t;
    t << 1.0, (x - centre) / size;
    return t;
  }
  Mat<dim> at(const Vec<dim>& x) const {
    const auto t = taylor(x);
    Mat<dim> sum = Mat<dim>::Zero();
    for (int a = 0; a < terms; ++a) sum += t[a] * coefficient[static_cast<std::size_t>(a)];
    return sum;
  }
};

/// Whether the points of a cell determine a fit, which is left in `fit`.
template <int dim, class Group>
bool fit_stress(const Particles<dim>& points, const Group& group, std::span<const int> in_cell,
                const std::vector<GaussPoint<dim>>& gauss, Fit<dim>& fit) {
  using Law = std::decay_t<decltype(group.law)>;
  constexpr int terms = Fit<dim>::terms;
  if (static_cast<int>(in_cell.size()) < terms + 1) return false;
  double whole = 0.0, filled = 0.0;
  fit = {};
  for (const auto& g : gauss) whole += g.weight, fit.centre += g.weight * g.x;
  fit.centre /= whole, fit.size = std::pow(whole, 1.0 / dim);
  Eigen::Matrix<double, terms, terms> normal = Eigen::Matrix<double, terms, terms>::Zero();
  std::array<Mat<dim>, terms> right{};
  for (auto& r : right) r.setZero();
  for (const int q : in_cell) {
    const auto p = static_cast<std::size_t>(q);
    const auto [sigma, volume] = stress_and_volume<dim, Law>(points, p, group.old[p]);
    const auto t = fit.taylor(points.position[p]);
    normal += t * t.transpose();
    for (int a = 0; a < terms; ++a) right[static_cast<std::size_t>(a)] += t[a] * sigma;
    filled += volume;
  }
  if (filled < 0.75 * whole) return false;
  const Eigen::LDLT<Eigen::Matrix<double, terms, terms>> solver(normal);
  if (solver.vectorD().minCoeff() < 1e-4 * normal(0, 0)) return false;  // points on a line
  const Eigen::Matrix<double, terms, terms> inverse =
      solver.solve(Eigen::Matrix<double, terms, terms>::Identity());
  for (int a = 0; a < terms; ++a) {
    Mat<dim>& c = fit.coefficient[static_cast<std::size_t>(a)];
    c.setZero();
    for (int b = 0; b < terms; ++b) c += inverse(a, b) * right[static_cast<std::size_t>(b)];
  }
  return true;
}

/// Points of each cell of the window, cell by cell.
struct PointsOfCells {
  std::vector<int> start, list;

  PointsOfCells(const std::vector<int>& cell, int n_cells) : start(at(n_cells) + 1, 0), list(cell.size()) {
    for (const int c : cell)
      if (c >= 0) ++start[at(c) + 1];
    for (std::size_t c = 1; c < start.size(); ++c) start[c] += start[c - 1];
    std::vector<int> next(start.begin(), start.end() - 1);
    for (std::size_t p = 0; p < cell.size(); ++p)
      if (cell[p] >= 0) list[at(next[at(cell[p])]++)] = static_cast<int>(p);
  }
  std::span<const int> of(int c) const {
    return std::span(list).subspan(at(start[at(c)]), at(start[at(c) + 1] - start[at(c)]));
  }
};

template <int dim, class Stencil>
void add_force(const Stencil& stencil, const Mat<dim>& stress_times_volume, std::span<double> sums) {
  stencil.for_each([&](int, int i, double, const Vec<dim>& dphi) {
    const Vec<dim> f = stress_times_volume * dphi;
    double* const out = sums.data() + static_cast<std::ptrdiff_t>(i) * sums_stride<dim> + 1 + dim;
    for (int d = 0; d < dim; ++d) out[d] -= f[d];
  });
}

/// Calls f(cell, its Gauss points) for the cells with a flag.
template <int dim, class Basis, class F>
void for_each_cell(const Space<dim>& space, const Basis& basis, const std::vector<char>& flags, F&& f) {
  std::vector<GaussPoint<dim>> gauss;
  if constexpr (is_on_triangles<Basis>) {
    for (int t = 0; t < space.n_cells(); ++t)
      if (flags[at(t)]) gauss_points(basis.basis(), t, gauss), f(t, gauss);
  } else {
    // Stress of degree 1 and functions of degree p: exact to degree p + 1.
    const IntervalRule rule = gauss_legendre((Basis::degree + 3) / 2);
    for_each_in(space.window().owned_cells(), [&](const MultiIndex<dim>& c) {
      const int index = space.window().cell_index(c);
      if (flags[at(index)]) gauss_points<dim>(space.grid(), c, rule, gauss), f(index, gauss);
    });
  }
}

/// Calls f(basis, group, points of the cell, its Gauss points, fit) for the filled cells of a body.
template <int dim, class F>
void for_each_filled(const Space<dim>& space, const Body<dim>& body, std::size_t number, const Around& around,
                     F&& f) {
  const int bit = 1 << number;
  std::vector<char> filled(around.every.size());
  for (std::size_t c = 0; c < filled.size(); ++c) filled[c] = around.every[c] == bit && around.any[c] == bit;
  const PointsOfCells of_cells(body.points.cell, space.n_cells());
  std::visit(
      [&](const auto& basis, const auto& group) {
        if constexpr (!std::decay_t<decltype(basis)>::uses_domains) {
          Fit<dim> fit;
          for_each_cell<dim>(space, basis, filled, [&](int c, const std::vector<GaussPoint<dim>>& gauss) {
            const auto in_cell = of_cells.of(c);
            if (fit_stress<dim>(body.points, group, in_cell, gauss, fit))
              f(basis, group, in_cell, gauss, fit);
          });
        }
      },
      space.basis(), body.material);
}

}  // namespace

template <int dim>
void add_reconstruction(const Space<dim>& space, const std::vector<Body<dim>>& bodies,
                        const ActiveCells& cells, std::span<double> sums) {
  const Around around = bits_around(space, cells);
  const Vec<dim> none = Vec<dim>::Zero();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Particles<dim>& points = bodies[b].points;
    for_each_filled<dim>(
        space, bodies[b], b, around,
        [&](const auto& basis, const auto& group, auto in_cell, const auto& gauss, const Fit<dim>& fit) {
          for (const int q : in_cell) {
            const auto p = static_cast<std::size_t>(q);
            const Mat<dim> own = -points.volume[p] * matrix<dim>(group.old[p].stress);
            add_force<dim>(basis.tabulate(points.position[p], none), own, sums);
          }
          for (const auto& g : gauss)
            add_force<dim>(basis.tabulate(g.x, none), Mat<dim>(g.weight * fit.at(g.x)), sums);
        });
  }
}

template <int dim>
void smooth_gradients(const Space<dim>& space, const std::vector<Body<dim>>& bodies, std::size_t body,
                      const ActiveCells& cells, std::span<const double> velocity, std::size_t stride,
                      std::vector<double>& gradients) {
  constexpr int terms = Fit<dim>::terms;
  const Particles<dim>& points = bodies[body].points;
  gradients.assign(points.position.size() * dim * dim, std::numeric_limits<double>::quiet_NaN());
  const Vec<dim> none = Vec<dim>::Zero();
  for_each_filled<dim>(
      space, bodies[body], body, bits_around(space, cells),
      [&](const auto& basis, const auto&, auto in_cell, const auto& gauss, Fit<dim> fit) {
        Eigen::Matrix<double, terms, terms> normal = Eigen::Matrix<double, terms, terms>::Zero();
        Eigen::Matrix<double, terms, dim* dim> right = Eigen::Matrix<double, terms, dim * dim>::Zero();
        for (const auto& g : gauss) {
          Mat<dim> gradient = Mat<dim>::Zero();
          basis.tabulate(g.x, none).for_each([&](int, int i, double, const Vec<dim>& dphi) {
            for (int d = 0; d < dim; ++d)
              gradient.row(d) += velocity[at(i) * stride + at(d)] * dphi.transpose();
          });
          const auto t = fit.taylor(g.x);
          normal += g.weight * t * t.transpose();
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e) right.col(d * dim + e) += g.weight * gradient(d, e) * t;
        }
        const Eigen::Matrix<double, terms, dim* dim> coefficient = normal.ldlt().solve(right);
        for (const int q : in_cell) {
          const auto p = static_cast<std::size_t>(q);
          const Eigen::Matrix<double, 1, dim* dim> own =
              fit.taylor(points.position[p]).transpose() * coefficient;
          for (int k = 0; k < dim * dim; ++k) gradients[p * dim * dim + at(k)] = own[k];
        }
      });
}

template void smooth_gradients<2>(const Space<2>&, const std::vector<Body<2>>&, std::size_t,
                                  const ActiveCells&, std::span<const double>, std::size_t,
                                  std::vector<double>&);
template void smooth_gradients<3>(const Space<3>&, const std::vector<Body<3>>&, std::size_t,
                                  const ActiveCells&, std::span<const double>, std::size_t,
                                  std::vector<double>&);
template void add_reconstruction<2>(const Space<2>&, const std::vector<Body<2>>&, const ActiveCells&,
                                    std::span<double>);
template void add_reconstruction<3>(const Space<3>&, const std::vector<Body<3>>&, const ActiveCells&,
                                    std::span<double>);

}  // namespace wisp
