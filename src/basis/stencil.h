// The seam: the grid functions that one material point touches, their values and gradients there. Grids and
// bases live below it; transfers, materials, boundaries, stabilisation and analyses above.
#pragma once
#include <array>
#include <cstddef>
#include <limits>

#include "basis/records.h"
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

  /// Whether all points of a cell have the same functions, so that it pays to sum over them first.
  static constexpr bool one_set_per_cell = width == 2;

  /// Calls f(k, i) for every function: its position in the stencil and its local index.
  template <class F>
  inline __attribute__((always_inline)) void for_each_function(F&& f) const {
    for_short<dim == 3 ? width : 1>([&](int c) __attribute__((always_inline)) {
      for_short<width>([&](int b) __attribute__((always_inline)) {
        for_short<width>([&](int a) __attribute__((always_inline)) {
          f(a + width * (b + width * c), base + a + b * stride[1] + c * stride[2]);
        });
      });
    });
  }

  /// Calls f(k, i, r), r = phi r.value + sum_d dphi_d r.gradient[d], for every function. Direction by
  /// direction, so that a function costs two operations and not 1 + dim. Without `with_gradient`, r.gradient
  /// is not used.
  template <int n, bool with_gradient, class F>
  inline __attribute__((always_inline)) void spread(const RecordAndGradient<dim, n>& r, F&& f) const {
    for_short<dim == 3 ? width : 1>([&](int c) __attribute__((always_inline)) {
      Record<n> plane = r.value, plane_x = r.gradient[0], plane_y = r.gradient[1];
      if constexpr (dim == 3) {
        const double w = value[2][c];
        plane = w * r.value;
        if constexpr (with_gradient)
          plane += derivative[2][c] * r.gradient[2], plane_x = w * plane_x, plane_y = w * plane_y;
      }
      for_short<width>([&](int b) __attribute__((always_inline)) {
        Record<n> row = value[1][b] * plane, row_x = plane_x;
        if constexpr (with_gradient) row += derivative[1][b] * plane_y, row_x = value[1][b] * plane_x;
        const int first = base + b * stride[1] + c * stride[2];
        for_short<width>([&](int a) __attribute__((always_inline)) {
          Record<n> sum = value[0][a] * row;
          if constexpr (with_gradient) sum += derivative[0][a] * row_x;
          f(a + width * (b + width * c), first + a, sum);
        });
      });
    });
  }

  /// sum phi_i r_i and, with gradients, sum dphi_i r_i of the records r_i of the functions.
  template <int n, bool with_gradient>
  inline __attribute__((always_inline)) RecordAndGradient<dim, n> sum_records(const double* records) const {
    RecordAndGradient<dim, n> sum;
    for_short<dim == 3 ? width : 1>([&](int c) __attribute__((always_inline)) {
      Record<n> plane{}, plane_x{}, plane_y{};
      for_short<width>([&](int b) __attribute__((always_inline)) {
        const double* const first =
            records + static_cast<std::ptrdiff_t>(base + b * stride[1] + c * stride[2]) * n;
        Record<n> row{}, row_x{};
        for_short<width>([&](int a) __attribute__((always_inline)) {
          Record<n> in;
          load_record<n>(first + a * n, in);
          row += value[0][a] * in;
          if constexpr (with_gradient) row_x += derivative[0][a] * in;
        });
        plane += value[1][b] * row;
        if constexpr (with_gradient) plane_x += value[1][b] * row_x, plane_y += derivative[1][b] * row;
      });
      if constexpr (dim == 2) {
        sum.value = plane, sum.gradient[0] = plane_x, sum.gradient[1] = plane_y;
      } else {
        sum.value += value[2][c] * plane;
        if constexpr (with_gradient) {
          sum.gradient[0] += value[2][c] * plane_x;
          sum.gradient[1] += value[2][c] * plane_y;
          sum.gradient[2] += derivative[2][c] * plane;
        }
      }
    });
    return sum;
  }
};

/// Calls f(k, i, r) with r = phi r.value + sum_d dphi_d r.gradient[d] for the functions of any stencil.
template <int dim, int n, bool with_gradient, class Stencil, class F>
inline __attribute__((always_inline)) void spread_over_functions(const Stencil& stencil,
                                                                 const RecordAndGradient<dim, n>& r, F&& f) {
  if constexpr (requires { stencil.template spread<n, with_gradient>(r, f); }) {
    stencil.template spread<n, with_gradient>(r, f);
  } else {
    stencil.for_each([&](int k, int i, double phi, const Vec<dim>& dphi) {
      Record<n> sum = phi * r.value;
      if constexpr (with_gradient)
        for (int d = 0; d < dim; ++d) sum += dphi[d] * r.gradient[d];
      f(k, i, sum);
    });
  }
}

/// Adds what points spread over their functions to the functions' records. Where all points of a cell have
/// the same functions, the sums of a cell stay in registers until the next cell. Call `finish` at the end.
template <int dim, int n, class Stencil>
class RecordSums {
 public:
  explicit RecordSums(double* records) : records_(records) {}

  /// Adds phi r.value + sum_d dphi_d r.gradient[d] to the record of every function of the stencil.
  template <bool with_gradient>
  inline __attribute__((always_inline)) void add(const Stencil& stencil, const RecordAndGradient<dim, n>& r) {
    if constexpr (by_cell) {
      if (stencil.key() != key_) {
        finish();
        cell_ = stencil, key_ = stencil.key();
      }
    }
    spread_over_functions<dim, n, with_gradient>(
        stencil, r, [&](int k, int i, const Record<n>& more) __attribute__((always_inline)) {
          if constexpr (by_cell)
            sums_[k] += more;
          else
            add_to(i, more);
        });
  }

  inline __attribute__((always_inline)) void finish() {
    if constexpr (by_cell) {
      if (key_ == none) return;
      cell_.for_each_function([&](int k, int i) __attribute__((always_inline)) {
        add_to(i, sums_[k]);
        sums_[k] = Record<n>{};
      });
      key_ = none;
    }
  }

 private:
  static constexpr bool by_cell = [] {
    if constexpr (requires { Stencil::one_set_per_cell; }) return Stencil::one_set_per_cell;
    return false;
  }();
  static constexpr int none = std::numeric_limits<int>::min();

  inline __attribute__((always_inline)) void add_to(int i, const Record<n>& more) {
    double* const record = records_ + static_cast<std::ptrdiff_t>(i) * n;
    Record<n> sum;
    load_record<n>(record, sum);
    sum += more;
    store_record<n>(sum, record);
  }

  double* const records_;
  int key_ = none;
  Stencil cell_{};  // of the sums
  Record<n> sums_[by_cell ? Stencil::max_functions : 1]{};
};

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
      load_record<n>(records + static_cast<std::ptrdiff_t>(i) * n, r);
      sum.value += phi * r;
      if constexpr (with_gradient)
        for (int d = 0; d < dim; ++d) sum.gradient[d] += dphi[d] * r;
    });
    return sum;
  }
}

/// What tabulates the points of a loop one after the other; a basis may have its own `Walk` that remembers
/// the cell of the last point.
template <class Basis>
class PlainWalk {
 public:
  explicit PlainWalk(const Basis& basis) : basis_(basis) {}
  template <class Position>
  inline __attribute__((always_inline)) auto tabulate(const Position& x, const Position& half_length) {
    return basis_.tabulate(x, half_length);
  }

 private:
  const Basis basis_;
};

template <class Basis>
inline __attribute__((always_inline)) auto walk(const Basis& basis) {
  if constexpr (requires { typename Basis::Walk; })
    return typename Basis::Walk(basis);
  else
    return PlainWalk<Basis>(basis);
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
