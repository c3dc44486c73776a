// Files that appear under their name only when they are complete, so that a killed run leaves the last good
// ones.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace wisp {

/// The place of this process among those that write one result together.
struct OutputRanks {
  int rank = 0;
  int ranks = 1;
  /// Collective: waits for every rank and tells whether all of them passed `true`. With MPI: an all-reduce of
  /// a logical "and". It is a barrier that carries a verdict, so that a full disk on one rank stops them all
  /// instead of leaving the others waiting.
  std::function<bool(bool)> all_succeeded = [](bool mine) { return mine; };
};

/// Runs `work` on this rank, waits for the others, and throws on every rank if it failed on any: here the
/// original error, elsewhere a RunError that says what was being written.
void together(const OutputRanks& place, std::string_view what, const std::function<void()>& work);

/// A file written under a temporary name in its own folder (`.<name>.part`), and renamed by `commit`. Without
/// `commit` the temporary file is removed and an earlier file of that name stays as it was. Errors are
/// RunError with the system's reason (no space, no permission).
class AtomicFile {
 public:
  /// Creates the folder where it is missing and opens the temporary file, for text and binary alike.
  explicit AtomicFile(std::filesystem::path path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  void write(std::string_view bytes);
  void write(const void* bytes, std::size_t count);
  /// Flushes to the disk, renames, flushes the folder. Nothing can be written afterwards.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
};

/// The temporary name that belongs to `path`, for writers (HDF5) that open files themselves.
std::filesystem::path temporary_name(const std::filesystem::path& path);

/// Flushes the complete file `temporary_name(path)` to the disk and renames it to `path`.
void commit_temporary(const std::filesystem::path& path);

/// A whole file at once.
void write_atomically(const std::filesystem::path& path, std::string_view contents);

/// Creates `folder` where it is missing and removes the temporary files that a killed run left in it.
void remove_unfinished(const std::filesystem::path& folder);

/// The whole of a file. InputError if it cannot be read; `what` names it in the message ("the history").
std::string read_whole(const std::filesystem::path& path, std::string_view what);

}  // namespace wisp
