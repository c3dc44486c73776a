// Which functions of the grid meet: the pattern of every matrix.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace wisp {

/// Compressed rows over local functions. Built from elements, the lists of functions that a cell or a facet
/// couples: every pair within a list is an entry. Columns of a row are sorted; a function in any list has its
/// diagonal.
class Sparsity {
 public:
  /// Starts a new pattern over functions 0 .. n_local-1.
  void begin(int n_local);
  /// Adds the coupling of the functions of one cell or facet, distinct and in [0, n_local).
  void add_element(std::span<const int> functions);
  /// Builds the rows, O(sum of squares of the list lengths).
  void end();

  int n_local() const { return static_cast<int>(starts_.size()) - 1; }
  int n_entries() const { return starts_.back(); }
  /// Row f holds entries [starts()[f], starts()[f+1]) of columns().
  std::span<const int> starts() const { return starts_; }
  std::span<const int> columns() const { return columns_; }
  std::span<const int> row(int f) const {
    const auto begin = static_cast<std::size_t>(starts_[static_cast<std::size_t>(f)]);
    const auto end = static_cast<std::size_t>(starts_[static_cast<std::size_t>(f) + 1]);
    return std::span(columns_).subspan(begin, end - begin);
  }
  /// Entry number of (f, g), or -1 where there is none.
  int find(int f, int g) const;
  bool operator==(const Sparsity& other) const {
    return starts_ == other.starts_ && columns_ == other.columns_;
  }

 private:
  std::vector<int> starts_{0};
  std::vector<int> columns_;
  // While building: the lists one after another.
  std::vector<int> element_starts_;
  std::vector<int> element_functions_;
  std::vector<int> of_function_starts_;  // lists that hold a function
  std::vector<int> of_function_;
  std::vector<int> mark_;
};

}  // namespace wisp
