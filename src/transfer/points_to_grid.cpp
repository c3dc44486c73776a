#include <algorithm>

#include "transfer/explicit_transfer.h"

namespace wisp {

namespace {

/// One pass over the points, every point's numbers spread over its functions as records.
template <int dim, Gather what, bool apic, bool follow, class Basis, class State>
__attribute__((flatten)) void add_points(const Basis basis, const Space<dim>& space,
                                         const Particles<dim>& points, const std::vector<State>& states,
                                         const Vec<dim> gravity, double* const sums,
                                         const FollowedMotion followed) {
  constexpr int stride = sums_stride<dim>;
  const int n = points.size();
  const Vec<dim>* const position = points.position.data();
  const Vec<dim>* const half_length = points.half_length.data();  // empty where the basis has no domains
  const Vec<dim>* const velocity = points.velocity.data();
  const double* const mass = points.mass.data();
  const double* const volume = points.volume.data();
  const State* const state = states.data();
  const Vec<dim> none = Vec<dim>::Zero();
  for (int p = 0; p < n; ++p) {
    const auto stencil = basis.tabulate(position[p], Basis::uses_domains ? half_length[p] : none);
    const double m = mass[p];
    RecordAndGradient<dim, stride> r;
    if constexpr (what != Gather::force) {
      r.value[0] = m;
      if constexpr (!apic)
        for (int d = 0; d < dim; ++d) r.value[1 + d] = m * velocity[p][d];
    }
    if constexpr (what != Gather::inertia) {
      Mat<dim> tau = matrix<dim>(state[p].stress);
      if constexpr (follow) {
        Mat<dim> dF = Mat<dim>::Identity();
        stencil.for_each([&](int, int i, double, const Vec<dim>& dphi) {
          const double* const v = followed.velocity.data() + i * dim;
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e) dF(d, e) += followed.dt * v[d] * dphi[e];
        });
        tau = (tau * dF.inverse().transpose()).eval();
      }
      for (int d = 0; d < dim; ++d) {
        r.value[1 + dim + d] = m * gravity[d];
        for (int e = 0; e < dim; ++e) r.gradient[e][1 + dim + d] = -volume[p] * tau(d, e);
      }
    }
    add_to_functions<dim, stride>(stencil, r, sums);
    if constexpr (apic && what != Gather::force) {
      const Mat<dim>& affine = points.affine[static_cast<std::size_t>(p)];
      stencil.for_each([&](int, int i, double phi, const Vec<dim>&) {
        const Vec<dim> v = velocity[p] + affine * (space.node_position(i) - position[p]);
        for (int d = 0; d < dim; ++d) sums[i * stride + 1 + d] += phi * m * v[d];
      });
    }
  }
}

template <int dim, Gather what, bool apic, bool follow = false>
void add_body(const Space<dim>& space, const Body<dim>& body, const Vec<dim>& gravity, double* sums,
              const FollowedMotion& followed = {}) {
  std::visit(
      [&](const auto& basis, const auto& material) {
        add_points<dim, what, apic, follow>(basis, space, body.points, material.old, gravity, sums, followed);
      },
      space.basis(), body.material);
}

}  // namespace

template <int dim>
void points_to_grid(const Space<dim>& space, const Body<dim>& body, Gather what, const Vec<dim>& gravity,
                    bool apic, std::span<double> sums, const FollowedMotion& followed) {
  double* const s = sums.data();
  if (what == Gather::both && !followed.velocity.empty() && body.finite_strain())
    apic ? add_body<dim, Gather::both, true, true>(space, body, gravity, s, followed)
         : add_body<dim, Gather::both, false, true>(space, body, gravity, s, followed);
  else if (what == Gather::force)
    add_body<dim, Gather::force, false>(space, body, gravity, s);
  else if (what == Gather::both)
    apic ? add_body<dim, Gather::both, true>(space, body, gravity, s)
         : add_body<dim, Gather::both, false>(space, body, gravity, s);
  else
    apic ? add_body<dim, Gather::inertia, true>(space, body, gravity, s)
         : add_body<dim, Gather::inertia, false>(space, body, gravity, s);
}

template void points_to_grid<2>(const Space<2>&, const Body<2>&, Gather, const Vec<2>&, bool,
                                std::span<double>, const FollowedMotion&);
template void points_to_grid<3>(const Space<3>&, const Body<3>&, Gather, const Vec<3>&, bool,
                                std::span<double>, const FollowedMotion&);

}  // namespace wisp
