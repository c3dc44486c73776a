// Good cases with one thing changed, and what reading them says.
#pragma once
#include <filesystem>
#include <string>

#include "core/error.h"
#include "io/case.h"

namespace wisp::test {

/// What a good text is changed by, its first occurrence, and the message that this must give.
struct Change {
  const char* what;
  const char* with;
  const char* message;
};

inline std::string changed(std::string text, const Change& change) {
  const auto at = text.find(change.what);
  if (at == std::string::npos) return "the good text has no such part";
  return text.replace(at, std::string(change.what).size(), change.with);
}

/// The message when the text is read as a case file in that folder.
inline std::string complaint(const std::string& text, const std::filesystem::path& folder) {
  try {
    read_case(CaseSource{"case.toml", folder, text, {}});
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no error)";
}

}  // namespace wisp::test
