// Generalised interpolation: hat functions averaged over each point's domain.
#pragma once
#include <algorithm>

#include "basis/options.h"
#include "basis/stencil.h"
#include "grid/structured.h"

namespace wisp {

/// GIMP functions (Bardenhagen and Kober 2004) with box domains of half-lengths l, which follow the stretch
/// (Charlton, Coombs and Augarde 2017). In one direction S_i = 1/(2l) integral over [x-l, x+l] of the hat
/// N_i, and dS_i that of its derivative. Each cell's share of the integral is exact by its midpoint, so one
/// formula holds for any l >= 0 and any spacing: it is the closed form [Psi(x+l) - Psi(x-l)]/(2l) without its
/// cancellation at small l.
///
/// `width` functions a direction: 3 as long as 2l is at most a cell side, 5 as long as 2l is at most three.
template <int dim, int width_>
class Gimp : public GimpOptions {
 public:
  static constexpr int width = width_;
  static constexpr int cells_touched = width - 1;
  static constexpr int degree = 1;
  static constexpr int continuity = 1;
  static constexpr bool non_negative = true;
  static constexpr bool uses_domains = true;
  using Stencil = TensorStencil<dim, width>;
  static_assert(width == 3 || width == 5);

  Gimp(const StructuredGrid<dim>& grid, const NodeNumbering<dim>& numbering)
      : grid_(&grid), numbering_(numbering) {}

  /// Overlaps smaller than this share of a cell are rounding, not contact, and count as touching.
  static constexpr double touching = 1e-12;

  /// Tabulates points one after the other and remembers the cell of the last one: points of one cell are
  /// located once.
  class Walk {
   public:
    explicit Walk(const Gimp& basis) : basis_(basis) {}
    inline __attribute__((always_inline)) Stencil tabulate(const Vec<dim>& x, const Vec<dim>& half_length) {
      if constexpr (width == 5) {
        return basis_.tabulate(x, half_length);
      } else {
        bool inside = true;
        for_short<dim>([&](int d) { inside &= (x[d] >= lower_[d]) & (x[d] < upper_[d]); });
        if (!inside) find(x);
        Stencil s;
        for_short<3>([&](int k) { s.stride[k] = basis_.numbering_.stride[k]; });
        s.base = base_;
        for_short<dim>([&](int d) {
          // A domain is at most as long as a cell: it starts in the point's cell or in the one below.
          const int below = lower_[d] - (x[d] - half_length[d]) > guard_[d];
          basis_.spread(d, cell_[d] - below, x[d], half_length[d], guard_[d], s.value[d], s.derivative[d]);
          s.base -= below * s.stride[d];
        });
        return s;
      }
    }

   private:
    inline __attribute__((always_inline)) void find(const Vec<dim>& x) {
      base_ = 0;
      const StructuredGrid<dim>& grid = *basis_.grid_;
      for_short<dim>([&](int d) {
        int i = grid.locate(d, x[d]);
        guard_[d] = touching * grid.spacing(d, i);
        if (grid.line(d, i + 1) - x[d] <= guard_[d]) ++i;
        i = std::clamp(i, 0, grid.cells(d) - 1);  // the upper edge belongs to the last cell
        cell_[d] = i;
        lower_[d] = grid.line(d, i), upper_[d] = grid.line(d, i + 1) - guard_[d];
        base_ += (i - basis_.numbering_.lower[d]) * basis_.numbering_.stride[d];
      });
    }

    const Gimp basis_;
    int base_ = 0;
    int cell_[dim] = {};
    double lower_[dim] = {}, upper_[dim] = {}, guard_[dim] = {};  // no point lies in this cell
  };

  /// Stencil at x inside the grid of a domain with half-lengths l (m), 2l at most (width-1)/2 ... see above.
  inline __attribute__((always_inline)) Stencil tabulate(const Vec<dim>& x,
                                                         const Vec<dim>& half_length) const {
    Stencil s;
    s.stride = numbering_.stride;
    s.base = 0;
    for_short<dim>([&](int d) {
      const int base = tabulate_direction(d, x[d], half_length[d], s.value[d], s.derivative[d]);
      s.base += (base - numbering_.lower[d]) * s.stride[d];
    });
    return s;
  }

 private:
  inline __attribute__((always_inline)) int tabulate_direction(int d, double x, double l,
                                                               std::array<double, width>& value,
                                                               std::array<double, width>& derivative) const {
    const double* const lines = grid_->lines(d);
    const double a = x - l, b = x + l;
    int first = grid_->locate(d, a);
    const double guard = touching * (lines[first + 1] - lines[first]);
    if (lines[first + 1] - a <= guard && l > 0) ++first;
    first = std::min(first, grid_->cells(d) - 1);  // the upper edge belongs to the last cell
    if constexpr (width == 3) {
      spread(d, first, x, l, guard, value, derivative);
      return first;
    } else {
      const double* const per_spacing = grid_->per_spacing(d);
      int centre = grid_->locate(d, x), last = grid_->locate(d, b);
      if (last > centre && b - lines[last] <= guard) --last;
      const int base = std::max(centre - 2, last - 3);
      value.fill(0.0);
      derivative.fill(0.0);
      const double per_length = l > 0 ? 0.5 / l : 0.0;
      double rest = 1.0;
      // From the highest cell down to the first: every cell but the first takes its share, the first the
      // rest, so that the shares sum to one to rounding and l = 0 needs no branch.
      for (int c = cells_touched - 1; c > 0; --c) {
        const int cell = base + c;
        const double from = std::max(a, lines[cell]), to = std::min(b, lines[cell + 1]);
        const double share = (to - from > guard && cell > first) ? (to - from) * per_length : 0.0;
        add_cell(lines, per_spacing, cell, c, 0.5 * (from + to), share, value, derivative);
        rest -= share;
      }
      const double from = std::max(a, lines[first]), to = std::max(from, std::min(b, lines[first + 1]));
      add_cell(lines, per_spacing, first, first - base, 0.5 * (from + to), rest, value, derivative);
      if (base < 0 || base + width - 1 > grid_->cells(d)) fold(d, base, value, derivative);
      return base;
    }
  }

  /// The three functions of a domain that starts in cell `first` and ends in it or in the next one. As above,
  /// with every number written once and no branch: which of the two it is changes from point to point.
  inline __attribute__((always_inline)) void spread(int d, int first, double x, double l, double guard,
                                                    std::array<double, width>& value,
                                                    std::array<double, width>& derivative) const {
    const double* const line = grid_->lines(d) + first;
    const double* const per_h = grid_->per_spacing(d) + first;
    const double low = line[0], middle = line[1], high = line[2], g0 = per_h[0], g1 = per_h[1];
    const double a = x - l, b = x + l;
    const double from = std::max(a, middle), to = std::min(b, high);
    const double upper_share = (to - from) * (0.5 / l);  // not a number where l = 0, and then not used
    const double s1 = to - from > guard ? upper_share : 0.0, s0 = 1.0 - s1;
    const double start = std::max(a, low), end = std::max(start, std::min(b, middle));
    const double r0 = (0.5 * (start + end) - low) * g0, r1 = (0.5 * (from + to) - middle) * g1;
    const double up = s0 * r0, down = s1 * (1.0 - r1), d0 = s0 * g0, d1 = s1 * g1;
    value = {s0 * (1.0 - r0), up + down, s1 * r1};
    derivative = {-d0, d0 - d1, d1};
    if (first < 0 || first + width - 1 > grid_->cells(d)) {
      // Through copies: arrays whose addresses are passed on could not stay in registers.
      std::array<double, width> v = value, dv = derivative;
      fold(d, first, v, dv);
      for_short<width>([&](int k) { value[k] = v[k], derivative[k] = dv[k]; });
    }
  }

  static inline __attribute__((always_inline)) void add_cell(const double* lines, const double* per_spacing,
                                                             int cell, int k, double middle, double share,
                                                             std::array<double, width>& value,
                                                             std::array<double, width>& derivative) {
    const double per_h = per_spacing[cell];
    const double r = (middle - lines[cell]) * per_h;
    const auto i = static_cast<std::size_t>(k);
    value[i] += share * (1.0 - r);
    value[i + 1] += share * r;
    derivative[i] -= share * per_h;
    derivative[i + 1] += share * per_h;
  }

  /// The part of a domain beyond the edge of the grid belongs to the edge function, as if it continued there
  /// as the constant 1: the functions keep summing to one and no mass goes to functions outside the grid.
  __attribute__((noinline)) void fold(int d, int base, std::array<double, width>& value,
                                      std::array<double, width>& derivative) const {
    for (int k = 0; k < width; ++k) {
      const int node = base + k;
      const int inside = std::clamp(node, 0, grid_->cells(d));
      if (inside == node) continue;
      const auto from = static_cast<std::size_t>(k), to = static_cast<std::size_t>(inside - base);
      value[to] += value[from], derivative[to] += derivative[from];
      value[from] = 0.0, derivative[from] = 0.0;
    }
  }

  const StructuredGrid<dim>* grid_;
  NodeNumbering<dim> numbering_;
};

}  // namespace wisp
