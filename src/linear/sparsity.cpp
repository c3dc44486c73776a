#include "linear/sparsity.h"

#include <algorithm>
#include <limits>

#include "core/error.h"

namespace wisp {
namespace {
std::size_t at(int i) { return static_cast<std::size_t>(i); }
}  // namespace

void Sparsity::begin(int n_local) {
  starts_.assign(at(n_local) + 1, 0);
  columns_.clear();
  element_starts_.assign(1, 0);
  element_functions_.clear();
}

void Sparsity::add_element(std::span<const int> functions) {
  element_functions_.insert(element_functions_.end(), functions.begin(), functions.end());
  element_starts_.push_back(static_cast<int>(element_functions_.size()));
}

void Sparsity::end() {
  const int n = n_local();
  const int n_elements = static_cast<int>(element_starts_.size()) - 1;
  of_function_starts_.assign(at(n) + 1, 0);
  for (int f : element_functions_) ++of_function_starts_[at(f) + 1];
  for (int f = 0; f < n; ++f) of_function_starts_[at(f) + 1] += of_function_starts_[at(f)];
  of_function_.resize(element_functions_.size());
  mark_.assign(of_function_starts_.begin(),
               of_function_starts_.end() - 1);  // first use: where the next one goes
  for (int e = 0; e < n_elements; ++e)
    for (int k = element_starts_[at(e)]; k < element_starts_[at(e) + 1]; ++k)
      of_function_[at(mark_[at(element_functions_[at(k)])]++)] = e;

  mark_.assign(at(n), -1);  // second use: the last row that took this column
  for (int f = 0; f < n; ++f) {
    const auto row_begin = static_cast<std::ptrdiff_t>(columns_.size());
    for (int l = of_function_starts_[at(f)]; l < of_function_starts_[at(f) + 1]; ++l) {
      const int e = of_function_[at(l)];
      for (int k = element_starts_[at(e)]; k < element_starts_[at(e) + 1]; ++k) {
        const int g = element_functions_[at(k)];
        if (mark_[at(g)] == f) continue;
        mark_[at(g)] = f;
        columns_.push_back(g);
      }
    }
    std::sort(columns_.begin() + row_begin, columns_.end());
    if (columns_.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
      run_error("a matrix of {} functions has more than {} entries on one rank: use more ranks", n,
                std::numeric_limits<int>::max());
    starts_[at(f) + 1] = static_cast<int>(columns_.size());
  }
}

int Sparsity::find(int f, int g) const {
  const auto columns = row(f);
  const auto place = std::lower_bound(columns.begin(), columns.end(), g);
  if (place == columns.end() || *place != g) return -1;
  return starts_[at(f)] + static_cast<int>(place - columns.begin());
}

}  // namespace wisp
