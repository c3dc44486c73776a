// The seam: the grid functions that one material point touches, their values and gradients there. Grids and
// bases live below it; transfers, materials, boundaries, stabilisation and analyses above.
#pragma once
#include <array>
#include <cstddef>
#include <cstring>

#include "parallel/window.h"
#include "tensor/tensor.h"

namespace wisp {

/// `n` numbers (a power of two) that belong to one grid function, as one register however wide the machine's
/// are.
template <int n>
struct RecordTypes {
  using Value __attribute__((vector_size(n * sizeof(double)))) = double;
};
template <int n>
using Record = typename RecordTypes<n>::Value;

/// Records lie in arrays of doubles, which are aligned to doubles only.
template <int n>
inline __attribute__((always_inline)) void load_record(const double* from, Record<n>& r) {
  std::memcpy(&r, from, sizeof r);
}
template <int n>
inline __attribute__((always_inline)) void store_record(const Record<n>& r, double* to) {
  std::memcpy(to, &r, sizeof r);
}

/// A record and one for each direction.
template <int dim, int n>
struct RecordAndGradient {
  Record<n> value{};
  Record<n> gradient[dim]{};
};

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

  /// Adds phi r.value + sum_d dphi_d r.gradient[d] to the record of every function. Direction by direction,
  /// so that a function costs two operations and not 1 + dim.
  template <int n>
  inline __attribute__((always_inline)) void add_records(const RecordAndGradient<dim, n>& r,
                                                         double* records) const {
    constexpr int planes = dim == 3 ? width : 1;
    for (int c = 0; c < planes; ++c) {
      Record<n> plane = r.value, plane_x = r.gradient[0], plane_y = r.gradient[1];
      if constexpr (dim == 3) {
        const double w = value[2][c];
        plane = w * r.value + derivative[2][c] * r.gradient[2];
        plane_x *= w, plane_y *= w;
      }
      for (int b = 0; b < width; ++b) {
        const Record<n> row = value[1][b] * plane + derivative[1][b] * plane_y;
        const Record<n> row_x = value[1][b] * plane_x;
        double* const first = records + static_cast<std::ptrdiff_t>(base + b * stride[1] + c * stride[2]) * n;
        for (int a = 0; a < width; ++a) {
          double* const out = first + a * n;
          Record<n> sum;
          load_record<n>(out, sum);
          sum = sum + value[0][a] * row + derivative[0][a] * row_x;
          store_record<n>(sum, out);
        }
      }
    }
  }

  /// sum phi_i r_i and, with gradients, sum dphi_i r_i of the records r_i of the functions.
  template <int n, bool with_gradient>
  inline __attribute__((always_inline)) RecordAndGradient<dim, n> sum_records(const double* records) const {
    constexpr int planes = dim == 3 ? width : 1;
    RecordAndGradient<dim, n> sum;
    for (int c = 0; c < planes; ++c) {
      RecordAndGradient<2, n> plane;
      for (int b = 0; b < width; ++b) {
        const double* const first =
            records + static_cast<std::ptrdiff_t>(base + b * stride[1] + c * stride[2]) * n;
        Record<n> row{}, row_x{};
        for (int a = 0; a < width; ++a) {
          Record<n> in;
          load_record<n>(first + a * n, in);
          row += value[0][a] * in;
          if constexpr (with_gradient) row_x += derivative[0][a] * in;
        }
        plane.value += value[1][b] * row;
        if constexpr (with_gradient) {
          plane.gradient[0] += value[1][b] * row_x;
          plane.gradient[1] += derivative[1][b] * row;
        }
      }
      if constexpr (dim == 2) {
        sum = plane;
      } else {
        sum.value += value[2][c] * plane.value;
        if constexpr (with_gradient) {
          sum.gradient[0] += value[2][c] * plane.gradient[0];
          sum.gradient[1] += value[2][c] * plane.gradient[1];
          sum.gradient[2] += derivative[2][c] * plane.value;
        }
      }
    }
    return sum;
  }
};

/// Adds phi r.value + sum_d dphi_d r.gradient[d] to the records of the functions of any stencil.
template <int dim, int n, class Stencil>
inline __attribute__((always_inline)) void add_to_functions(const Stencil& stencil,
                                                            const RecordAndGradient<dim, n>& r,
                                                            double* records) {
  if constexpr (requires { stencil.add_records(r, records); }) {
    stencil.add_records(r, records);
  } else {
    stencil.for_each([&](int, int i, double phi, const Vec<dim>& dphi) {
      Record<n> sum = phi * r.value;
      for (int d = 0; d < dim; ++d) sum += dphi[d] * r.gradient[d];
      for (int k = 0; k < n; ++k) records[static_cast<std::ptrdiff_t>(i) * n + k] += sum[k];
    });
  }
}

/// sum phi_i r_i and, with gradients, sum dphi_i r_i of the records r_i of the functions of any stencil.
template <int dim, int n, bool with_gradient, class Stencil>
inline __attribute__((always_inline)) RecordAndGradient<dim, n> sum_of_functions(const Stencil& stencil,
                                                                                 const double* records) {
  if constexpr (requires { stencil.template sum_records<n, with_gradient>(records); }) {
    return stencil.template sum_records<n, with_gradient>(records);
  } else {
    RecordAndGradient<dim, n> sum;
    stencil.for_each([&](int, int i, double phi, const Vec<dim>& dphi) {
      Record<n> r;
      for (int k = 0; k < n; ++k) r[k] = records[static_cast<std::ptrdiff_t>(i) * n + k];
      sum.value += phi * r;
      if constexpr (with_gradient)
        for (int d = 0; d < dim; ++d) sum.gradient[d] += dphi[d] * r;
    });
    return sum;
  }
}

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
