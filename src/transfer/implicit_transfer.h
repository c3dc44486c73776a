// Stored stencils, internal forces and stiffness for Newton, which uses the same functions many times in a
// step.
#pragma once
#include <span>
#include <vector>

#include "basis/space.h"
#include "linear/block_matrix.h"
#include "particle/body.h"

namespace wisp {

/// The stencils of a body's points, tabulated once for a step. `n` functions a point; entry k of point p is
/// at p*n + k.
template <int dim>
struct StoredStencils {
  int n = 0;
  std::vector<int> key;       ///< one a point: equal keys, equal functions
  std::vector<int> function;  ///< local indices
  std::vector<double> phi;
  std::vector<Vec<dim>> dphi;  ///< 1/m, on the start-of-step configuration

  int size() const { return static_cast<int>(key.size()); }
};

template <int dim>
void tabulate(const Space<dim>& space, const Particles<dim>& points, StoredStencils<dim>& stencils);

/// Adds f_int,i = sum_p tau_p V0_p grad phi_i to `force` (n_functions x dim) for the displacement `u`
/// (n_functions x dim) over the step; the trial states of the material are left in `now`. Finite strain:
/// gradients are pushed to the current configuration by dF^-1 (Coombs 2023, section 2.4). Small strain:
/// start-of-step gradients. Returns the number of points whose dF has no positive determinant (their forces
/// are not added).
template <int dim>
int add_internal_force(const StoredStencils<dim>& stencils, Body<dim>& body, std::span<const double> u,
                       double dt, std::span<double> force);

/// Adds the stiffness K = sum_p grad phi_i c grad phi_j V0_p (eq. 13) at the trial states that
/// add_internal_force left for the same `u`.
template <int dim>
void add_stiffness(const StoredStencils<dim>& stencils, const Body<dim>& body, std::span<const double> u,
                   double dt, BlockMatrix& stiffness);

/// Takes over a converged step: states, F, domains (l = l0 U_ii, finite strain), positions and displacements
/// (eq. 14).
template <int dim>
void commit(const StoredStencils<dim>& stencils, Body<dim>& body, std::span<const double> u);

}  // namespace wisp
