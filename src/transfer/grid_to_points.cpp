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

/// a b, written out: Eigen calls a function for it.
template <int dim>
inline Mat<dim> product(const Mat<dim>& a, const Mat<dim>& b) {
  Mat<dim> c;
  for (int j = 0; j < dim; ++j)
    for (int i = 0; i < dim; ++i) {
      double sum = a(i, 0) * b(0, j);
      for (int k = 1; k < dim; ++k) sum += a(i, k) * b(k, j);
      c(i, j) = sum;
    }
  return c;
}

/// One pass over the points. `strain_from_motion`: strains use the velocity of `motion`, gathered once for
/// all.
template <int dim, bool with_velocity, bool with_move, bool with_strain, bool strain_from_motion, class Basis,
          class Group>
__attribute__((flatten)) void update_points(const Basis basis, const Space<dim>& space,
                                            Particles<dim>& points, Group& group, const PointUpdate& update) {
  using Law = std::decay_t<decltype(group.law)>;
  constexpr bool gather_motion = with_velocity || with_move || (with_strain && strain_from_motion);
  const Law law = group.law;  // a copy: the compiler then knows that no point changes it
  const double* const motion = update.motion.data();
  const double* const strain_velocity = update.strain_velocity.data();
  const double dt = update.dt, flip = update.flip;
  const int n = points.size();
  const Vec<dim> none = Vec<dim>::Zero();
  for (int p = 0; p < n; ++p) {
    const auto k = static_cast<std::size_t>(p);
    const auto stencil =
        basis.tabulate(points.position[k], Basis::uses_domains ? points.half_length[k] : none);
    Vec<dim> v, a;
    Mat<dim> gradient;
    if constexpr (gather_motion) {
      constexpr bool strain = with_strain && strain_from_motion;
      const auto sum = sum_of_functions<dim, motion_stride<dim>, strain>(stencil, motion);
      for (int d = 0; d < dim; ++d) {
        v[d] = sum.value[d], a[d] = sum.value[dim + d];
        if constexpr (strain)
          for (int e = 0; e < dim; ++e) gradient(d, e) = sum.gradient[e][d];
      }
    }
    if constexpr (with_strain && !strain_from_motion) {
      gradient.setZero();
      stencil.for_each([&](int, int i, double, const Vec<dim>& dphi) {
        const double* const u = strain_velocity + i * dim;
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e) gradient(d, e) += u[d] * dphi[e];
      });
    }
    if constexpr (with_velocity) {
      if (update.apic)
        points.affine[k] = affine_field<dim, Basis>(space, stencil, points.position[k], motion);
      points.velocity[k] = flip * (points.velocity[k] + dt * a) + (1.0 - flip) * v;
    }
    if constexpr (with_move) {
      points.position[k] += dt * v;
      points.displacement[k] += dt * v;
    }
    if constexpr (with_strain) {
      const Kinematics<dim> kinematics{Mat<dim>::Identity() + dt * gradient, dt};
      points.deformation_gradient[k] = product<dim>(kinematics.dF, points.deformation_gradient[k]);
      law.template stress<dim>(kinematics, group.old[k], group.old[k]);
      if constexpr (Basis::uses_domains && Law::finite_strain)
        if (update.domains)
          points.half_length[k] = points.initial_half_length[k].cwiseProduct(
              right_stretch<dim>(points.deformation_gradient[k]).diagonal());
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
template void follow_stretch<2>(Body<2>&);
template void follow_stretch<3>(Body<3>&);
template double grid_kinetic_energy<2>(const Space<2>&, const Body<2>&, std::span<const double>, int);
template double grid_kinetic_energy<3>(const Space<3>&, const Body<3>&, std::span<const double>, int);
template BodyEnergy energy<2>(const Body<2>&);
template BodyEnergy energy<3>(const Body<3>&);

}  // namespace wisp
