// Internal forces by Gauss points of a stress that is reconstructed cell by cell from the points.
#pragma once
#include <span>

#include "basis/space.h"
#include "particle/body.h"
#include "transfer/active.h"

namespace wisp {

/// Replaces, in the forces of `sums` (n_functions x sums_stride), the internal forces of the points in filled
/// cells, -sum_p tau_p V0_p grad phi_i, by -integral of sigma_h grad phi_i over the cell with sigma_h the
/// least-squares fit of the points' Cauchy stress by the Taylor basis {1, (x - c)/h} of the cell (Wobbes et
/// al. 2019). A cell is filled if it and all cells around its vertices hold points of one and the same body
/// and no other, and its points have at least half of its volume (see filled_share). Forces of every cell
/// still sum to zero, linear stress is integrated exactly, and a point that crosses into the next cell moves
/// no force. Mass and momentum stay those of the points, so their totals are kept without a constraint on the
/// fit. This rank's share; functions without domains only.
template <int dim>
void add_reconstruction(const Space<dim>& space, const std::vector<Body<dim>>& bodies,
                        const ActiveCells& cells, std::span<double> sums);

/// Velocity gradients that strain the points of a body (n_points x dim x dim, row by row) where forces are
/// reconstructed: in filled cells the L2 projection of grad v on the cell's Taylor basis, at the point. The
/// reconstructed force does its work on that part of grad v alone. Strained by grad v itself, points would
/// gather or lose energy by the rest, on which no force acts; a smooth gradient (linear in a cell) is left as
/// it is. At the points of other cells it is grad v. `velocity`: `stride` numbers a function, the
/// first dim of them.
template <int dim>
void smooth_gradients(const Space<dim>& space, const std::vector<Body<dim>>& bodies, std::size_t body,
                      const ActiveCells& cells, std::span<const double> velocity, std::size_t stride,
                      std::vector<double>& gradients);

}  // namespace wisp
