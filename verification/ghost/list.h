// The tables and figures of Coombs 2023, Ghost stabilisation of the material point method. A file beside this
// one gives those of one example, each in a list of its own.
#pragma once
#include <vector>

#include "app/verification.h"

namespace wisp {

std::vector<VerificationTable> block_tables();        ///< table 1, figures 3, 6, 7
std::vector<VerificationTable> translation_tables();  ///< table 2, figures 9, 10
std::vector<VerificationTable> stretching_tables();   ///< figure 11
std::vector<VerificationTable> collision_tables();    ///< figures 13, 14, 15, table 3
std::vector<VerificationTable> column_tables();       ///< figure 16, table 4
std::vector<VerificationTable> beam_tables();         ///< table 5, figures 18, 19

/// All of them, in the paper's order.
std::vector<VerificationTable> ghost_tables();

}  // namespace wisp
