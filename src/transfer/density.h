// Inertia by Gauss points of a density that is reconstructed cell by cell from the points.
#pragma once
#include <span>

#include "basis/space.h"
#include "linear/block_matrix.h"
#include "particle/body.h"
#include "transfer/active.h"

namespace wisp {

// In the cells that a body fills (see add_reconstruction) the density is rho_h(x) = m_c/|c| + s.(x - c), with
// m_c the mass of the cell's points, |c| its volume, c its centroid, and s the slope of the least-squares fit
// to the points' densities m_p/V_p by the cell's Taylor basis (Wobbes et al. 2019, the conservative form: the
// linear functions have no integral, so the cell keeps its mass whatever the fit). Where that is negative
// anywhere, s = 0. All is exact but for rounding if the points' volumes sum to that of the cell and their
// density is linear in it. This rank's share; functions without domains only.

/// Couples the functions of each piece of the cells inside bodies, also of pieces without a point.
template <int dim>
void add_density_pattern(const Space<dim>& space, const std::vector<Body<dim>>& bodies,
                         const ActiveCells& cells, BlockMatrix& matrix);

/// Adds the integral of rho_h phi_i phi_j minus sum_p m_p phi_i phi_j over the filled cells to a scalar
/// matrix with that pattern and the points'.
template <int dim>
void exchange_mass(const Space<dim>& space, const std::vector<Body<dim>>& bodies, const ActiveCells& cells,
                   BlockMatrix& mass);

/// The same for the weight: adds the integral of rho_h phi_i g minus sum_p m_p phi_i g to the forces in
/// `sums` (n_functions x sums_stride). Free fall is exact with both.
template <int dim>
void exchange_weight(const Space<dim>& space, const std::vector<Body<dim>>& bodies, const ActiveCells& cells,
                     const Vec<dim>& gravity, std::span<double> sums);

/// Points that take dt a(x_p) of an acceleration found with rho_h do not take the momentum that the grid has
/// got, sum_p m_p a(x_p) against the integral of rho_h a. This adds the difference to the velocities of every
/// body's points as the one rigid motion that carries it: linear and angular momentum of the step are those
/// of the forces, to rounding. `motion`: n_functions x motion_stride with the acceleration in the places
/// dim..2 dim - 1. Collective.
template <int dim>
void balance_momentum(const Space<dim>& space, std::vector<Body<dim>>& bodies, const ActiveCells& cells,
                      std::span<const double> motion, double dt);

}  // namespace wisp
