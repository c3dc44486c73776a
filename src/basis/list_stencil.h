// The stencil of a basis on an unstructured grid: a list of functions.
#pragma once
#include <array>
#include <cstddef>

#include "tensor/tensor.h"

namespace wisp {

/// Values and gradients of `n` functions at a point, function by function. `padded` entries are allocated, so
/// that a basis may write four at a time.
template <int dim, int n>
struct ListStencil {
  static constexpr int max_functions = n;
  static constexpr std::size_t padded = (n + 7) / 4 * 4;

  int cell;                     ///< that the point lies in
  std::array<int, n> function;  ///< local indices
  std::array<double, padded> value;
  std::array<std::array<double, padded>, dim> derivative;  ///< 1/m

  static constexpr int size() { return n; }
  /// Identifies the set of functions: equal keys, equal sets in the same order.
  int key() const { return cell; }

  /// Calls f(k, function, phi, dphi) for every function: position in the stencil, local index, value,
  /// gradient (1/m).
  template <class F>
  inline __attribute__((always_inline)) void for_each(F&& f) const {
    for (int k = 0; k < n; ++k) {
      const auto i = static_cast<std::size_t>(k);
      Vec<dim> dphi;
      for (int d = 0; d < dim; ++d) dphi[d] = derivative[static_cast<std::size_t>(d)][i];
      f(k, function[i], value[i], dphi);
    }
  }
};

}  // namespace wisp
