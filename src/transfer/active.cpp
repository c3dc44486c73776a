#include "transfer/active.h"

#include "core/error.h"

namespace wisp {

template <int dim>
ActiveCells active_cells(const Space<dim>& space, const std::vector<Body<dim>>& bodies) {
  if (bodies.size() > 31) input_error("a run can have at most 31 bodies, found {}", bodies.size());
  if (!space.structured()) {
    ActiveCells active{std::vector<int>(static_cast<std::size_t>(space.n_cells()), 0)};
    for (std::size_t b = 0; b < bodies.size(); ++b)
      for (const int t : bodies[b].points.cell) active.bits[static_cast<std::size_t>(t)] |= 1 << b;
    return active;
  }
  const auto& window = space.window();
  const auto& grid = space.grid();
  ActiveCells active{std::vector<int>(static_cast<std::size_t>(window.n_cells()), 0)};
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Particles<dim>& points = bodies[b].points;
    for (std::size_t p = 0; p < points.position.size(); ++p) {
      IndexBox<dim> cells;
      for (int d = 0; d < dim; ++d) {
        const double x = points.position[p][d], l = space.domains() ? points.half_length[p][d] : 0.0;
        const int centre = grid.locate_inside(d, x);
        const double guard = 1e-12 * grid.spacing(d, centre);
        // Never smaller than the cell of the point itself, never beyond the edge of the grid.
        cells.lower[d] = std::max(0, std::min(centre, grid.locate(d, x - l + guard)));
        cells.upper[d] = 1 + std::min(grid.cells(d) - 1, std::max(centre, grid.locate(d, x + l - guard)));
      }
      for_each_in(cells, [&](const MultiIndex<dim>& c) {
        active.bits[static_cast<std::size_t>(window.cell_index(c))] |= 1 << b;
      });
    }
  }
  space.cells().bit_or(active.bits.data());
  return active;
}

template <int dim>
std::vector<char> active_functions(const Space<dim>& space, const ActiveCells& active) {
  if constexpr (dim == 2)
    if (!space.structured()) {
      std::vector<char> flags(static_cast<std::size_t>(space.n_functions()), 0);
      visit_on_triangles(space, [&](const auto& basis) {
        for (int t = 0; t < space.n_cells(); ++t)
          if (active.bits[static_cast<std::size_t>(t)] != 0)
            for (const int i : basis.functions(t)) flags[static_cast<std::size_t>(i)] = 1;
      });
      return flags;
    }
  const auto& window = space.window();
  // A ghost function may belong to an active cell outside the window, so owners are asked.
  std::vector<int> flags(static_cast<std::size_t>(window.n_nodes()), 0);
  for_each_in(window.owned_cells(), [&](const MultiIndex<dim>& c) {
    if (active.bits[static_cast<std::size_t>(window.cell_index(c))] == 0) return;
    for_each_in(space.functions_of_cell(c),
                [&](const MultiIndex<dim>& i) { flags[static_cast<std::size_t>(window.node_index(i))] = 1; });
  });
  space.nodes().bit_or(flags.data());
  return {flags.begin(), flags.end()};
}

template ActiveCells active_cells<2>(const Space<2>&, const std::vector<Body<2>>&);
template ActiveCells active_cells<3>(const Space<3>&, const std::vector<Body<3>>&);
template std::vector<char> active_functions<2>(const Space<2>&, const ActiveCells&);
template std::vector<char> active_functions<3>(const Space<3>&, const ActiveCells&);

}  // namespace wisp
