#include "core/version.h"

namespace wisp {

std::string_view version() { return WISP_VERSION; }

}  // namespace wisp
