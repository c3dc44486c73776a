#include "linear/block_matrix.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/error.h"

namespace wisp {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::int64_t next_pattern_id() {
  static std::atomic<std::int64_t> last{0};
  return ++last;
}

template <int b>
void multiply_blocks(const Sparsity& pattern, const double* values, const double* x, double* y) {
  const auto starts = pattern.starts();
  const auto columns = pattern.columns();
  for (int f = 0; f < pattern.n_local(); ++f) {
    double sum[b] = {};
    for (int k = starts[at(f)]; k < starts[at(f) + 1]; ++k) {
      const double* a = values + at(k) * b * b;
      const double* xg = x + at(columns[at(k)]) * b;
      for (int c = 0; c < b; ++c)
        for (int d = 0; d < b; ++d) sum[c] += a[c * b + d] * xg[d];
    }
    for (int c = 0; c < b; ++c) y[at(f) * b + at(c)] = sum[c];
  }
}

template <int m>
void multiply_columns_of(const Sparsity& pattern, const double* values, const double* x, double* y) {
  const auto starts = pattern.starts();
  const auto columns = pattern.columns();
  for (int f = 0; f < pattern.n_local(); ++f) {
    double sum[m] = {};
    for (int k = starts[at(f)]; k < starts[at(f) + 1]; ++k) {
      const double a = values[at(k)];
      const double* xg = x + at(columns[at(k)]) * m;
      for (int c = 0; c < m; ++c) sum[c] += a * xg[c];
    }
    for (int c = 0; c < m; ++c) y[at(f) * m + at(c)] = sum[c];
  }
}

}  // namespace

BlockMatrix::BlockMatrix(int block) : block_(block), pattern_(std::make_shared<const Sparsity>()) {
  if (block < 1 || block > 3) input_error("a matrix has blocks of 1 to 3 components, not {}", block);
}

void BlockMatrix::end_pattern() {
  builder_.end();
  if (pattern_id_ == 0 || !(*pattern_ == builder_)) {
    pattern_ = std::make_shared<const Sparsity>(builder_);
    pattern_id_ = next_pattern_id();
  }
  zero();
}

void BlockMatrix::share_pattern(const BlockMatrix& other) {
  pattern_ = other.pattern_;
  pattern_id_ = other.pattern_id_;
  zero();
}

void BlockMatrix::zero() { values_.assign(at(pattern_->n_entries()) * at(block_ * block_), 0.0); }

void BlockMatrix::locate(std::span<const int> functions) {
  const int n = static_cast<int>(functions.size());
  order_.resize(at(n));
  // Insertion sort: lists are short and nearly always sorted already.
  for (int i = 0; i < n; ++i) {
    int j = i;
    for (; j > 0 && functions[at(order_[at(j - 1)])] > functions[at(i)]; --j)
      order_[at(j)] = order_[at(j - 1)];
    order_[at(j)] = i;
  }
}

template <int b, bool scalar>
void BlockMatrix::add_blocks(std::span<const int> functions, const double* dense) {
  locate(functions);
  const int n = static_cast<int>(functions.size());
  const auto starts = pattern_->starts();
  const int* columns = pattern_->columns().data();
  for (int i = 0; i < n; ++i) {
    const int f = functions[at(i)];
    int k = starts[at(f)];
    const int end = starts[at(f) + 1];
    for (int s = 0; s < n; ++s) {  // both the row and the list are sorted: walk them together
      const int j = order_[at(s)];
      const int g = functions[at(j)];
      while (k < end && columns[k] < g) ++k;
      if (k == end || columns[k] != g)
        run_error("a matrix has no entry for functions {} and {}: its pattern lacks this cell or facet", f,
                  g);
      double* a = values_.data() + at(k) * b * b;
      if constexpr (scalar) {
        const double m = dense[at(i) * at(n) + at(j)];
        for (int c = 0; c < b; ++c) a[c * b + c] += m;
      } else {
        const double* block = dense + (at(i) * b * at(n) + at(j)) * b;
        for (int c = 0; c < b; ++c)
          for (int d = 0; d < b; ++d) a[c * b + d] += block[at(c) * at(n) * b + at(d)];
      }
    }
  }
}

void BlockMatrix::add(std::span<const int> functions, const double* dense) {
  if (block_ == 1) return add_blocks<1, false>(functions, dense);
  if (block_ == 2) return add_blocks<2, false>(functions, dense);
  add_blocks<3, false>(functions, dense);
}

void BlockMatrix::add_scalar(std::span<const int> functions, const double* dense) {
  if (block_ == 1) return add_blocks<1, true>(functions, dense);
  if (block_ == 2) return add_blocks<2, true>(functions, dense);
  add_blocks<3, true>(functions, dense);
}

void BlockMatrix::add_matrix(double factor, const BlockMatrix& other) {
  if (pattern_id_ != other.pattern_id_ && !(*pattern_ == *other.pattern_))
    run_error("matrices of different patterns cannot be added ({} and {} entries)", pattern_->n_entries(),
              other.pattern_->n_entries());
  if (other.block_ == block_) {
    for (std::size_t k = 0; k < values_.size(); ++k) values_[k] += factor * other.values_[k];
    return;
  }
  if (other.block_ != 1)
    run_error("a matrix of blocks of {} cannot be added to one of {}", other.block_, block_);
  const auto b = at(block_);
  for (std::size_t k = 0; k < other.values_.size(); ++k)
    for (std::size_t c = 0; c < b; ++c) values_[k * b * b + c * b + c] += factor * other.values_[k];
}

void BlockMatrix::multiply(std::span<const double> x, std::span<double> y) const {
  if (block_ == 1) return multiply_blocks<1>(*pattern_, values_.data(), x.data(), y.data());
  if (block_ == 2) return multiply_blocks<2>(*pattern_, values_.data(), x.data(), y.data());
  multiply_blocks<3>(*pattern_, values_.data(), x.data(), y.data());
}

void BlockMatrix::multiply_columns(std::span<const double> x, std::span<double> y, int columns) const {
  if (block_ != 1) run_error("only a scalar matrix multiplies columns; this one has blocks of {}", block_);
  switch (columns) {
    case 1:
      return multiply_columns_of<1>(*pattern_, values_.data(), x.data(), y.data());
    case 2:
      return multiply_columns_of<2>(*pattern_, values_.data(), x.data(), y.data());
    case 3:
      return multiply_columns_of<3>(*pattern_, values_.data(), x.data(), y.data());
    case 4:
      return multiply_columns_of<4>(*pattern_, values_.data(), x.data(), y.data());
    default:
      run_error("a scalar matrix multiplies 1 to 4 columns at once, not {}", columns);
  }
}

void BlockMatrix::diagonal(std::span<double> out) const {
  for (int f = 0; f < n_local(); ++f)
    for (int c = 0; c < block_; ++c) out[at(f * block_ + c)] = entry(f, c, f, c);
}

void BlockMatrix::row_sums(std::span<double> out) const {
  const auto starts = pattern_->starts();
  const auto b = at(block_);
  for (int f = 0; f < n_local(); ++f)
    for (std::size_t c = 0; c < b; ++c) {
      double sum = 0.0;
      for (auto k = at(starts[at(f)]); k < at(starts[at(f) + 1]); ++k)
        for (std::size_t d = 0; d < b; ++d) sum += values_[(k * b + c) * b + d];
      out[at(f) * b + c] = sum;
    }
}

bool BlockMatrix::symmetric() const {
  constexpr double tolerance = 1e-13;
  const auto starts = pattern_->starts();
  const auto columns = pattern_->columns();
  const auto b = at(block_);
  std::vector<double> root(at(n_local()) * b);
  diagonal(root);
  for (double& d : root) d = std::sqrt(std::abs(d));
  // Rows come in increasing order, so the entries (g, f) of a row g are met in the order of its columns.
  std::vector<int> next(starts.begin(), starts.end() - 1);
  for (int f = 0; f < n_local(); ++f)
    for (int k = starts[at(f)]; k < starts[at(f) + 1]; ++k) {
      const int g = columns[at(k)];
      const int transpose = next[at(g)]++;
      if (g < f) continue;
      const double* a = values_.data() + at(k) * b * b;
      const double* t = values_.data() + at(transpose) * b * b;
      for (std::size_t c = 0; c < b; ++c)
        for (std::size_t d = 0; d < b; ++d)
          if (!(std::abs(a[c * b + d] - t[d * b + c]) <=
                tolerance * root[at(f) * b + c] * root[at(g) * b + d]))
            return false;
    }
  return true;
}

double BlockMatrix::entry(int f, int c, int g, int d) const {
  const int k = pattern_->find(f, g);
  return k < 0 ? 0.0 : values_[at(k) * at(block_ * block_) + at(c * block_ + d)];
}

}  // namespace wisp
