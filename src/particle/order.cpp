#include "particle/order.h"

namespace wisp {

template <int dim>
Location locate(Particles<dim>& points, const StructuredGrid<dim>& grid, const Window<dim>& window) {
  Location found;
  const int n = points.size();
  points.cell.resize(static_cast<std::size_t>(n));
  int before = -1;
  for (int p = 0; p < n; ++p) {
    const Vec<dim>& x = points.position[static_cast<std::size_t>(p)];
    MultiIndex<dim> cell;
    bool inside = true, here = true;
    for (int d = 0; d < dim; ++d) {
      cell[d] = grid.locate_inside(d, x[d]);
      inside &= cell[d] >= 0 && cell[d] < grid.cells(d);
      here &= cell[d] >= window.owned_cells().lower[d] && cell[d] < window.owned_cells().upper[d];
    }
    int index = -1;
    if (inside && here) {
      index = window.cell_index(cell);
      found.disorder += index < before;
      before = index;
    } else if (inside) {
      index = -2;
      ++found.elsewhere;
    } else {
      ++found.outside;
    }
    points.cell[static_cast<std::size_t>(p)] = index;
  }
  return found;
}

template <int dim>
void reorder(Body<dim>& body, int n_cells) {
  const auto& cell = body.points.cell;
  const std::size_t n = cell.size();
  std::vector<int> start(static_cast<std::size_t>(n_cells) + 1, 0);
  for (const int c : cell) ++start[static_cast<std::size_t>(c) + 1];
  for (std::size_t c = 0; c < static_cast<std::size_t>(n_cells); ++c) start[c + 1] += start[c];
  std::vector<int> from(n);
  for (std::size_t p = 0; p < n; ++p)
    from[static_cast<std::size_t>(start[static_cast<std::size_t>(cell[p])]++)] = static_cast<int>(p);

  const auto move = [&](std::string_view, auto& field) {
    if (field.empty()) return;
    std::decay_t<decltype(field)> scratch(field.size());
    for (std::size_t p = 0; p < n; ++p) scratch[p] = field[static_cast<std::size_t>(from[p])];
    field.swap(scratch);
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
template void reorder<2>(Body<2>&, int);
template void reorder<3>(Body<3>&, int);
template void remove<2>(Body<2>&, const std::vector<char>&);
template void remove<3>(Body<3>&, const std::vector<char>&);

}  // namespace wisp
