// Ghost stabilisation: penalises jumps of the normal gradient across facets near the edge of the bodies.
#pragma once
#include <vector>

#include "basis/facet.h"
#include "linear/block_matrix.h"
#include "particle/body.h"
#include "stabilise/ghost_options.h"
#include "transfer/active.h"

namespace wisp {

/// A facet that is penalised, with the properties of the body that flags it (the largest if several do).
struct GhostFacet : Facet {
  double density = 0.0;         ///< kg/m3
  double p_wave_modulus = 0.0;  ///< lambda + 2 mu, Pa
};

/// The facets of Coombs 2023, sections 3.1 and 4.2, on this rank (a facet belongs to the owner of its lower
/// cell). For each body: a boundary cell is active and shares a facet with a cell that is not, or lies on an
/// edge of the grid that no condition holds; a facet between two active cells is penalised if at least one is
/// a boundary cell. Bodies are united.
template <int dim>
std::vector<GhostFacet> ghost_facets(const Space<dim>& space, const ActiveCells& active,
                                     const std::vector<Body<dim>>& bodies, const HeldEdges<dim>& held_edge,
                                     GhostElements elements = GhostElements::standard);

/// The cells whose functions take part in a step with Ghost: the active ones, on triangulations also a ring.
template <int dim>
ActiveCells ghost_cells(const Space<dim>& space, const ActiveCells& active, const GhostOptions& options);

enum class GhostMatrix { mass, stiffness };

/// Factor of J_G on a facet (see GhostOptions): kg/m3 for the mass, Pa for the stiffness in the paper's
/// units; times 1/h_n^2 for the dimensionless stiffness.
double ghost_factor(const GhostOptions& options, GhostMatrix kind, const GhostFacet& facet,
                    double normal_extent);

/// Lets the pattern of a matrix couple the functions of the facets.
template <int dim>
void add_ghost_pattern(const Space<dim>& space, const std::vector<GhostFacet>& facets, BlockMatrix& matrix);

/// Adds sum over facets of factor J_G, J_G = (h_n^3/3) integral [[d_n phi_i]] [[d_n phi_j]] (x) I (Coombs
/// 2023, eq. 18-24, 27); of B-splines of degree p with the derivative of order p, the only one that jumps,
/// and `jump_moment` for h_n^3/3.
template <int dim>
void add_ghost(const Space<dim>& space, const std::vector<GhostFacet>& facets, const GhostOptions& options,
               GhostMatrix kind, BlockMatrix& matrix);

}  // namespace wisp
