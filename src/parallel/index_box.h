// Boxes of cells or nodes of a structured grid, by integer coordinates.
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace wisp {

/// Integer coordinates of a cell or node of a structured grid, one per direction.
template <int dim>
using MultiIndex = Eigen::Matrix<int, dim, 1>;

/// The half-open box [lower, upper) of multi-indices.
template <int dim>
struct IndexBox {
  MultiIndex<dim> lower = MultiIndex<dim>::Zero();
  MultiIndex<dim> upper = MultiIndex<dim>::Zero();

  [[nodiscard]] MultiIndex<dim> extent() const { return upper - lower; }
  [[nodiscard]] std::int64_t count() const {
    std::int64_t result = 1;
    for (int d = 0; d < dim; ++d) result *= upper[d] > lower[d] ? upper[d] - lower[d] : 0;
    return result;
  }
  [[nodiscard]] bool contains(const MultiIndex<dim>& index) const {
    for (int d = 0; d < dim; ++d)
      if (index[d] < lower[d] || index[d] >= upper[d]) return false;
    return true;
  }
  friend bool operator==(const IndexBox& a, const IndexBox& b) {
    return a.lower == b.lower && a.upper == b.upper;
  }
};

/// Calls `visit(index)` for every multi-index of the box, x fastest.
template <int dim, class Visit>
void for_each_in(const IndexBox<dim>& box, Visit&& visit) {
  if (box.count() == 0) return;
  MultiIndex<dim> index = box.lower;
  while (true) {
    visit(static_cast<const MultiIndex<dim>&>(index));
    int d = 0;
    while (d < dim && ++index[d] == box.upper[d]) {
      index[d] = box.lower[d];
      ++d;
    }
    if (d == dim) return;
  }
}

}  // namespace wisp
