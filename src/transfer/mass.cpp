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
        std::vector<char> seen(static_cast<std::size_t>(space.n_keys()), 0);
        std::vector<int> functions;
        for (const auto& body : bodies)
          for_each_stencil<dim>(basis, body.points, [&](std::size_t, const auto& stencil) {
            char& flag = seen[static_cast<std::size_t>(stencil.key())];
            if (flag) return;
            flag = 1;
            functions.resize(static_cast<std::size_t>(stencil.size()));
            stencil.for_each(
                [&](int k, int i, double, const Vec<dim>&) { functions[static_cast<std::size_t>(k)] = i; });
            matrix.add_element(functions);
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
            double* const dense = blocks.find(
                stencil.key(),
                [&](int* functions) {
                  stencil.for_each([&](int k, int i, double, const Vec<dim>&) { functions[k] = i; });
                },
                flush);
            double phi[n];
            stencil.for_each([&](int k, int, double value, const Vec<dim>&) { phi[k] = value; });
            const double m = body.points.mass[p];
            for (int i = 0; i < n; ++i) {
              const double row = m * phi[i];
              double* const out = dense + i * n;
              for (int j = 0; j < n; ++j) out[j] += row * phi[j];
            }
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
