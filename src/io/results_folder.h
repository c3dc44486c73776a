// The files of one run, written by all ranks together.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/case.h"
#include "io/checkpoint.h"
#include "io/history.h"
#include "io/pvd.h"
#include "io/vtu.h"

namespace wisp {

/// This rank's place among those that write; errors of one rank become errors of all.
OutputRanks output_ranks();

/// A folder with case.toml, scene.json, points.pvd, history.csv and checkpoints. Every function is
/// collective.
class ResultsFolder {
 public:
  /// A new run: makes the folder, removes what an earlier run left in it.
  static ResultsFolder start(const std::filesystem::path& folder, const Case& c,
                             const std::vector<std::string>& columns);
  /// The folder of a stopped run, brought back to a time [s] and to a last row of the history.
  static ResultsFolder resume(const std::filesystem::path& folder, const std::vector<std::string>& columns,
                              double time, std::int64_t last_row);

  void add_state(std::int64_t step, double time, const VtuPoints& points);
  void add_row(std::int64_t step, double time, const std::vector<double>& values);
  void add_checkpoint(Checkpoint& checkpoint);

  /// Step of the last row of the history, -1 if there is none.
  std::int64_t last_row() const { return last_row_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  explicit ResultsFolder(std::filesystem::path path) : path_(std::move(path)) {}

  std::filesystem::path path_;
  std::optional<PvdSeries> series_;  // rank 0
  std::optional<History> history_;   // rank 0
  std::int64_t last_row_ = -1;
};

}  // namespace wisp
