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
/// and no other, and its points have at least three quarters of its volume. Forces of every cell still sum to
/// zero, linear stress is integrated exactly, and a point that crosses into the next cell moves no force.
/// Mass and momentum stay those of the points, so their totals are kept without a constraint on the fit. This
/// rank's share; functions without domains only.
template <int dim>
void add_reconstruction(const Space<dim>& space, const std::vector<Body<dim>>& bodies,
                        const ActiveCells& cells, std::span<double> sums);

}  // namespace wisp
