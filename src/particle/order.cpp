#include "particle/order.h"

#include <algorithm>
#include <bit>
#include <new>
#include <type_traits>

namespace wisp {

namespace {

/// Local cell index of a point that is not plainly in a cell of this rank: on the upper edge of the grid,
/// with another rank (-2) or outside (-1).
template <int dim>
int locate_at_edge(const Vec<dim>& x, const StructuredGrid<dim>& grid, const Window<dim>& window,
                   Location& found) {
  MultiIndex<dim> cell;
  for (int d = 0; d < dim; ++d) {
    cell[d] = grid.locate_inside(d, x[d]);
    if (cell[d] < 0 || cell[d] >= grid.cells(d)) return ++found.outside, -1;
  }
  if (!window.owns_cell(cell)) return ++found.elsewhere, -2;
  return window.cell_index(cell);
}

}  // namespace

template <int dim>
Location locate(Particles<dim>& points, const StructuredGrid<dim>& grid, const Window<dim>& window) {
  Location found;
  const int n = points.size();
  points.cell.resize(static_cast<std::size_t>(n));
  const Vec<dim>* const position = points.position.data();
  int* const cells = points.cell.data();
  const IndexBox<dim> owned = window.owned_cells();
  const MultiIndex<dim> lower = window.cells().lower, strides = window.cell_strides();
  int before = -1;
  double low[dim] = {}, high[dim] = {};  // of the cell `before`: no point lies in the first one
  for (int p = 0; p < n; ++p) {
    const Vec<dim>& x = position[p];
    bool same = true;
    for (int d = 0; d < dim; ++d) same &= (x[d] >= low[d]) & (x[d] < high[d]);
    if (same) {
      cells[p] = before;
      continue;
    }
    bool here = true;
    int index = 0;
    for (int d = 0; d < dim; ++d) {
      const int c = grid.locate(d, x[d]);
      low[d] = grid.line(d, c), high[d] = grid.line(d, c + 1);
      here &= c >= owned.lower[d] && c < owned.upper[d];
      index += (c - lower[d]) * strides[d];
    }
    if (!here) {
      index = locate_at_edge(x, grid, window, found);
      high[0] = low[0];  // not a cell whose next point we would know
    }
    if (index >= 0) {
      found.disorder += index < before;
      before = index;
    }
    cells[p] = index;
  }
  return found;
}

Location locate(Particles<2>& points, const Triangulation& triangulation) {
  Location found;
  points.cell.resize(points.position.size(), -1);
  int before = -1;
  for (std::size_t p = 0; p < points.position.size(); ++p) {
    const int hint =
        points.cell[p] >= 0 && points.cell[p] < triangulation.n_triangles() ? points.cell[p] : before;
    const int t = triangulation.locate(points.position[p], hint);
    points.cell[p] = t;
    found.outside += t < 0;
    if (t < 0) continue;
    found.disorder += t < before;
    before = t;
  }
  return found;
}

namespace {

/// field[p] = old field[from[p]]. `reach` is the most by which from[p] lies below p: as much of the
/// overwritten values is kept aside, in a ring that stays in the cache as points do not go far.
template <class T>
void permute(std::vector<T>& field, const std::vector<int>& from, std::size_t first, std::size_t last,
             std::size_t reach, std::vector<OrderMemory::Line>& memory) {
  static_assert(std::is_trivially_destructible_v<T> && alignof(T) <= sizeof(OrderMemory::Line));
  constexpr std::size_t block = 1024;
  const std::size_t mask = std::bit_ceil(reach + block) - 1;
  const std::size_t size = (mask + 1) * sizeof(T) / sizeof(OrderMemory::Line) + 1;
  if (memory.size() < size) memory.resize(size);
  T* const kept = static_cast<T*>(static_cast<void*>(memory.data()));
  for (std::size_t start = first; start < last; start += block) {
    const std::size_t end = std::min(start + block, last);
    for (std::size_t p = start; p < end; ++p) new (kept + (p & mask)) T(field[p]);
    for (std::size_t p = start; p < end; ++p) {
      const auto source = static_cast<std::size_t>(from[p]);
      field[p] = source < end ? kept[source & mask] : field[source];
    }
  }
}

}  // namespace

template <int dim>
void reorder(Body<dim>& body, int n_cells, OrderMemory& memory) {
  const auto& cell = body.points.cell;
  const std::size_t n = cell.size();
  std::vector<int>&start = memory.start, &from = memory.from;
  start.assign(static_cast<std::size_t>(n_cells) + 1, 0);
  for (const int c : cell) ++start[static_cast<std::size_t>(c) + 1];
  for (std::size_t c = 0; c < static_cast<std::size_t>(n_cells); ++c) start[c + 1] += start[c];
  from.resize(n);
  for (std::size_t p = 0; p < n; ++p)
    from[static_cast<std::size_t>(start[static_cast<std::size_t>(cell[p])]++)] = static_cast<int>(p);

  // The points that move at all lie in [first, last).
  std::size_t first = 0, last = n, reach = 0;
  while (first < n && from[first] == static_cast<int>(first)) ++first;
  while (last > first && from[last - 1] == static_cast<int>(last - 1)) --last;
  for (std::size_t p = first; p < last; ++p)
    if (const auto source = static_cast<std::size_t>(from[p]); source < p)
      reach = std::max(reach, p - source);
  if (first == last) return;
  const auto move = [&](std::string_view, auto& field) {
    if (!field.empty()) permute(field, from, first, last, reach, memory.kept);
  };
  body.for_each_field(move);
  move("cell", body.points.cell);
}

template <int dim>
void remove(Body<dim>& body, const std::vector<char>& gone) {
  const auto keep = [&](std::string_view, auto& field) {
    if (field.empty()) return;
    std::size_t to = 0;
    for (std::size_t p = 0; p < gone.size(); ++p)
      if (!gone[p]) field[to++] = field[p];
    field.resize(to);
  };
  body.for_each_field(keep);
  keep("cell", body.points.cell);
}

template Location locate<2>(Particles<2>&, const StructuredGrid<2>&, const Window<2>&);
template Location locate<3>(Particles<3>&, const StructuredGrid<3>&, const Window<3>&);
template void reorder<2>(Body<2>&, int, OrderMemory&);
template void reorder<3>(Body<3>&, int, OrderMemory&);
template void remove<2>(Body<2>&, const std::vector<char>&);
template void remove<3>(Body<3>&, const std::vector<char>&);

}  // namespace wisp
