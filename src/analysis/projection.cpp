#include "analysis/projection.h"

#include <cmath>

#include "basis/bspline.h"
#include "basis/lagrange_quadratic.h"
#include "basis/linear_triangle.h"
#include "grid/quadrature.h"

namespace wisp {

namespace {

/// Calls f(stencil, x, weight) at the Gauss points of a structured grid, cell by cell.
template <int dim, class Basis, class F>
void on_cells(const Basis& basis, int points, F&& f) {
  const auto& grid = basis.grid();
  const IntervalRule rule = gauss_legendre(points);
  const MultiIndex<dim> none = MultiIndex<dim>::Zero(), per_cell = MultiIndex<dim>::Constant(points);
  for_each_in<dim>({none, grid.cells()}, [&](const MultiIndex<dim>& cell) {
    for_each_in<dim>({none, per_cell}, [&](const MultiIndex<dim>& q) {
      Vec<dim> x;
      double weight = 1.0;
      for (int d = 0; d < dim; ++d) {
        const double h = grid.spacing(d, cell[d]);
        x[d] = grid.line(d, cell[d]) + h * rule.place[static_cast<std::size_t>(q[d])];
        weight *= h * rule.weight[static_cast<std::size_t>(q[d])];
      }
      f(basis.tabulate(x, Vec<dim>::Zero()), x, weight);
    });
  });
}

/// The same on the triangles of a basis that is smooth inside them.
template <class Basis, class F>
void on_triangles(const Basis& basis, int points, F&& f) {
  const auto& mesh = basis.triangulation();
  const TriangleRule rule = triangle_rule(points);
  for (int t = 0; t < mesh.n_triangles(); ++t)
    for (std::size_t q = 0; q < rule.place.size(); ++q) {
      const Vec<2> x = mesh.point(t, rule.place[q]);
      f(basis.tabulate_in(t, x), x, mesh.area(t) * rule.weight[q]);
    }
}

/// The same on sub-triangles.
template <class Basis, class F>
void on_sub_triangles(const Basis& basis, int points, F&& f) {
  const auto& mesh = basis.triangulation();
  const auto& split = basis.split();
  const TriangleRule rule = triangle_rule(points);
  for (int t = 0; t < mesh.n_triangles(); ++t)
    for (int k = 0; k < 3; ++k)
      for (int side = 0; side < 2; ++side) {
        const Vec<2>& v = mesh.corner(t, (k + side) % 3);
        const Vec<2> r = split.edge_point(mesh.edge(t, k)), z = split.centre(t);
        const double area = 0.5 * std::abs((r - v)[0] * (z - v)[1] - (r - v)[1] * (z - v)[0]);
        for (std::size_t q = 0; q < rule.place.size(); ++q) {
          const auto& b = rule.place[q];
          f(basis.tabulate_at(t, {k, side, b}), Vec<2>(b[0] * v + b[1] * r + b[2] * z),
            area * rule.weight[q]);
        }
      }
}

template <class Basis, class F>
void at_gauss_points(const Basis& basis, int points, F&& f) {
  if constexpr (requires { basis.split(); })
    on_sub_triangles(basis, points, f);
  else if constexpr (requires { basis.triangulation(); })
    on_triangles(basis, points, f);
  else
    on_cells<Basis::dimension>(basis, points, f);
}

/// The numbers that are prescribed, and those that replace three coefficients by one.
class Substitution {
 public:
  Substitution(const SplineConditions& conditions, int n)
      : constant_(static_cast<std::size_t>(n), 0.0),
        fixed_(static_cast<std::size_t>(n), 0),
        condition_(static_cast<std::size_t>(n), -1),
        conditions_(conditions) {
    for (const auto& f : conditions.fixed)
      constant_[static_cast<std::size_t>(f.function)] = f.value,
      fixed_[static_cast<std::size_t>(f.function)] = 1;
    for (std::size_t c = 0; c < conditions.vertices.size(); ++c)
      for (std::size_t q = 0; q < 3; ++q) {
        const auto i = static_cast<std::size_t>(conditions.vertices[c].function[q]);
        constant_[i] = conditions.vertices[c].constant[q];
        condition_[i] = static_cast<int>(c);
        if (q > 0) fixed_[i] = 1;  // the first carries the free number
      }
  }

  const std::vector<char>& fixed() const { return fixed_; }

  /// Element matrix (n x n, row-major) and vector in the free numbers.
  void apply(std::span<const int> functions, std::vector<double>& m, std::vector<double>& b) const {
    const std::size_t n = functions.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        b[i] -= m[i * n + j] * constant_[static_cast<std::size_t>(functions[j])];
    for (std::size_t i = 0; i < n; ++i) {
      const int c = condition_[static_cast<std::size_t>(functions[i])];
      if (c < 0 || conditions_.vertices[static_cast<std::size_t>(c)].function[0] != functions[i]) continue;
      const auto& condition = conditions_.vertices[static_cast<std::size_t>(c)];
      std::array<std::size_t, 3> at{};
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t q = 0; q < 3; ++q)
          if (functions[j] == condition.function[q]) at[q] = j;
      const auto combine = [&](auto&& entry) {
        double sum = 0.0;
        for (std::size_t q = 0; q < 3; ++q) sum += condition.slope[q] * entry(at[q]);
        for (std::size_t q = 0; q < 3; ++q) entry(at[q]) = q == 0 ? sum : 0.0;
      };
      combine([&](std::size_t k) -> double& { return b[k]; });
      for (std::size_t j = 0; j < n; ++j) combine([&](std::size_t k) -> double& { return m[k * n + j]; });
      for (std::size_t j = 0; j < n; ++j) combine([&](std::size_t k) -> double& { return m[j * n + k]; });
    }
  }

  /// The coefficients that belong to the free numbers.
  void expand(std::vector<double>& numbers) const {
    for (const auto& condition : conditions_.vertices) {
      const double y = numbers[static_cast<std::size_t>(condition.function[0])];
      for (std::size_t q = 0; q < 3; ++q)
        numbers[static_cast<std::size_t>(condition.function[q])] = y * condition.slope[q];
    }
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] += constant_[i];
  }

 private:
  std::vector<double> constant_;
  std::vector<char> fixed_;
  std::vector<int> condition_;
  const SplineConditions& conditions_;
};

/// One cell's functions with their matrix and vector.
struct Element {
  std::vector<int> functions;
  std::vector<double> matrix, vector;
};

template <class Basis>
std::vector<Element> elements(const Basis& basis, const ScalarField<Basis::dimension>& f,
                              const FieldProblem& problem) {
  constexpr int dim = Basis::dimension;
  constexpr std::size_t n = Basis::Stencil::max_functions;
  std::vector<Element> all;
  int key = -1;
  at_gauss_points(basis, problem.points, [&](const auto& stencil, const Vec<dim>& x, double weight) {
    if (stencil.key() != key) {
      key = stencil.key();
      all.push_back({std::vector<int>(n), std::vector<double>(n * n, 0.0), std::vector<double>(n, 0.0)});
    }
    Element& element = all.back();
    std::array<double, n> phi;
    std::array<Vec<dim>, n> dphi;
    stencil.for_each([&](int k, int i, double value, const Vec<dim>& gradient) {
      const auto a = static_cast<std::size_t>(k);
      element.functions[a] = i, phi[a] = value, dphi[a] = gradient;
    });
    const double source = weight * f(x);
    for (std::size_t i = 0; i < n; ++i) {
      element.vector[i] += source * phi[i];
      for (std::size_t j = 0; j < n; ++j)
        element.matrix[i * n + j] +=
            weight * (problem.mass * phi[i] * phi[j] + problem.stiffness * dphi[i].dot(dphi[j]));
    }
  });
  return all;
}

}  // namespace

template <class Basis>
std::vector<double> solve_field(const Basis& basis, const ScalarField<Basis::dimension>& f,
                                const FieldProblem& problem) {
  const int n = basis.n_functions();
  const Substitution substitution(problem.conditions, n);
  auto all = elements(basis, f, problem);
  BlockMatrix matrix;
  matrix.begin_pattern(n);
  for (const auto& e : all) matrix.add_element(e.functions);
  matrix.end_pattern();
  std::vector<double> rhs(static_cast<std::size_t>(n), 0.0), solution(static_cast<std::size_t>(n), 0.0);
  for (auto& e : all) {
    substitution.apply(e.functions, e.matrix, e.vector);
    matrix.add(e.functions, e.matrix.data());
    for (std::size_t i = 0; i < e.functions.size(); ++i)
      rhs[static_cast<std::size_t>(e.functions[i])] += e.vector[i];
  }
  const Halo halo(n);
  const DofMap dofs(halo, 1, std::vector<char>(static_cast<std::size_t>(n), 1), substitution.fixed());
  SystemMatrix system;
  system.assign(matrix, dofs);
  SolverOptions options;
  options.solver = SolverKind::direct;
  MatrixTraits traits;
  traits.symmetric = true;
  LinearSolver solver(options, traits);
  const auto report = solver.solve(system, dofs, halo, rhs, solution);
  if (!report.solved) run_error("the projection's system cannot be solved: {}", report.cause);
  substitution.expand(solution);
  return solution;
}

template <class Basis>
FieldError field_error(const Basis& basis, const std::vector<double>& coefficients,
                       const ScalarField<Basis::dimension>& f, int points) {
  constexpr int dim = Basis::dimension;
  FieldError error;
  double square = 0.0;
  at_gauss_points(basis, points, [&](const auto& stencil, const Vec<dim>& x, double weight) {
    double difference = -f(x);
    stencil.for_each([&](int, int i, double phi, const Vec<dim>&) {
      difference += phi * coefficients[static_cast<std::size_t>(i)];
    });
    square += weight * difference * difference;
    error.largest = std::max(error.largest, std::abs(difference));
  });
  error.l2 = std::sqrt(square);
  return error;
}

#define WISP_PROJECTION(...)                                                                               \
  template std::vector<double> solve_field(const __VA_ARGS__&, const ScalarField<__VA_ARGS__::dimension>&, \
                                           const FieldProblem&);                                           \
  template FieldError field_error(const __VA_ARGS__&, const std::vector<double>&,                          \
                                  const ScalarField<__VA_ARGS__::dimension>&, int);
using Plane1 = BSpline<2, 1>;
using Plane2 = BSpline<2, 2>;
using Plane3 = BSpline<2, 3>;
using Plane4 = BSpline<2, 4>;
using Space2 = BSpline<3, 2>;
using Space3 = BSpline<3, 3>;
WISP_PROJECTION(LinearTriangle)
WISP_PROJECTION(LagrangeQuadratic)
WISP_PROJECTION(PowellSabinQuadratic)
WISP_PROJECTION(PowellSabinCubic)
WISP_PROJECTION(Plane1)
WISP_PROJECTION(Plane2)
WISP_PROJECTION(Plane3)
WISP_PROJECTION(Plane4)
WISP_PROJECTION(Space2)
WISP_PROJECTION(Space3)
#undef WISP_PROJECTION

}  // namespace wisp
