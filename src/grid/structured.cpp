#include "grid/structured.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace wisp {

namespace {
constexpr const char* direction_name = "xyz";

std::vector<double> equal_lines(double lower, double upper, int cells) {
  std::vector<double> lines(static_cast<std::size_t>(cells) + 1);
  for (int i = 0; i <= cells; ++i) {
    // Exact at both ends, and symmetric: each line is one rounding away from its true place.
    lines[static_cast<std::size_t>(i)] = i == cells ? upper : lower + (upper - lower) * i / cells;
  }
  return lines;
}
}  // namespace

template <int dim>
void StructuredGrid<dim>::set_lines(int d, const std::vector<double>& lines) {
  const int n = static_cast<int>(lines.size()) - 1;
  const char name = direction_name[d];
  if (n < 1) input_error("grid: direction {} needs at least two grid lines, found {}", name, n + 1);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!std::isfinite(lines[i]))
      input_error("grid: line {} in direction {} is not a finite number", i, name);
    if (i > 0 && !(lines[i] > lines[i - 1]))
      input_error("grid: lines in direction {} must increase, but line {} = {} follows {}", name, i, lines[i],
                  lines[i - 1]);
  }
  cells_[d] = n;
  const double first = lines[1] - lines[0],
               last = lines[static_cast<std::size_t>(n)] - lines[static_cast<std::size_t>(n) - 1];
  auto& padded = lines_[d];
  padded.clear();
  for (int i = padding; i > 0; --i) padded.push_back(lines.front() - i * first);
  padded.insert(padded.end(), lines.begin(), lines.end());
  for (int i = 1; i <= padding; ++i) padded.push_back(lines.back() + i * last);
  per_spacing_[d].clear();
  for (std::size_t i = 1; i < padded.size(); ++i)
    per_spacing_[d].push_back(1.0 / (padded[i] - padded[i - 1]));

  const double length = lines.back() - lines.front();
  double shortest = length;
  uniform_[d] = true;
  for (int i = 0; i < n; ++i) {
    const double h = spacing(d, i);
    shortest = std::min(shortest, h);
    if (std::abs(h - length / n) > 1e-9 * length / n) uniform_[d] = false;
  }
  shortest_side_ = d == 0 ? shortest : std::min(shortest_side_, shortest);
  origin_[d] = uniform_[d] ? lines.front() : padded.front();
  // For unequal spacing the same quotient finds a bin; about as many bins as lines keep the search after it
  // short.
  const double extent = padded.back() - padded.front();
  const int bins = n + 2 * padding;
  per_length_[d] = uniform_[d] ? n / length : bins / extent;
  if (!uniform_[d]) origin_[d] = padded.front() + padding * extent / bins;
  limit_[d] = n + padding;
  start_[d].clear();
  if (!uniform_[d]) {
    int cell = -padding;
    for (int bin = -padding; bin < n + padding; ++bin) {
      const double x = origin_[d] + bin * extent / bins;
      while (cell < n + padding - 1 && x >= line(d, cell + 1)) ++cell;
      start_[d].push_back(cell);
    }
  }
}

template <int dim>
StructuredGrid<dim>::StructuredGrid(const Vec<dim>& lower, const Vec<dim>& upper, const Multi& cells) {
  for (int d = 0; d < dim; ++d) {
    if (!(lower[d] < upper[d]))
      input_error("grid: lower {} is not below upper {} in direction {}", lower[d], upper[d],
                  direction_name[d]);
    if (cells[d] < 1) input_error("grid: direction {} needs at least one cell", direction_name[d]);
    set_lines(d, equal_lines(lower[d], upper[d], cells[d]));
  }
}

template <int dim>
StructuredGrid<dim>::StructuredGrid(const std::array<std::vector<double>, dim>& lines) {
  for (int d = 0; d < dim; ++d) set_lines(d, lines[static_cast<std::size_t>(d)]);
}

template <int dim>
StructuredGrid<dim>::StructuredGrid(const StructuredGridOptions& options) {
  const bool corners = !options.lower.empty() || !options.upper.empty() || !options.cells.empty();
  const bool coordinates = !options.coordinates.empty();
  if (corners == coordinates) input_error("grid: give either lower, upper and cells, or coordinates");
  if (coordinates) {
    if (options.coordinates.size() != dim)
      input_error("grid: coordinates needs {} lists of grid lines, found {}", dim,
                  options.coordinates.size());
    for (int d = 0; d < dim; ++d) set_lines(d, options.coordinates[static_cast<std::size_t>(d)]);
    return;
  }
  if (options.lower.size() != dim || options.upper.size() != dim || options.cells.size() != dim)
    input_error("grid: lower, upper and cells need {} values each", dim);
  Vec<dim> lower, upper;
  Multi cells;
  for (int d = 0; d < dim; ++d) {
    const auto i = static_cast<std::size_t>(d);
    lower[d] = options.lower[i], upper[d] = options.upper[i], cells[d] = options.cells[i];
  }
  *this = StructuredGrid(lower, upper, cells);
}

template <int dim>
Vec<dim> StructuredGrid<dim>::lower() const {
  return node(Multi::Zero());
}

template <int dim>
Vec<dim> StructuredGrid<dim>::upper() const {
  return node(cells_);
}

template <int dim>
Vec<dim> StructuredGrid<dim>::node(const Multi& i) const {
  Vec<dim> x;
  for (int d = 0; d < dim; ++d) x[d] = line(d, i[d]);
  return x;
}

template class StructuredGrid<2>;
template class StructuredGrid<3>;

}  // namespace wisp
