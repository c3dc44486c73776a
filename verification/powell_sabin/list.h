// The tables and figures of de Koster 2018, the material point method with Powell–Sabin splines, and what
// goes with them. A file beside this one gives those of one chapter, each in a list of its own.
#pragma once
#include <vector>

#include "app/verification.h"

namespace wisp {

std::vector<VerificationTable> projection_tables();  ///< tables 3.1, 3.2, cubic and tensor splines
std::vector<VerificationTable> spline_pictures();    ///< figures 3.23, 3.24, 3.26

/// All of them, in the order of the text.
std::vector<VerificationTable> powell_sabin_tables();

}  // namespace wisp
