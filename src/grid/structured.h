// Structured grids of quads and hexes with equal or unequal spacing. A value: no fields live here.
#pragma once
#include <array>
#include <vector>

#include "grid/structured_options.h"
#include "parallel/index_box.h"
#include "tensor/tensor.h"

namespace wisp {

/// Grid lines in each direction; cell c lies between lines c and c+1. Lines are continued beyond the edge of
/// the grid by `padding` phantom lines with the spacing of the last cell, so that kernels need no special
/// case there.
template <int dim>
class StructuredGrid {
 public:
  static constexpr int padding = 4;
  using Multi = MultiIndex<dim>;

  /// Equal spacing between two corners. Errors (InputError): lower not below upper, cells < 1.
  StructuredGrid(const Vec<dim>& lower, const Vec<dim>& upper, const Multi& cells);
  /// Given lines in each direction. Errors (InputError): fewer than two lines, lines not increasing or not
  /// finite.
  explicit StructuredGrid(const std::array<std::vector<double>, dim>& lines);
  /// From a case file. Errors (InputError): neither or both of (lower, upper, cells) and coordinates given.
  explicit StructuredGrid(const StructuredGridOptions& options);

  int cells(int d) const { return cells_[d]; }
  Multi cells() const { return cells_; }
  /// Coordinate of line i in direction d, -padding <= i <= cells + padding.
  double line(int d, int i) const { return lines_[d][static_cast<std::size_t>(i + padding)]; }
  /// Lines of direction d shifted so that `lines(d)[i]` is line i; valid from -padding to cells + padding.
  const double* lines(int d) const { return lines_[d].data() + padding; }
  double spacing(int d, int cell) const { return line(d, cell + 1) - line(d, cell); }
  /// 1/m, for kernels: `per_spacing(d)[c]` is the inverse of spacing(d, c), -padding <= c < cells + padding.
  const double* per_spacing(int d) const { return per_spacing_[d].data() + padding; }
  Vec<dim> lower() const;
  Vec<dim> upper() const;
  double shortest_side() const { return shortest_side_; }
  Vec<dim> node(const Multi& i) const;

  /// Cell of coordinate x in direction d: lower line <= x < upper line, also among the phantom cells; beyond
  /// those the result is clamped to the outermost phantom cell. NaN gives the lowest phantom cell.
  int locate(int d, double x) const {
    const double* lines = this->lines(d);
    const double s = (x - origin_[d]) * per_length_[d];
    int i = s > -padding ? (s < limit_[d] ? static_cast<int>(s + padding) - padding : cells_[d] + padding - 1)
                         : -padding;
    if (!uniform_[d]) i = start_[d][static_cast<std::size_t>(i + padding)];
    while (i < cells_[d] + padding - 1 && x >= lines[i + 1]) ++i;
    while (i > -padding && x < lines[i]) --i;
    return i;
  }
  /// Like locate, but the upper edge of the grid belongs to the last cell. Outside the grid: -1 or cells(d).
  int locate_inside(int d, double x) const {
    const int i = locate(d, x);
    if (i < 0 || !(x >= line(d, 0))) return -1;
    if (i >= cells_[d]) return x == line(d, cells_[d]) ? cells_[d] - 1 : cells_[d];
    return i;
  }

 private:
  void set_lines(int d, const std::vector<double>& lines);

  Multi cells_ = Multi::Zero();
  std::array<std::vector<double>, dim> lines_, per_spacing_;
  std::array<double, dim> origin_{};
  std::array<double, dim> per_length_{};
  std::array<double, dim> limit_{};
  std::array<bool, dim> uniform_{};
  std::array<std::vector<int>, dim> start_;  // for unequal spacing: a cell near the start of each bin
  double shortest_side_ = 0.0;
};

}  // namespace wisp
