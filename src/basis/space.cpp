#include "basis/space.h"

#include "core/error.h"

namespace wisp {

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
