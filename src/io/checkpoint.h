// Everything that a run needs to go on as if it had never stopped, in one HDF5 file for each rank.
//
// A set of files `checkpoint-<step>.rank-<r>.h5` counts only once the index `checkpoint.txt` names it; the
// index is renamed into place after every rank has finished, and the files of older sets are deleted after
// that. So a run killed at any moment leaves the last complete set. Each file begins with a block of text
// (HDF5's user block) that holds its length and checksum: a damaged file is recognised before HDF5 opens it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/error.h"
#include "io/atomic_file.h"

namespace wisp {

/// The version of the arrangement inside the files; a file of another version is refused.
inline constexpr int checkpoint_format_version = 1;

/// Named arrays in the order in which they were set. Every value comes back with the same bits.
class Checkpoint {
 public:
  using Doubles = std::vector<double>;
  using Integers = std::vector<std::int64_t>;
  using Bytes = std::vector<std::uint8_t>;
  using Array = std::variant<Doubles, Integers, Bytes, std::string>;

  std::int64_t step = 0;
  double time = 0.0;         ///< [s]
  std::string code_version;  ///< of the program that wrote it
  std::string case_text;     ///< the whole case file
  std::string created;       ///< date and time, UTC, ISO 8601; set by write

  /// Sets or replaces an array (a name may hold any characters but "/").
  void set(const std::string& name, Doubles values) { set_array(name, std::move(values)); }
  void set(const std::string& name, Integers values) { set_array(name, std::move(values)); }
  void set(const std::string& name, Bytes values) { set_array(name, std::move(values)); }
  void set(const std::string& name, std::string text) { set_array(name, std::move(text)); }
  void set_number(const std::string& name, double value) { set(name, Doubles{value}); }
  void set_integer(const std::string& name, std::int64_t value) { set(name, Integers{value}); }
  /// Values of a trivially copyable type (material states, counters) as their bytes.
  template <class T>
  void set_values(const std::string& name, std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    Bytes bytes(values.size_bytes());
    if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    set(name, std::move(bytes));
  }

  /// The array of that name. InputError if it is missing, or of another kind.
  const Doubles& doubles(const std::string& name) const;
  const Integers& integers(const std::string& name) const;
  const Bytes& bytes(const std::string& name) const;
  const std::string& text(const std::string& name) const;
  /// The same, and InputError unless it has `count` values.
  const Doubles& doubles(const std::string& name, std::size_t count) const;
  const Integers& integers(const std::string& name, std::size_t count) const;
  double number(const std::string& name) const { return doubles(name, 1).front(); }
  std::int64_t integer(const std::string& name) const { return integers(name, 1).front(); }
  template <class T>
  std::vector<T> values(const std::string& name) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const Bytes& raw = bytes(name);
    if (raw.size() % sizeof(T) != 0)
      input_error("{}: \"{}\" has {} bytes, expected a multiple of {}", origin_, name, raw.size(), sizeof(T));
    std::vector<T> values(raw.size() / sizeof(T));
    if (!raw.empty()) std::memcpy(values.data(), raw.data(), raw.size());
    return values;
  }
  bool has(const std::string& name) const { return find(name) != nullptr; }
  /// Names in the order in which they were set.
  std::vector<std::string> names() const;

  /// Collective. Writes this rank's part; when all are there, rank 0 renames the index and deletes all but
  /// the last two sets. RunError on every rank if one fails: the sets from before then still count.
  void write(const std::filesystem::path& folder, const OutputRanks& place = {});

  /// Writes and reads one file. `read_file` throws InputError for whatever is wrong with it.
  void write_file(const std::filesystem::path& path, int rank, int ranks) const;
  static Checkpoint read_file(const std::filesystem::path& path, int rank, int ranks);

 private:
  struct Named {
    std::string name;
    Array array;
  };
  void set_array(const std::string& name, Array array);
  const Named* find(const std::string& name) const;
  template <class T>
  const T& get(const std::string& name, const char* kind) const;

  std::vector<Named> arrays_;
  std::string origin_ = "checkpoint";  ///< the file, for messages
};

/// One line of the index: a complete set of files.
struct CheckpointSet {
  std::int64_t step = 0;
  int ranks = 1;
};

/// The complete sets in `folder`, newest first. InputError if there is no index or it is damaged.
std::vector<CheckpointSet> checkpoint_sets(const std::filesystem::path& folder);

/// The name of a rank's file.
std::filesystem::path checkpoint_file(const std::filesystem::path& folder, const CheckpointSet& set,
                                      int rank);

/// Collective. This rank's part of the newest set that every rank can read; why newer ones were passed over
/// is added to `passed_over`, one line each. InputError on every rank if none can be read, or if the sets
/// were written by another number of ranks.
Checkpoint read_latest_checkpoint(const std::filesystem::path& folder, const OutputRanks& place = {},
                                  std::vector<std::string>* passed_over = nullptr);

/// The files of one set, to be read one after the other.
struct CheckpointParts {
  std::filesystem::path folder;
  CheckpointSet set;
  int n() const { return set.ranks; }
  Checkpoint read(int part) const;  ///< InputError
};

/// The newest set of which every part can be read, to go on with another number of ranks.
CheckpointParts latest_checkpoint_parts(const std::filesystem::path& folder,
                                        std::vector<std::string>* passed_over = nullptr);

}  // namespace wisp
