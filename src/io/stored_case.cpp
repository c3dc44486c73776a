#include "io/stored_case.h"

#include "core/error.h"

namespace wisp {
namespace {

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += line + "\n";
  return text;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

}  // namespace

void store_case(const CaseSource& source, const CaseSource& begun, Checkpoint& checkpoint) {
  checkpoint.case_text = source.text;
  checkpoint.set("case name", source.name);
  checkpoint.set("case folder", std::filesystem::absolute(source.folder).string());
  checkpoint.set("case overrides", joined(begun.overrides));
  const auto first_change = source.overrides.begin() + static_cast<std::ptrdiff_t>(begun.overrides.size());
  checkpoint.set("case changes", joined({first_change, source.overrides.end()}));
}

Case begun_case(const Checkpoint& checkpoint) {
  return read_case(CaseSource{checkpoint.text("case name"), checkpoint.text("case folder"),
                              checkpoint.case_text, split(checkpoint.text("case overrides"))});
}

Case stored_case(const Checkpoint& checkpoint, const std::vector<std::string>& changes) {
  auto overrides = split(checkpoint.text("case overrides"));
  for (const auto& list : {split(checkpoint.text("case changes")), changes})
    overrides.insert(overrides.end(), list.begin(), list.end());
  return read_case(CaseSource{checkpoint.text("case name"), checkpoint.text("case folder"),
                              checkpoint.case_text, std::move(overrides)});
}

void check_changes(const std::vector<std::string>& changes) {
  for (const auto& change : changes) {
    const std::string key = change.substr(0, change.find_first_of(" ="));
    bool allowed = false;
    for (const char* start :
         {"stage[", "solver.", "stabilisation.", "grid.leaving", "output.frames", "output.checkpoint_every"})
      allowed |= key.starts_with(start);
    if (!allowed || key.ends_with("].type"))
      input_error(
          "--set {}: a run that goes on can change keys of stage (not their types), solver and "
          "stabilisation, "
          "grid.leaving, output.frames and output.checkpoint_every",
          change);
  }
}

}  // namespace wisp
