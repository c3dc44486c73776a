// The program of sanitizer builds has no verification tables.
#include "verification/tables.h"

namespace wisp {
std::vector<VerificationTable> verification_tables() { return {}; }
}  // namespace wisp
