#include "tensor/spectral.h"
#include "transfer/explicit_transfer.h"

namespace wisp {

namespace {

/// C of the affine field v + C (x - x_p) that reproduces linear fields: B D^-1 with B = sum phi v (x_i -
/// x_p)^T and D = sum phi (x_i - x_p)(x_i - x_p)^T (Jiang et al. 2015, eq. 8-10). For linear functions that
/// is the velocity gradient, also where D is singular.
template <int dim, class Basis, class Stencil>
Mat<dim> affine_field(const Space<dim>& space, const Stencil& stencil, const Vec<dim>& x,
                      const double* motion) {
  Mat<dim> b = Mat<dim>::Zero(), d = Mat<dim>::Zero();
  stencil.for_each([&](int, int i, double phi, const Vec<dim>& dphi) {
    const Eigen::Map<const Vec<dim>> v(motion + i * motion_stride<dim>);
    if constexpr (Basis::uses_domains) {
      const Vec<dim> r = space.node_position(i) - x;
      b += phi * v * r.transpose();
      d += phi * r * r.transpose();
    } else {
      b += v * dphi.transpose();
    }
  });
  if constexpr (Basis::uses_domains) return b * d.inverse();
  return b;
}

/// Deformation gradient and stress of a point by the velocity gradient of a step.
template <int dim, class Law, class State>
inline __attribute__((always_inline)) void strain_point(const Law& law, State& state,
                                                        const double (&gradient)[dim][dim], double dt,
                                                        Mat<dim>& F) {
  Kinematics<dim> kinematics;
  kinematics.dt = dt;
  double now[dim][dim];
  for_short<dim>([&](int i) {
    for_short<dim>([&](int j) { kinematics.dF(i, j) = (i == j ? 1.0 : 0.0) + dt * gradient[i][j]; });
  });
  for_short<dim>([&](int i) {
    for_short<dim>([&](int j) {
      now[i][j] = kinematics.dF(i, 0) * F(0, j);
      for_short<dim - 1>([&](int k) { now[i][j] += kinematics.dF(i, k + 1) * F(k + 1, j); });
    });
  });
  for_short<dim>([&](int i) { for_short<dim>([&](int j) { F(i, j) = now[i][j]; }); });
  law.template stress<dim>(kinematics, state, state);
}

/// One pass over the points. `strain_from_motion`: strains use the velocity of `motion`, gathered once for
/// all. Small tensors are handled number by number: what is written in several pieces and read in one makes
/// the machine wait.
template <int dim, bool with_velocity, bool with_move, bool with_strain, bool strain_from_motion, class Basis,
          class Group>
__attribute__((flatten)) void update_points(const Basis& basis, const Space<dim>& space,
                                            Particles<dim>& points, Group& group, const PointUpdate& update) {
  using Law = std::decay_t<decltype(group.law)>;
  constexpr bool gather_motion = with_velocity || with_move || (with_strain && strain_from_motion);
  const Law law = group.law;  // a copy: the compiler then knows that no point changes it
  const double* const motion = update.motion.data();
  const double* const strain_velocity = update.strain_velocity.data();
  const double dt = update.dt, flip = update.flip, pic = 1.0 - update.flip;
  const bool apic = update.apic, domains = update.domains;
  const int n = points.size();
  const Vec<dim> none = Vec<dim>::Zero();
  Vec<dim>* const position = points.position.data();
  Vec<dim>* const displacement = points.displacement.data();
  Vec<dim>* const velocity = points.velocity.data();
  Vec<dim>* const half_length = points.half_length.data();
  Mat<dim>* const deformation_gradient = points.deformation_gradient.data();
  auto tabulated = walk(basis);
  for (int p = 0; p < n; ++p) {
    const auto stencil = tabulated.tabulate(position[p], Basis::uses_domains ? half_length[p] : none);
    double v[dim] = {}, a[dim] = {}, gradient[dim][dim] = {};
    if constexpr (gather_motion) {
      constexpr bool strain = with_strain && strain_from_motion;
      const auto sum = sum_of_functions<dim, motion_stride<dim>, strain>(stencil, motion);
      for_short<dim>([&](int d) {
        v[d] = sum.value[d], a[d] = sum.value[dim + d];
        if constexpr (strain) for_short<dim>([&](int e) { gradient[d][e] = sum.gradient[e][d]; });
      });
    }
    if constexpr (with_strain && !strain_from_motion) {
      stencil.for_each([&](int, int i, double, const Vec<dim>& dphi) {
        const double* const u = strain_velocity + i * dim;
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e) gradient[d][e] += u[d] * dphi[e];
      });
    }
    if constexpr (with_velocity) {
      if (apic)
        points.affine[static_cast<std::size_t>(p)] =
            affine_field<dim, Basis>(space, stencil, position[p], motion);
      for_short<dim>([&](int d) { velocity[p][d] = flip * (velocity[p][d] + dt * a[d]) + pic * v[d]; });
    }
    if constexpr (with_move) {
      for_short<dim>([&](int d) {
        const double u = dt * v[d];
        position[p][d] += u;
        displacement[p][d] += u;
      });
    }
    if constexpr (with_strain) {
      Mat<dim>& F = deformation_gradient[p];
      strain_point<dim>(law, group.old[static_cast<std::size_t>(p)], gradient, dt, F);
      if constexpr (Basis::uses_domains && Law::finite_strain)
        if (domains)
          half_length[p] = points.initial_half_length[static_cast<std::size_t>(p)].cwiseProduct(
              right_stretch<dim>(F).diagonal());
    }
  }
}

/// A group of no material, for passes that do not strain: they are compiled once for all laws.
struct NoMaterial {
  struct Law {
    static constexpr bool finite_strain = false;
  } law;
};

template <int dim, bool with_velocity, bool with_move, bool with_strain, bool strain_from_motion>
void update_body(const Space<dim>& space, Body<dim>& body, const PointUpdate& update) {
  if constexpr (with_strain) {
    std::visit(
        [&](const auto& basis, auto& group) {
          update_points<dim, with_velocity, with_move, true, strain_from_motion>(basis, space, body.points,
                                                                                 group, update);
        },
        space.basis(), body.material);
  } else {
    std::visit(
        [&](const auto& basis) {
          NoMaterial none;
          update_points<dim, with_velocity, with_move, false, false>(basis, space, body.points, none, update);
        },
        space.basis());
  }
}

}  // namespace

template <int dim>
void grid_to_points(const Space<dim>& space, Body<dim>& body, const PointUpdate& update) {
  const bool own = !update.strain_velocity.empty();
  if (update.velocity && update.move && update.strain && !own)
    update_body<dim, true, true, true, true>(space, body, update);
  else if (update.velocity && update.move && !update.strain)
    update_body<dim, true, true, false, false>(space, body, update);
  else if (!update.velocity && update.move && !update.strain)
    update_body<dim, false, true, false, false>(space, body, update);
  else if (update.velocity && !update.move && !update.strain)
    update_body<dim, true, false, false, false>(space, body, update);
  else if (!update.velocity && update.move && update.strain && own)
    update_body<dim, false, true, true, false>(space, body, update);
  else if (!update.velocity && !update.move && update.strain && own)
    update_body<dim, false, false, true, false>(space, body, update);
  else
    throw std::logic_error("grid_to_points: this combination of updates belongs to no scheme");
}

template <int dim>
void strain_points(Body<dim>& body, std::span<const double> gradients, double dt) {
  std::visit(
      [&](auto& group) {
        const auto law = group.law;
        for (std::size_t p = 0; p < group.old.size(); ++p) {
          double gradient[dim][dim];
          for (std::size_t d = 0; d < dim; ++d)
            for (std::size_t e = 0; e < dim; ++e) gradient[d][e] = gradients[(p * dim + d) * dim + e];
          strain_point<dim>(law, group.old[p], gradient, dt, body.points.deformation_gradient[p]);
        }
      },
      body.material);
}

template <int dim>
void follow_stretch(Body<dim>& body) {
  Particles<dim>& points = body.points;
  if (!body.finite_strain()) return;
  for (std::size_t p = 0; p < points.half_length.size(); ++p)
    points.half_length[p] = points.initial_half_length[p].cwiseProduct(
        right_stretch<dim>(points.deformation_gradient[p]).diagonal());
}

template <int dim>
double grid_kinetic_energy(const Space<dim>& space, const Body<dim>& body, std::span<const double> velocity,
                           int stride) {
  return std::visit(
      [&](const auto& basis) {
        using Basis = std::decay_t<decltype(basis)>;
        const Particles<dim>& points = body.points;
        const Vec<dim> none = Vec<dim>::Zero();
        double sum = 0.0;
        for (std::size_t p = 0; p < points.position.size(); ++p) {
          Vec<dim> v = Vec<dim>::Zero();
          basis.tabulate(points.position[p], Basis::uses_domains ? points.half_length[p] : none)
              .for_each([&](int, int i, double phi, const Vec<dim>&) {
                v += phi * Eigen::Map<const Vec<dim>>(velocity.data() + i * stride);
              });
          sum += 0.5 * points.mass[p] * v.squaredNorm();
        }
        return sum;
      },
      space.basis());
}

template <int dim>
BodyEnergy energy(const Body<dim>& body) {
  BodyEnergy sum;
  const Particles<dim>& points = body.points;
  for (std::size_t p = 0; p < points.mass.size(); ++p)
    sum.kinetic += 0.5 * points.mass[p] * points.velocity[p].squaredNorm();
  for_each_state<dim>(body, [&](int p, const auto& law, const auto& state) {
    const double volume = points.volume[static_cast<std::size_t>(p)];
    sum.strain += volume * law.template strain_energy<dim>(state);
    sum.dissipation += volume * law.template dissipation<dim>(state);
  });
  return sum;
}

template void grid_to_points<2>(const Space<2>&, Body<2>&, const PointUpdate&);
template void grid_to_points<3>(const Space<3>&, Body<3>&, const PointUpdate&);
template void strain_points<2>(Body<2>&, std::span<const double>, double);
template void strain_points<3>(Body<3>&, std::span<const double>, double);
template void follow_stretch<2>(Body<2>&);
template void follow_stretch<3>(Body<3>&);
template double grid_kinetic_energy<2>(const Space<2>&, const Body<2>&, std::span<const double>, int);
template double grid_kinetic_energy<3>(const Space<3>&, const Body<3>&, std::span<const double>, int);
template BodyEnergy energy<2>(const Body<2>&);
template BodyEnergy energy<3>(const Body<3>&);

}  // namespace wisp
