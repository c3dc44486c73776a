// The tables and figures of motion in the Powell-Sabin thesis, and what became of its open issue. A file
// beside this one gives those of one subject.
#pragma once
#include <vector>

#include "app/verification.h"

namespace wisp {

std::vector<VerificationTable> bar_tables();            ///< tables 4.2, 4.3, figures 4.3 to 4.8, 5.7
std::vector<VerificationTable> column_thesis_tables();  ///< figures 4.10 to 4.13, 5.3 to 5.8
std::vector<VerificationTable> near_empty_tables();     ///< triangles that are almost empty
std::vector<VerificationTable> gamma_tables();          ///< the penalty's factor and elements, elsewhere

}  // namespace wisp
