// The list of the written states with their times, which ParaView opens as an animation.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace wisp {

/// A `.pvd` collection, rewritten atomically at every addition so that it is complete at any moment. Written
/// by rank 0 only.
class PvdSeries {
 public:
  /// A new series; an older file of that name is replaced at the first addition.
  explicit PvdSeries(std::filesystem::path path) : path_(std::move(path)) {}

  /// Goes on with the series on disk, without its entries later than `time` [s]; none on disk is an empty
  /// series. InputError if the file is not one of ours.
  static PvdSeries resume(std::filesystem::path path, double time);

  /// Adds a file (`.vtu`, `.pvtu`) for `time`; an entry of the same part and time is replaced. `part` tells
  /// apart several files of one time.
  void add(double time, const std::filesystem::path& file, int part = 0);

  struct Entry {
    double time = 0.0;  ///< [s]
    std::string file;   ///< relative to the folder of the series
    int part = 0;
  };
  const std::vector<Entry>& entries() const { return entries_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  void write() const;

  std::filesystem::path path_;
  std::vector<Entry> entries_;
};

}  // namespace wisp
