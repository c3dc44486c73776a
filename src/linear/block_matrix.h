// The matrix that a rank assembles: dense blocks between the functions it touches.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "linear/sparsity.h"

namespace wisp {

/// Sparse matrix of b x b blocks between the LOCAL functions of a rank, ghosts included; b = 1, 2 or 3. Its
/// values are this rank's contributions: the matrix of the whole problem is their sum over ranks (made by
/// `SystemMatrix`, or one product at a time by `multiply` and Halo::add). Unknown (f, c) of a local dense
/// array is entry f * b + c.
class BlockMatrix {
 public:
  explicit BlockMatrix(int block = 1);

  /// Pattern from cells and facets; `end_pattern` keeps the old one (and its `pattern_id`) if nothing
  /// changed, and sets all values to zero.
  void begin_pattern(int n_local) { builder_.begin(n_local); }
  void add_element(std::span<const int> functions) { builder_.add_element(functions); }
  void end_pattern();
  /// Takes the pattern of another matrix (any block size) without a copy; values become zero.
  void share_pattern(const BlockMatrix& other);
  /// Equal ids mean equal patterns.
  std::int64_t pattern_id() const { return pattern_id_; }
  const Sparsity& pattern() const { return *pattern_; }

  int block() const { return block_; }
  int n_local() const { return pattern_->n_local(); }
  /// Values of entry k of the pattern: b x b row-major at values()[k*b*b].
  std::span<const double> values() const { return values_; }
  std::span<double> values() { return values_; }

  void zero();
  /// Adds a dense element matrix, (n b) x (n b) row-major, unknown i*b + c for component c of functions[i].
  /// All pairs must be in the pattern, else RunError.
  void add(std::span<const int> functions, const double* dense);
  /// Adds M ⊗ I_b: `dense` is n x n row-major.
  void add_scalar(std::span<const int> functions, const double* dense);
  /// this += factor * other. Same pattern; `other` has the same block size, or 1 (then other ⊗ I_b is added).
  void add_matrix(double factor, const BlockMatrix& other);

  /// y = A x over the local functions, x and y of n_local*b. On several ranks x needs current ghosts, and y
  /// is complete after Halo::add.
  void multiply(std::span<const double> x, std::span<double> y) const;
  /// Y = (A ⊗ I_m) X for a scalar matrix (b = 1), X and Y n_local x m, m = 1..4: one pass over the matrix
  /// serves all columns.
  void multiply_columns(std::span<const double> x, std::span<double> y, int columns) const;
  /// Diagonal entries, n_local*b; zero for functions outside the pattern.
  void diagonal(std::span<double> out) const;
  /// Sums of rows, n_local*b: for a scalar matrix its lumped diagonal.
  void row_sums(std::span<double> out) const;
  /// |a_ij - a_ji| <= 1e-13 sqrt(|a_ii a_jj|) for all entries, so up to the rounding of their assembly.
  bool symmetric() const;
  /// Entry ((f, c), (g, d)), zero outside the pattern.
  double entry(int f, int c, int g, int d) const;

 private:
  template <int b, bool scalar>
  void add_blocks(std::span<const int> functions, const double* dense);
  void locate(std::span<const int> functions);

  int block_;
  std::shared_ptr<const Sparsity> pattern_;
  std::int64_t pattern_id_ = 0;
  Sparsity builder_;
  std::vector<double> values_;
  std::vector<int> order_;  // scratch: positions in the element list, by increasing function
};

}  // namespace wisp
