// Chosen numbers of a run, one row a record, as CSV.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace wisp {

/// A CSV file with the columns `step`, `time` and those given. Numbers are written in the shortest form that
/// reads back to the same bits. Written by rank 0 only. Each row reaches the system as a whole, so a killed
/// process loses at most the rows since the last flush, and at most tears the last line, which `resume`
/// drops.
class History {
 public:
  /// A new file (an older one is replaced). `columns` after step and time; a unit may follow in brackets:
  /// "kinetic energy [J]". InputError for an empty or repeated name or one with a comma, quote or line end.
  static History start(const std::filesystem::path& path, const std::vector<std::string>& columns);

  /// Goes on after `step`: rows of later steps and a torn last line are dropped, atomically. InputError if
  /// the columns differ or a line before the last cannot be understood. Starts anew where there is no file.
  static History resume(const std::filesystem::path& path, const std::vector<std::string>& columns,
                        std::int64_t step);

  History(History&& other) noexcept;
  History& operator=(History&&) = delete;
  History(const History&) = delete;
  History& operator=(const History&) = delete;
  ~History();

  /// Appends a row; `values` in the order of the columns. RunError if it cannot be written.
  void add(std::int64_t step, double time, std::span<const double> values);
  /// Hands pending rows to the system.
  void flush();
  /// The same, and on to the disk; to be called with each checkpoint.
  void sync();
  /// Rows between flushes, 1 unless told otherwise.
  void flush_every(int rows) { flush_every_ = rows; }

  const std::filesystem::path& path() const { return path_; }

 private:
  History(std::filesystem::path path, std::size_t columns);

  std::filesystem::path path_;
  std::size_t columns_;
  int descriptor_ = -1;
  int flush_every_ = 1;
  int pending_rows_ = 0;
  std::string pending_;
};

}  // namespace wisp
