// Files that a test writes and that vanish with it, and the message of an expected InputError.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core/error.h"

namespace wisp {

/// A folder of its own under the system's folder for temporary files, removed at the end.
class Scratch {
 public:
  Scratch() {
    static std::atomic<int> count{0};
    folder_ =
        std::filesystem::temp_directory_path() / fmt::format("wisp-geometry-{}-{}", ::getpid(), count++);
    std::filesystem::create_directories(folder_);
  }
  ~Scratch() { std::filesystem::remove_all(folder_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::filesystem::path write(const std::string& name, std::string_view text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

/// The message of the InputError that f() throws; a text that no message contains if it throws nothing.
template <class F>
std::string message_of(F&& f) {
  try {
    f();
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no error)";
}

/// Succeeds if `message` holds `part` and is one line.
inline ::testing::AssertionResult says(const std::string& message, std::string_view part) {
  if (message.find(part) == std::string::npos || message.find('\n') != std::string::npos)
    return ::testing::AssertionFailure() << "message: " << message << "\nexpected one line with: " << part;
  return ::testing::AssertionSuccess();
}

}  // namespace wisp
