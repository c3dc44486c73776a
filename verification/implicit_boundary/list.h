// The tables and figures of Cortis, Coombs and Augarde 2018, imposition of essential boundary conditions in
// the material point method, and what its consistent form does beyond them. A file beside this one gives
// those of one example.
#pragma once
#include <vector>

#include "app/verification.h"

namespace wisp {

std::vector<VerificationTable> contained_block_tables();  ///< section 5.1: table I, figures 7-13
std::vector<VerificationTable> deep_beam_tables();        ///< section 5.2: tables II, III, figure 15
std::vector<VerificationTable> simple_shear_tables();     ///< section 5.3: figure 16
std::vector<VerificationTable> explicit_wall_tables();    ///< beyond: walls in explicit dynamics

std::vector<VerificationTable> cantilever_tables();     ///< section 5.4: figures 18, 19, 21
std::vector<VerificationTable> penetration_tables();    ///< sections 5.5 and 5.6: figures 22, 23
std::vector<VerificationTable> clamped_tables();        ///< locking, rates of convergence, thick cylinder
std::vector<VerificationTable> spatial_tables();        ///< blocks in 3D
std::vector<VerificationTable> triangle_wall_tables();  ///< on triangulations

/// All of them, in the paper's order.
std::vector<VerificationTable> implicit_boundary_tables();

}  // namespace wisp
