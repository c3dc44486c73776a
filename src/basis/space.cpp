#include "basis/space.h"

#include "core/error.h"

namespace wisp {

template <int dim>
int Space<dim>::degree_of(const AnyBasisOptions& options) {
  constexpr int highest = highest_spline_degree(dim);
  if (const auto* splines = std::get_if<BSplineOptions>(&options)) {
    if (splines->degree > highest)
      input_error(
          "basis 'b-spline': degree {} is not built in {}D, where the highest is {}; configure with "
          "-DWISP_SPLINE_DEGREE_{}D={} for more",
          splines->degree, dim, highest, dim, splines->degree);
    return splines->degree;
  }
  if (!std::holds_alternative<LinearOptions>(options) && !std::holds_alternative<GimpOptions>(options))
    input_error("basis '{}' needs a triangulation; structured grids have linear, gimp and b-spline",
                std::visit([](const auto& o) { return o.name; }, options));
  return 1;
}

template <int dim>
void Space<dim>::make_splines() {
  const NodeNumbering<dim> numbering(*window_);
  const auto make = [&]<int... more>(std::integer_sequence<int, more...>) {
    ((degree_ == 2 + more ? (void)(basis_ = BSpline<dim, 2 + more>(*grid_, numbering)) : void()), ...);
  };
  make(std::make_integer_sequence<int, highest_spline_degree(dim) - 1>());
}

template int Space<2>::degree_of(const AnyBasisOptions&);
template int Space<3>::degree_of(const AnyBasisOptions&);
template void Space<2>::make_splines();
template void Space<3>::make_splines();

template <>
Space<2>::Space(std::shared_ptr<const Triangulation> triangulation, const AnyBasisOptions& options)
    : triangulation_(std::move(triangulation)),
      cells_(triangulation_->n_triangles()),
      basis_(OnTriangles(std::make_shared<const LinearTriangle>(*triangulation_))) {
  const Triangulation& mesh = *triangulation_;
  if (std::holds_alternative<GimpOptions>(options))
    input_error(
        "basis 'gimp' needs a structured grid; triangulations have linear, lagrange-quadratic, "
        "powell-sabin and powell-sabin-cubic");
  if (std::holds_alternative<BSplineOptions>(options))
    input_error(
        "basis 'b-spline' needs a structured grid; the smooth bases of triangulations are powell-sabin and "
        "powell-sabin-cubic");
  if (std::holds_alternative<LagrangeQuadraticOptions>(options))
    basis_ = OnTriangles(std::make_shared<const LagrangeQuadratic>(mesh));
  else if (const auto* quadratic = std::get_if<PowellSabinOptions>(&options))
    basis_ = OnTriangles(std::make_shared<const PowellSabinQuadratic>(
        mesh, ControlTriangleOptions{quadratic->control_triangles}));
  else if (const auto* cubic = std::get_if<PowellSabinCubicOptions>(&options))
    basis_ = OnTriangles(
        std::make_shared<const PowellSabinCubic>(mesh, ControlTriangleOptions{cubic->control_triangles}));
  nodes_ = Halo(visit_on_triangles(*this, [](const auto& b) { return b.n_functions(); }));
}

}  // namespace wisp
