#include <algorithm>

#include "transfer/explicit_transfer.h"

namespace wisp {

namespace {

/// Half-lengths that bases without domains are given.
template <int dim>
inline const Vec<dim>* domain(const Particles<dim>& points) {
  return points.half_length.data();
}

template <int dim, Gather what, bool apic, class Basis, class State>
void add_points(const Basis basis, const Space<dim>& space, const Particles<dim>& points,
                const std::vector<State>& states, const Vec<dim> gravity, double* const sums) {
  constexpr int stride = sums_stride<dim>;
  const int n = points.size();
  const Vec<dim>* const position = points.position.data();
  const Vec<dim>* const half_length = domain(points);
  const Vec<dim>* const velocity = points.velocity.data();
  const double* const mass = points.mass.data();
  const double* const volume = points.volume.data();
  const Vec<dim> none = Vec<dim>::Zero();
  for (int p = 0; p < n; ++p) {
    const auto stencil = basis.tabulate(position[p], Basis::uses_domains ? half_length[p] : none);
    const double m = mass[p];
    const Vec<dim> mv = m * velocity[p];
    const Vec<dim> body_force = m * gravity;
    Mat<dim> tau_v;
    if constexpr (what != Gather::inertia)
      tau_v = volume[p] * matrix<dim>(states[static_cast<std::size_t>(p)].stress);
    stencil.for_each([&](int, int i, double phi, const Vec<dim>& dphi) {
      double* const s = sums + i * stride;
      if constexpr (what != Gather::force) {
        s[0] += phi * m;
        if constexpr (apic) {
          const Vec<dim> v =
              mv + m * (points.affine[static_cast<std::size_t>(p)] * (space.node_position(i) - position[p]));
          for (int d = 0; d < dim; ++d) s[1 + d] += phi * v[d];
        } else {
          for (int d = 0; d < dim; ++d) s[1 + d] += phi * mv[d];
        }
      }
      if constexpr (what != Gather::inertia) {
        const Vec<dim> f = phi * body_force - tau_v * dphi;
        for (int d = 0; d < dim; ++d) s[1 + dim + d] += f[d];
      }
    });
  }
}

template <int dim, Gather what, bool apic>
void add_body(const Space<dim>& space, const Body<dim>& body, const Vec<dim>& gravity, double* sums) {
  std::visit(
      [&](const auto& basis, const auto& material) {
        add_points<dim, what, apic>(basis, space, body.points, material.old, gravity, sums);
      },
      space.basis(), body.material);
}

}  // namespace

template <int dim>
void points_to_grid(const Space<dim>& space, const Body<dim>& body, Gather what, const Vec<dim>& gravity,
                    bool apic, std::span<double> sums) {
  double* const s = sums.data();
  if (what == Gather::force)
    add_body<dim, Gather::force, false>(space, body, gravity, s);
  else if (what == Gather::both)
    apic ? add_body<dim, Gather::both, true>(space, body, gravity, s)
         : add_body<dim, Gather::both, false>(space, body, gravity, s);
  else
    apic ? add_body<dim, Gather::inertia, true>(space, body, gravity, s)
         : add_body<dim, Gather::inertia, false>(space, body, gravity, s);
}

template void points_to_grid<2>(const Space<2>&, const Body<2>&, Gather, const Vec<2>&, bool,
                                std::span<double>);
template void points_to_grid<3>(const Space<3>&, const Body<3>&, Gather, const Vec<3>&, bool,
                                std::span<double>);

}  // namespace wisp
