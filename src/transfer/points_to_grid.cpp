#include <algorithm>

#include "transfer/explicit_transfer.h"

namespace wisp {

namespace {

/// The record of a point: mass, momentum, force. Not returned: how depends on the registers of the machine.
template <int dim>
inline void set_record(Record<sums_stride<dim>>& r, double mass, const double* momentum,
                       const double* force) {
  if constexpr (dim == 2)
    r = Record<sums_stride<dim>>{mass, momentum[0], momentum[1], force[0], force[1], 0.0, 0.0, 0.0};
  else
    r = Record<sums_stride<dim>>{mass,     momentum[0], momentum[1], momentum[2],
                                 force[0], force[1],    force[2],    0.0};
}

/// dF = I + dt sum_i v_i (x) grad phi_i of a motion that the stress has followed.
template <int dim, class Stencil>
Mat<dim> followed_increment(const Stencil& stencil, const FollowedMotion& followed) {
  Mat<dim> dF = Mat<dim>::Identity();
  stencil.for_each([&](int, int i, double, const Vec<dim>& dphi) {
    const double* const v = followed.velocity.data() + i * dim;
    for (int d = 0; d < dim; ++d)
      for (int e = 0; e < dim; ++e) dF(d, e) += followed.dt * v[d] * dphi[e];
  });
  return dF;
}

/// One pass over the points, every point's numbers spread over its functions as records.
template <int dim, Gather what, bool apic, bool follow, class Basis, class State>
__attribute__((flatten)) void add_points(const Basis& basis, const Space<dim>& space,
                                         const Particles<dim>& points, const std::vector<State>& states,
                                         const Vec<dim> gravity, double* const sums,
                                         const FollowedMotion followed) {
  constexpr bool inertia = what != Gather::force, forces = what != Gather::inertia;
  const int n = points.size();
  const Vec<dim>* const position = points.position.data();
  const Vec<dim>* const half_length = points.half_length.data();  // empty where the basis has no domains
  const Vec<dim>* const velocity = points.velocity.data();
  const double* const mass = points.mass.data();
  const double* const volume = points.volume.data();
  const State* const state = states.data();
  const Vec<dim> none = Vec<dim>::Zero();
  constexpr double zero[dim] = {};
  auto tabulated = walk(basis);
  RecordSums<dim, sums_stride<dim>, typename Basis::Stencil> add(sums);
  for (int p = 0; p < n; ++p) {
    const auto stencil = tabulated.tabulate(position[p], Basis::uses_domains ? half_length[p] : none);
    const double m = mass[p];
    double momentum[dim] = {}, weight[dim] = {};
    for_short<dim>([&](int d) {
      if constexpr (inertia && !apic) momentum[d] = m * velocity[p][d];
      if constexpr (forces) weight[d] = m * gravity[d];
    });
    RecordAndGradient<dim, sums_stride<dim>> r;
    set_record<dim>(r.value, inertia ? m : 0.0, momentum, weight);
    if constexpr (forces) {
      const double minus_volume = -volume[p];
      const Sym<dim>& tau = state[p].stress;
      Mat<dim> pulled;  // tau dF^-T
      if constexpr (follow)
        pulled = matrix<dim>(tau) * followed_increment<dim>(stencil, followed).inverse().transpose();
      for_short<dim>([&](int e) {
        double force[dim];
        for_short<dim>(
            [&](int d) { force[d] = minus_volume * (follow ? pulled(d, e) : tau[component<dim>(d, e)]); });
        set_record<dim>(r.gradient[e], 0.0, zero, force);
      });
    }
    add.template add<forces>(stencil, r);
    if constexpr (apic && inertia) {
      const Mat<dim>& affine = points.affine[static_cast<std::size_t>(p)];
      stencil.for_each([&](int, int i, double phi, const Vec<dim>&) {
        const Vec<dim> v = velocity[p] + affine * (space.node_position(i) - position[p]);
        for (int d = 0; d < dim; ++d) sums[i * sums_stride<dim> + 1 + d] += phi * m * v[d];
      });
    }
  }
  add.finish();
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
