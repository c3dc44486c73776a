// The seam: the grid functions that one material point touches, their values and gradients there. Grids and
// bases live below it; transfers, materials, boundaries, stabilisation and analyses above.
#pragma once
#include <array>

#include "parallel/window.h"
#include "tensor/tensor.h"

namespace wisp {

/// Stencil of a tensor-product basis on a structured grid: `width` functions a direction starting at function
/// `base`. Function (a, b[, c]) has the local index base + a + b stride[1] + c stride[2].
template <int dim, int width_>
struct TensorStencil {
  static constexpr int width = width_;
  static constexpr int max_functions = dim == 2 ? width * width : width * width * width;

  int base;                   ///< local index of the first function; the same for equal sets
  std::array<int, 3> stride;  ///< of the dense local numbering; stride[0] = 1
  std::array<std::array<double, width>, dim> value;       ///< 1D values
  std::array<std::array<double, width>, dim> derivative;  ///< 1D derivatives, 1/m

  static constexpr int size() { return max_functions; }
  /// Identifies the set of functions: equal keys, equal sets in the same order.
  int key() const { return base; }

  /// Calls f(k, function, phi, dphi) for every function: position in the stencil, local index, value,
  /// gradient (1/m).
  template <class F>
  inline __attribute__((always_inline)) void for_each(F&& f) const {
    if constexpr (dim == 2) {
      for (int b = 0; b < width; ++b) {
        const int row = base + b * stride[1];
        for (int a = 0; a < width; ++a) {
          const double wa = value[0][a], wb = value[1][b];
          f(a + width * b, row + a, wa * wb, Vec<2>(derivative[0][a] * wb, wa * derivative[1][b]));
        }
      }
    } else {
      for (int c = 0; c < width; ++c) {
        for (int b = 0; b < width; ++b) {
          const int row = base + b * stride[1] + c * stride[2];
          const double bc = value[1][b] * value[2][c];
          const double dbc = derivative[1][b] * value[2][c], bdc = value[1][b] * derivative[2][c];
          for (int a = 0; a < width; ++a) {
            const double wa = value[0][a];
            f(a + width * (b + width * c), row + a, wa * bc,
              Vec<3>(derivative[0][a] * bc, wa * dbc, wa * bdc));
          }
        }
      }
    }
  }
};

/// The dense local numbering of functions on a rank's window of a structured grid, as kernels need it: the
/// function of node i (multi-index of the whole grid) has the local index sum (i_d - lower_d) stride_d.
template <int dim>
struct NodeNumbering {
  std::array<int, dim> lower{};
  std::array<int, 3> stride{1, 0, 0};

  NodeNumbering() = default;
  explicit NodeNumbering(const Window<dim>& window) {
    for (int d = 0; d < dim; ++d) {
      const auto k = static_cast<std::size_t>(d);
      lower[k] = window.nodes().lower[d];
      stride[k] = window.node_strides()[d];
    }
  }
};

}  // namespace wisp
