// The bases. A new one is one file and one word here.
#pragma once
#include <variant>

#include "basis/bspline.h"
#include "basis/gimp.h"
#include "basis/lagrange_quadratic.h"
#include "basis/linear.h"
#include "basis/linear_triangle.h"
#include "basis/on_triangles.h"
#include "basis/powell_sabin_cubic.h"
#include "basis/powell_sabin_quadratic.h"

namespace wisp {

template <int dim>
struct BasisList {
  using Type = std::variant<Linear<dim>, Gimp<dim, 3>, Gimp<dim, 5>, BSpline<dim, 2>, BSpline<dim, 3>>;
};
template <>
struct BasisList<2> {
  using Type = std::variant<Linear<2>, Gimp<2, 3>, Gimp<2, 5>, BSpline<2, 2>, BSpline<2, 3>, BSpline<2, 4>,
                            OnTriangles<LinearTriangle>, OnTriangles<LagrangeQuadratic>,
                            OnTriangles<PowellSabinQuadratic>, OnTriangles<PowellSabinCubic>>;
};

/// The basis of a run in the form its kernels need; visited once per loop over points.
template <int dim>
using AnyBasis = typename BasisList<dim>::Type;

}  // namespace wisp
