// Points to grid and grid to points for explicit steps: stencils on the fly, one pass over the points each.
#pragma once
#include <span>

#include "basis/space.h"
#include "particle/body.h"

namespace wisp {

/// Sums over points at a grid function, one record a function: mass (kg), momentum (kg m/s), force (N;
/// internal plus body force), 1 + 2 dim numbers and zeros up to a power of two.
template <int dim>
inline constexpr int sums_stride = 8;

/// Motion of a grid function, one record: velocity at the end of the step (m/s), acceleration (m/s2), 2 dim
/// numbers and zeros up to a power of two.
template <int dim>
inline constexpr int motion_stride = dim == 2 ? 4 : 8;

enum class Gather { inertia, force, both };

/// The motion that a stress has already followed when its forces are gathered: USF strains before them.
struct FollowedMotion {
  std::span<const double> velocity;  ///< n_functions x dim, m/s; empty: none
  double dt = 0.0;                   ///< s
};

/// Adds a body's mass and momentum and/or forces to `sums` (n_functions x sums_stride):
///     m_i = sum_p phi_i m_p,  (mv)_i = sum_p phi_i m_p (v_p + C_p (x_i - x_p)),
///     f_i = sum_p phi_i m_p g - sum_p tau_p V0_p dF_p^-T grad phi_i    (Coombs 2023, eq. 6, 10, 15)
/// The affine part only with `apic`. dF = I + dt sum_i v_i (x) grad phi_i of the followed motion (only with
/// Gather::both and laws of finite strain; otherwise I) takes the gradients to the coordinates to which the
/// stress belongs: then the forces are the derivative of the strain energy, and the work of a step equals its
/// increase but for terms of dt^2.
template <int dim>
void points_to_grid(const Space<dim>& space, const Body<dim>& body, Gather what, const Vec<dim>& gravity,
                    bool apic, std::span<double> sums, const FollowedMotion& followed = {});

/// What grid_to_points does in a pass, and from which fields.
struct PointUpdate {
  double dt = 0.0;
  bool velocity = false;           ///< v_p from the grid
  bool move = false;               ///< x_p += dt sum_i phi_i v_i
  bool strain = false;             ///< F, stress and domains
  bool domains = true;             ///< with strain: domains follow the stretch
  std::span<const double> motion;  ///< n_functions x motion_stride, for velocity and move
  std::span<const double>
      strain_velocity;  ///< n_functions x dim, for strain; empty: the velocity in `motion`
  double flip = 1.0;    ///< share of FLIP: v_p = flip (v_p + dt a(x_p)) + (1 - flip) v(x_p)
  bool apic = false;    ///< PIC velocity and affine field
};

/// Updates the points of a body from the grid (Coombs 2023, eq. 8, 9; Jiang et al. 2015 for APIC). Steps that
/// are both needed are done in one pass: all use the functions at the start-of-step positions. Material
/// states are updated in place.
template <int dim>
void grid_to_points(const Space<dim>& space, Body<dim>& body, const PointUpdate& update);

/// Deformation gradients and stresses of a body by given velocity gradients (1/s, n_points x dim x dim, row
/// by row) over a step dt; material states are updated in place. For functions without domains.
template <int dim>
void strain_points(Body<dim>& body, std::span<const double> gradients, double dt);

/// Domains l = l0 U_ii of a body with a finite-strain law (Charlton, Coombs and Augarde 2017); otherwise
/// nothing: small-strain laws neglect the change of geometry.
template <int dim>
void follow_stretch(Body<dim>& body);

/// sum_p m_p |v(x_p)|^2 / 2 of a field of `stride` numbers a function whose first dim are the velocity: the
/// kinetic energy v^T M v / 2 with the consistent mass (without any stabilisation).
template <int dim>
double grid_kinetic_energy(const Space<dim>& space, const Body<dim>& body, std::span<const double> velocity,
                           int stride);

/// Sum over the points of a body on this rank.
struct BodyEnergy {
  double kinetic = 0.0;      ///< J, of the points' own velocities
  double strain = 0.0;       ///< J
  double dissipation = 0.0;  ///< J
};
template <int dim>
BodyEnergy energy(const Body<dim>& body);

}  // namespace wisp
