#include "transfer/mass.h"

#include "transfer/stencil_blocks.h"

namespace wisp {

namespace {

/// Calls f(p, stencil) for every point of a body.
template <int dim, class Basis, class F>
void for_each_stencil(const Basis& basis, const Particles<dim>& points, F&& f) {
  const Vec<dim> none = Vec<dim>::Zero();
  for (std::size_t p = 0; p < points.position.size(); ++p)
    f(p, basis.tabulate(points.position[p], Basis::uses_domains ? points.half_length[p] : none));
}

}  // namespace

template <int dim>
void add_point_pattern(const Space<dim>& space, const std::vector<Body<dim>>& bodies, BlockMatrix& matrix) {
  std::visit(
      [&](const auto& basis) {
        StencilSets sets(space.n_keys());
        for (const auto& body : bodies)
          for_each_stencil<dim>(basis, body.points, [&](std::size_t, const auto& stencil) {
            sets.add(stencil, [&](const auto& functions) { matrix.add_element(functions); });
          });
      },
      space.basis());
}

template <int dim>
void add_consistent_mass(const Space<dim>& space, const std::vector<Body<dim>>& bodies, BlockMatrix& mass) {
  std::visit(
      [&](const auto& basis) {
        constexpr int n = std::decay_t<decltype(basis)>::Stencil::max_functions;
        StencilBlocks blocks(n, 1);
        const auto flush = [&](std::span<const int> functions, const double* dense) {
          mass.add_scalar(functions, dense);
        };
        for (const auto& body : bodies)
          for_each_stencil<dim>(basis, body.points, [&](std::size_t p, const auto& stencil) {
            add_products(blocks, stencil, body.points.mass[p], flush);
          });
        blocks.finish(flush);
      },
      space.basis());
}

template void add_point_pattern<2>(const Space<2>&, const std::vector<Body<2>>&, BlockMatrix&);
template void add_point_pattern<3>(const Space<3>&, const std::vector<Body<3>>&, BlockMatrix&);
template void add_consistent_mass<2>(const Space<2>&, const std::vector<Body<2>>&, BlockMatrix&);
template void add_consistent_mass<3>(const Space<3>&, const std::vector<Body<3>>&, BlockMatrix&);

}  // namespace wisp
