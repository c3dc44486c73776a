#pragma once
#include <string_view>

namespace wisp {

/// "0.1.0": of the program and of what it writes.
std::string_view version();

}  // namespace wisp
