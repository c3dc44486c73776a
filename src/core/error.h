// Errors that reach the user: one clear line each.
#pragma once
#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace wisp {

/// Bad input: what the user gave cannot be used. The program prints `what()` on one line and ends with exit
/// status 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A run that cannot go on (divergence, NaN, lost points): step, cause and what to try. Exit status 1; the
/// last good state stays on disk.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <class... Args>
[[noreturn]] void input_error(fmt::format_string<Args...> text, Args&&... args) {
  throw InputError(fmt::format(text, std::forward<Args>(args)...));
}
template <class... Args>
[[noreturn]] void run_error(fmt::format_string<Args...> text, Args&&... args) {
  throw RunError(fmt::format(text, std::forward<Args>(args)...));
}

}  // namespace wisp
