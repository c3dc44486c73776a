#include "stabilise/triangle_ghost.h"

#include <algorithm>

#include "basis/triangle_jumps.h"

namespace wisp {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Bits of bodies for which a triangle has a free edge: towards a triangle where they are not active, or of
/// the grid.
int boundary_bits(const Triangulation& mesh, const ActiveCells& active, const HeldEdges<2>& held, int t) {
  const int here = active.bits[at(t)];
  int bits = 0;
  for (int k = 0; k < 3; ++k) {
    const int u = mesh.neighbour(t, k);
    bits |= u >= 0 ? here & ~active.bits[at(u)] : held.holds(mesh.edge(t, k)) ? 0 : here;
  }
  return bits;
}

/// Bits of bodies of all triangles around the vertices of each.
std::vector<int> spread(const Triangulation& mesh, const std::vector<int>& bits) {
  std::vector<int> wide(bits.size(), 0);
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    int all = 0;
    for (const int t : mesh.triangles_of_vertex(v)) all |= bits[at(t)];
    for (const int t : mesh.triangles_of_vertex(v)) wide[at(t)] |= all;
  }
  return wide;
}

/// For each vertex the bodies that are not active in one of its triangles, or that have a free edge of the
/// grid there.
std::vector<int> open_vertices(const Triangulation& mesh, const ActiveCells& active,
                               const HeldEdges<2>& held) {
  std::vector<int> open(at(mesh.n_vertices()), 0);
  for (int v = 0; v < mesh.n_vertices(); ++v)
    for (const int t : mesh.triangles_of_vertex(v)) open[at(v)] |= ~active.bits[at(t)];
  for (int e = 0; e < mesh.n_edges(); ++e)
    if (mesh.edge(e).boundary() && !held.holds(e))
      for (const int v : mesh.edge(e).vertex) open[at(v)] = ~0;
  return open;
}

GhostFacet facet_of(int number, int direction, int bits, const std::vector<Body<2>>& bodies) {
  GhostFacet facet{{number, direction}, 0.0, 0.0};
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!(bits & (1 << b))) continue;
    facet.density = std::max(facet.density, bodies[b].density());
    facet.p_wave_modulus = std::max(facet.p_wave_modulus, bodies[b].p_wave_modulus());
  }
  return facet;
}

}  // namespace

std::vector<GhostFacet> triangle_ghost_facets(const Space<2>& space, const ActiveCells& active,
                                              const std::vector<Body<2>>& bodies, const HeldEdges<2>& held,
                                              GhostElements elements) {
  const Triangulation& mesh = space.triangulation();
  std::vector<int> all = active.bits, flagged(active.bits.size(), 0);  // A* and B, bits of bodies
  if (elements == GhostElements::boundary) {
    for (int t = 0; t < mesh.n_triangles(); ++t) flagged[at(t)] = boundary_bits(mesh, active, held, t);
  } else {
    all = spread(mesh, active.bits);
    const auto open = open_vertices(mesh, active, held);
    for (int t = 0; t < mesh.n_triangles(); ++t) {
      int bits = elements == GhostElements::ring_all ? ~0 : 0;
      for (const int v : mesh.triangle(t)) bits |= open[at(v)];
      flagged[at(t)] = all[at(t)] & bits;
    }
  }
  const bool splits = visit_on_triangles(space, [](const auto& basis) { return basis.continuity > 0; });
  std::vector<GhostFacet> facets;
  for (int e = 0; e < mesh.n_edges(); ++e) {
    const auto& [t, u] = mesh.edge(e).triangle;
    if (u < 0) continue;
    if (const int bits = all[at(t)] & all[at(u)] & (flagged[at(t)] | flagged[at(u)]))
      facets.push_back(facet_of(e, 0, bits, bodies));
  }
  for (int t = 0; splits && t < mesh.n_triangles(); ++t)
    if (flagged[at(t)]) facets.push_back(facet_of(t, 1, flagged[at(t)], bodies));
  return facets;
}

ActiveCells triangle_ghost_cells(const Space<2>& space, const ActiveCells& active, GhostElements elements) {
  if (elements == GhostElements::boundary) return active;
  return {spread(space.triangulation(), active.bits)};
}

namespace {

template <class F>
void for_each_rows(const Space<2>& space, const std::vector<GhostFacet>& facets, F&& f) {
  visit_on_triangles(space, [&](const auto& basis) {
    for (const auto& facet : facets)
      for (const auto& rows :
           facet.direction == 0 ? edge_jumps(basis, facet.lower) : inner_jumps(basis, facet.lower))
        f(facet, rows);
  });
}

}  // namespace

void add_triangle_ghost_pattern(const Space<2>& space, const std::vector<GhostFacet>& facets,
                                BlockMatrix& matrix) {
  for_each_rows(space, facets,
                [&](const GhostFacet&, const JumpRows& rows) { matrix.add_element(rows.function); });
}

void add_triangle_ghost(const Space<2>& space, const std::vector<GhostFacet>& facets,
                        const GhostOptions& options, GhostMatrix kind, BlockMatrix& matrix) {
  std::vector<double> dense;
  for_each_rows(space, facets, [&](const GhostFacet& facet, const JumpRows& rows) {
    const std::size_t n = rows.function.size();
    dense.assign(n * n, 0.0);
    const double factor = ghost_factor(options, kind, facet, rows.extent);
    for (std::size_t q = 0; q < rows.weight.size(); ++q) {
      const double* const jump = rows.jump.data() + q * n;
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) dense[i * n + j] += factor * rows.weight[q] * jump[i] * jump[j];
    }
    matrix.add_scalar(rows.function, dense.data());
  });
}

}  // namespace wisp
