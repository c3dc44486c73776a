#include "io/results_folder.h"

#include <fmt/format.h>

#include "core/version.h"
#include "io/output.h"
#include "parallel/session.h"

namespace wisp {
namespace fs = std::filesystem;
namespace {

/// Results of an earlier run would be mixed up with those of this one; other files are left alone.
void remove_earlier(const fs::path& folder) {
  for (const char* name :
       {"checkpoint.txt", "points.pvd", "history.csv", "scene.json", "case.toml", "grid.vtu"})
    fs::remove(folder / name);
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string(), end = entry.path().extension().string();
    if ((name.starts_with("checkpoint-") && end == ".h5") ||
        (name.starts_with("points-") && (end == ".vtu" || end == ".pvtu")))
      old.push_back(entry.path());
  }
  for (const auto& path : old) fs::remove(path);
}

/// The case as it was given; values of the command line are told behind it.
std::string case_copy(const Case& c) {
  std::string text = c.file.text;
  if (c.file.overrides.empty()) return text;
  text += text.ends_with("\n") ? "\n" : "\n\n";
  for (const auto& assignment : c.file.overrides) text += "# --set " + assignment + "\n";
  return text;
}

}  // namespace

OutputRanks output_ranks() {
  return {Session::rank(), Session::size(), [](bool mine) { return Session::all_of(mine); }};
}

ResultsFolder ResultsFolder::start(const fs::path& folder, const Case& c,
                                   const std::vector<std::string>& columns) {
  ResultsFolder result(folder);
  together(output_ranks(), folder.string(), [&] {
    if (Session::rank() != 0) return;
    remove_unfinished(folder);
    remove_earlier(folder);
    write_atomically(folder / "case.toml", case_copy(c));
    write_atomically(folder / "scene.json", scene_json(c));
    result.series_.emplace(folder / "points.pvd");
    result.history_.emplace(History::start(folder / "history.csv", columns));
  });
  return result;
}

ResultsFolder ResultsFolder::resume(const fs::path& folder, const std::vector<std::string>& columns,
                                    double time, std::int64_t last_row) {
  ResultsFolder result(folder);
  result.last_row_ = last_row;
  together(output_ranks(), folder.string(), [&] {
    if (Session::rank() != 0) return;
    remove_unfinished(folder);
    result.series_.emplace(PvdSeries::resume(folder / "points.pvd", time));
    result.history_.emplace(History::resume(folder / "history.csv", columns, last_row));
  });
  return result;
}

void ResultsFolder::add_state(std::int64_t step, double time, const VtuPoints& points) {
  const fs::path file = write_vtu_pieces(path_ / step_name("points", step), points, output_ranks());
  together(output_ranks(), "points.pvd", [&] {
    if (Session::rank() == 0) series_->add(time, file);
  });
}

void ResultsFolder::add_row(std::int64_t step, double time, const std::vector<double>& values) {
  last_row_ = step;
  if (Session::rank() == 0) history_->add(step, time, values);
}

void ResultsFolder::add_checkpoint(Checkpoint& checkpoint) {
  checkpoint.code_version = version();
  together(output_ranks(), "history.csv", [&] {
    if (Session::rank() == 0) history_->sync();
  });
  checkpoint.write(path_, output_ranks());
}

}  // namespace wisp
