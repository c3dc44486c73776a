// Best approximation of a function in the space of a basis, with its error.
#pragma once
#include <functional>
#include <vector>

#include "basis/spline_conditions.h"
#include "linear/solver.h"
#include "tensor/tensor.h"

namespace wisp {

template <int dim>
using ScalarField = std::function<double(const Vec<dim>&)>;

/// Find u in the space of a basis with integral of (mass u w + stiffness grad u . grad w) = integral of f w
/// for all w there: the L2 projection of f (de Koster 2018, eq. 3.67), or Poisson's problem.
struct FieldProblem {
  double mass = 1.0;
  double stiffness = 0.0;
  int points = 6;  ///< Gauss points a direction on each cell, triangle or sub-triangle
  SplineConditions conditions{};
};

/// Coefficients of the functions of the basis. Errors (RunError): the system is singular.
template <class Basis>
std::vector<double> solve_field(const Basis& basis, const ScalarField<Basis::dimension>& f,
                                const FieldProblem& problem = {});

/// Norms of u - f over the grid.
struct FieldError {
  double l2 = 0.0;       ///< square root of the integral of the square
  double largest = 0.0;  ///< over the quadrature points
};
template <class Basis>
FieldError field_error(const Basis& basis, const std::vector<double>& coefficients,
                       const ScalarField<Basis::dimension>& f, int points = 6);

/// Value of the field at a point of the grid.
template <class Basis>
double field_value(const Basis& basis, const std::vector<double>& coefficients,
                   const Vec<Basis::dimension>& x) {
  double value = 0.0;
  const auto add = [&](int, int i, double phi, const Vec<Basis::dimension>&) {
    value += phi * coefficients[static_cast<std::size_t>(i)];
  };
  if constexpr (requires { basis.triangulation(); })
    basis.tabulate(x, -1).for_each(add);
  else
    basis.tabulate(x, Vec<Basis::dimension>::Zero()).for_each(add);
  return value;
}

}  // namespace wisp
