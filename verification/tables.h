// Every table and figure that `wisp verify` can compute anew.
#pragma once
#include <vector>

#include "app/verification.h"

namespace wisp {

/// In the order in which they are printed. A paper is one folder beside this file and one line in tables.cpp.
std::vector<VerificationTable> verification_tables();

}  // namespace wisp
