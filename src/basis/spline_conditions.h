// Essential conditions on splines: what a prescribed value on boundary edges asks of the coefficients.
#pragma once
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "basis/powell_sabin_cubic.h"
#include "basis/powell_sabin_quadratic.h"

namespace wisp {

/// The prescribed field at a point of a boundary edge: value, and gradient of which only the part along the
/// edge matters.
using BoundaryField = std::function<ValueAndGradient(int edge, const Vec<2>& x)>;

/// Coefficient `function` is `value`.
struct FixedCoefficient {
  int function = 0;
  double value = 0.0;
};

/// Two equations among the three functions of a vertex, solved: coefficient q is constant[q] + y slope[q]
/// with the one free number y. `slope` has length 1.
struct VertexCondition {
  std::array<int, 3> function{};
  std::array<double, 3> constant{};
  std::array<double, 3> slope{};
};

struct SplineConditions {
  std::vector<FixedCoefficient> fixed;
  std::vector<VertexCondition> vertices;
};

/// Conditions that make a spline take a field on boundary edges: its value and its derivative along the edge
/// at each vertex (de Koster 2018, eq. 3.63, 3.64), for cubics a third number a half edge. Between them it
/// follows to the order of the splines; zero is taken exactly.
///
/// Where a side of the control triangle lies on the edge, the two functions on it take the condition and the
/// third has no part in it (de Koster 2018, section 3.5.4): two coefficients are fixed. Elsewhere, or with
/// `by_control_points` false, one number of the three stays free. At a corner between two of the edges,
/// convex or not, sharp or blunt, value and gradient are known from both, so all three coefficients are
/// fixed.
///
/// Errors (InputError): an edge that is not on the boundary.
template <class Spline>
SplineConditions spline_conditions(const Spline& basis, std::span<const int> edges,
                                   const BoundaryField& field, bool by_control_points = true);

extern template SplineConditions spline_conditions(const PowellSabinQuadratic&, std::span<const int>,
                                                   const BoundaryField&, bool);
extern template SplineConditions spline_conditions(const PowellSabinCubic&, std::span<const int>,
                                                   const BoundaryField&, bool);

}  // namespace wisp
