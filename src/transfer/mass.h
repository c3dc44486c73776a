// The consistent mass matrix, and the pattern that points give to every matrix.
#pragma once
#include "basis/space.h"
#include "linear/block_matrix.h"
#include "particle/body.h"

namespace wisp {

/// Couples the functions of every point's stencil in the pattern of a matrix; equal sets are added once.
template <int dim>
void add_point_pattern(const Space<dim>& space, const std::vector<Body<dim>>& bodies, BlockMatrix& matrix);

/// Adds sum_p m_p phi_i phi_j (Coombs 2023, eq. 7) of all bodies to a scalar matrix whose pattern has the
/// points'.
template <int dim>
void add_consistent_mass(const Space<dim>& space, const std::vector<Body<dim>>& bodies, BlockMatrix& mass);

}  // namespace wisp
