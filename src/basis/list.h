// The bases. A new one is one file and one word here.
#pragma once
#include <utility>
#include <variant>

#include "basis/bspline.h"
#include "basis/gimp.h"
#include "basis/lagrange_quadratic.h"
#include "basis/linear.h"
#include "basis/linear_triangle.h"
#include "basis/on_triangles.h"
#include "basis/options.h"
#include "basis/powell_sabin_cubic.h"
#include "basis/powell_sabin_quadratic.h"

namespace wisp {

/// Bases of structured grids: those of nodes, then B-splines of degree 2 up to the highest built.
template <int dim, int... more>
std::variant<Linear<dim>, Gimp<dim, 3>, Gimp<dim, 5>, BSpline<dim, 2 + more>...> structured_bases(
    std::integer_sequence<int, more...>);
template <class Structured, class... Unstructured>
struct JoinBases;
template <class... Structured, class... Unstructured>
struct JoinBases<std::variant<Structured...>, Unstructured...> {
  using Type = std::variant<Structured..., Unstructured...>;
};
template <int dim>
using StructuredBases =
    decltype(structured_bases<dim>(std::make_integer_sequence<int, highest_spline_degree(dim) - 1>()));

template <int dim>
struct BasisList {
  using Type = StructuredBases<dim>;
};
template <>
struct BasisList<2> {
  using Type =
      typename JoinBases<StructuredBases<2>, OnTriangles<LinearTriangle>, OnTriangles<LagrangeQuadratic>,
                         OnTriangles<PowellSabinQuadratic>, OnTriangles<PowellSabinCubic>>::Type;
};

/// The basis of a run in the form its kernels need; visited once per loop over points.
template <int dim>
using AnyBasis = typename BasisList<dim>::Type;

}  // namespace wisp
