// Mass and stiffness matrices of a body at rest somewhere on the grid, dense, and their factors.
#pragma once
#include <Eigen/Core>

#include "analysis/model.h"
#include "linear/dof_map.h"
#include "linear/spectrum.h"
#include "stabilise/ghost.h"
#include "transfer/active.h"

namespace wisp {

/// What the matrices at one position share.
struct Position {
  std::vector<GhostFacet> facets;
  std::vector<char> active;  ///< n_functions flags
  DofMap unknowns;           ///< of active functions, without those that conditions hold
};

/// Settles the points of a model where they are. `components`: unknowns a function, 1 (no conditions then)
/// or 2.
Position settle_at(Model<2>& model, int components);

/// Consistent mass (one component serves all), with Ghost if `ghost` is given.
BlockMatrix consistent_mass(const Model<2>& model, const Position& position, const GhostOptions* ghost);
/// Small-strain stiffness at zero displacement, with Ghost if `ghost` is given.
BlockMatrix small_strain_stiffness(Model<2>& model, const Position& position, const GhostOptions* ghost);
/// The part of a matrix that belongs to the unknowns; a scalar matrix serves all their components.
Eigen::MatrixXd dense(const BlockMatrix& matrix, const DofMap& unknowns);
/// Ratio of the greatest to the least sum of rows of the mass at the unknowns (eq. 15).
double lumped_condition(const BlockMatrix& mass, const DofMap& unknowns);

/// A with A^T A the consistent mass: rows sqrt(m_p) phi(x_p), one a point and component.
Eigen::MatrixXd mass_factor(const Model<2>& model, const DofMap& unknowns);
/// A with A^T A the small-strain stiffness: rows sqrt(V_p) D^1/2 B_p, four a point. Law: linear-elastic.
Eigen::MatrixXd stiffness_factor(const Model<2>& model, const DofMap& unknowns);

/// Greatest eigenvalue of K x = lambda M x. Both are scaled by the diagonal of M first: nearly empty cells
/// make M badly scaled, hardly anything else, so this reaches far beyond 1e16. Absent if M is singular even
/// then.
std::optional<double> greatest_eigenvalue(const Eigen::MatrixXd& k, const Eigen::MatrixXd& m);

}  // namespace wisp
