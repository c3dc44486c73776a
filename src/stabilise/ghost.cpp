#include "stabilise/ghost.h"

#include <algorithm>

#include "basis/bspline_jumps.h"
#include "core/error.h"
#include "stabilise/triangle_ghost.h"

namespace wisp {

namespace {

/// Bodies (bits) for which a cell is a boundary cell.
template <int dim>
int boundary_bits(const Space<dim>& space, const ActiveCells& active, const MultiIndex<dim>& cell,
                  const HeldEdges<dim>& held_edge) {
  const auto& window = space.window();
  const int here = active.bits[static_cast<std::size_t>(window.cell_index(cell))];
  if (here == 0) return 0;
  int bits = 0;
  for (int d = 0; d < dim; ++d)
    for (int side = 0; side < 2; ++side) {
      MultiIndex<dim> next = cell;
      next[d] += side == 0 ? -1 : 1;
      if (!window.cell_in_grid(next))
        bits |= held_edge.side[static_cast<std::size_t>(2 * d + side)] ? 0 : here;
      else
        bits |= here & ~active.bits[static_cast<std::size_t>(window.cell_index(next))];
    }
  return bits;
}

GhostElements on_triangles(GhostElements elements) {
  return elements == GhostElements::standard ? GhostElements::ring_all : elements;
}

}  // namespace

template <int dim>
std::vector<GhostFacet> ghost_facets(const Space<dim>& space, const ActiveCells& active,
                                     const std::vector<Body<dim>>& bodies, const HeldEdges<dim>& held_edge,
                                     GhostElements elements) {
  if constexpr (dim == 2)
    if (!space.structured())
      return triangle_ghost_facets(space, active, bodies, held_edge, on_triangles(elements));
  if (elements == GhostElements::ring || elements == GhostElements::ring_all)
    input_error("stabilisation: elements ring and ring-all need a triangulation");
  std::vector<GhostFacet> facets;
  const auto& window = space.window();
  for_each_in(window.owned_cells(), [&](const MultiIndex<dim>& cell) {
    const int index = window.cell_index(cell);
    const int here = active.bits[static_cast<std::size_t>(index)];
    if (here == 0) return;
    const int boundary = boundary_bits(space, active, cell, held_edge);
    for (int d = 0; d < dim; ++d) {
      MultiIndex<dim> next = cell;
      ++next[d];
      if (!window.cell_in_grid(next)) continue;
      const int both = here & active.bits[static_cast<std::size_t>(window.cell_index(next))];
      const int flagged = both & (boundary | (both ? boundary_bits(space, active, next, held_edge) : 0));
      if (flagged == 0) continue;
      GhostFacet facet{{index, d}, 0.0, 0.0};
      for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (!(flagged & (1 << b))) continue;
        facet.density = std::max(facet.density, bodies[b].density());
        facet.p_wave_modulus = std::max(facet.p_wave_modulus, bodies[b].p_wave_modulus());
      }
      facets.push_back(facet);
    }
  });
  return facets;
}

template <int dim>
ActiveCells ghost_cells(const Space<dim>& space, const ActiveCells& active, const GhostOptions& options) {
  if constexpr (dim == 2)
    if (!space.structured()) return triangle_ghost_cells(space, active, on_triangles(options.elements));
  return active;
}

double ghost_factor(const GhostOptions& options, GhostMatrix kind, const GhostFacet& facet,
                    double normal_extent) {
  const double h2 = normal_extent * normal_extent;
  const double gamma = kind == GhostMatrix::mass ? options.mass : options.stiffness;
  if (options.units == GhostUnits::paper)
    return gamma * (options.scale == GhostScale::figures ? 0.25 * h2 : 1.0);
  return kind == GhostMatrix::mass ? gamma * facet.density : gamma * facet.p_wave_modulus / h2;
}

namespace {

/// Calls f(facet, its jumps) on structured grids.
template <int dim, class F>
void for_each_jumps(const Space<dim>& space, const std::vector<GhostFacet>& facets, F&& f) {
  if (space.nodal())
    for (const auto& facet : facets) f(facet, facet_jumps<dim>(space, facet));
  else
    space.visit_splines([&](const auto& basis) {
      for (const auto& facet : facets) f(facet, bspline_jumps(space, basis, facet));
    });
}

}  // namespace

template <int dim>
void add_ghost_pattern(const Space<dim>& space, const std::vector<GhostFacet>& facets, BlockMatrix& matrix) {
  if constexpr (dim == 2)
    if (!space.structured()) {
      add_triangle_ghost_pattern(space, facets, matrix);
      return;
    }
  for_each_jumps(space, facets,
                 [&](const GhostFacet&, const auto& jumps) { matrix.add_element(jumps.function); });
}

template <int dim>
void add_ghost(const Space<dim>& space, const std::vector<GhostFacet>& facets, const GhostOptions& options,
               GhostMatrix kind, BlockMatrix& matrix) {
  if constexpr (dim == 2)
    if (!space.structured()) {
      add_triangle_ghost(space, facets, options, kind, matrix);
      return;
    }
  for_each_jumps(space, facets, [&](const GhostFacet& facet, const auto& jumps) {
    using Jumps = std::decay_t<decltype(jumps)>;
    constexpr std::size_t n = Jumps::n_functions;
    const double h = jumps.normal_extent;
    const double factor = ghost_factor(options, kind, facet, h) * jump_moment(Jumps::order, h);
    std::array<double, n * n> dense{};
    for (std::size_t q = 0; q < jumps.weight.size(); ++q)
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          dense[i * n + j] += factor * jumps.weight[q] * jumps.jump[q][i] * jumps.jump[q][j];
    matrix.add_scalar(jumps.function, dense.data());
  });
}

template std::vector<GhostFacet> ghost_facets<2>(const Space<2>&, const ActiveCells&,
                                                 const std::vector<Body<2>>&, const HeldEdges<2>&,
                                                 GhostElements);
template std::vector<GhostFacet> ghost_facets<3>(const Space<3>&, const ActiveCells&,
                                                 const std::vector<Body<3>>&, const HeldEdges<3>&,
                                                 GhostElements);
template ActiveCells ghost_cells<2>(const Space<2>&, const ActiveCells&, const GhostOptions&);
template ActiveCells ghost_cells<3>(const Space<3>&, const ActiveCells&, const GhostOptions&);
template void add_ghost_pattern<2>(const Space<2>&, const std::vector<GhostFacet>&, BlockMatrix&);
template void add_ghost_pattern<3>(const Space<3>&, const std::vector<GhostFacet>&, BlockMatrix&);
template void add_ghost<2>(const Space<2>&, const std::vector<GhostFacet>&, const GhostOptions&, GhostMatrix,
                           BlockMatrix&);
template void add_ghost<3>(const Space<3>&, const std::vector<GhostFacet>&, const GhostOptions&, GhostMatrix,
                           BlockMatrix&);

}  // namespace wisp
