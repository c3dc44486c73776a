#include "verification/tables.h"

#include "verification/ghost/list.h"

namespace wisp {

std::vector<VerificationTable> verification_tables() { return ghost_tables(); }

}  // namespace wisp
