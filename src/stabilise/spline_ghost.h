// Ghost stabilisation of Powell–Sabin splines: penalises jumps of second (of cubics also third) derivatives
// near the edge of the body.
#pragma once
#include <span>
#include <vector>

#include "basis/spline_jumps.h"
#include "linear/block_matrix.h"

namespace wisp {

/// Which triangles take part, beside those that hold points.
enum class GhostRing {
  populated,  ///< the populated ones alone, all penalised: enough for cubics
  ring,       ///< and their neighbours by vertex; those at the edge of the body are penalised
  ringall,    ///< and their neighbours by vertex, all penalised
};
template <>
inline constexpr auto choices<GhostRing> = choice_list<GhostRing>({{"populated", GhostRing::populated},
                                                                   {"ring", GhostRing::ring},
                                                                   {"ringall", GhostRing::ringall}});

/// Flags of triangles. All functions of active ones are active.
struct GhostTriangles {
  std::vector<char> active;
  std::vector<char> penalised;
};

/// @param populated flag of each triangle: does it hold points?
/// @param free_edge flag of each edge: is it on the boundary without a condition? Empty: all on the boundary
/// ring: penalised are the active triangles with a vertex on an unpopulated triangle or on a free edge.
GhostTriangles ghost_triangles(const Triangulation& triangulation, std::span<const char> populated,
                               GhostRing ring, std::span<const char> free_edge = {});

struct SplineGhost {
  double factor =
      1.0;  ///< of the penalty: gamma rho for a mass, kg/m3; gamma times a modulus / m² for a stiffness
  JumpLength length = JumpLength::element;
  /// Of the weights on the split edges that end on edges of the triangulation.
  double split_share = 1.0;
};

/// Calls f(jumps) for every penalised edge: the split edges inside penalised triangles, and the edges between
/// two active triangles of which at least one is penalised.
template <class Spline, class F>
void for_each_ghost_jump(const Spline& basis, const GhostTriangles& triangles, const SplineGhost& ghost,
                         F&& f) {
  const auto& mesh = basis.triangulation();
  for (int t = 0; t < mesh.n_triangles(); ++t) {
    if (!triangles.penalised[static_cast<std::size_t>(t)]) continue;
    for (int k = 0; k < 3; ++k)
      for (const bool to_corner : {true, false})
        f(split_edge_jumps(basis, t, k, to_corner, ghost.length, ghost.split_share));
  }
  for (int e = 0; e < mesh.n_edges(); ++e) {
    const auto& edge = mesh.edge(e);
    if (edge.boundary()) continue;
    const auto a = static_cast<std::size_t>(edge.triangle[0]), b = static_cast<std::size_t>(edge.triangle[1]);
    if (triangles.active[a] && triangles.active[b] && (triangles.penalised[a] || triangles.penalised[b]))
      f(edge_jumps(basis, e, ghost.length));
  }
}

/// Lets the pattern of a matrix couple the functions across the penalised edges.
template <class Spline>
void add_ghost_pattern(const Spline& basis, const GhostTriangles& triangles, BlockMatrix& matrix);

/// Adds factor x sum over penalised edges of (h^5/20) integral of [[d_nn phi_i]] [[d_nn phi_j]] (of cubics
/// also (h^7/252) of the third derivatives'), times the identity if the matrix has blocks. Polynomials of the
/// splines' degree are not felt.
template <class Spline>
void add_ghost(const Spline& basis, const GhostTriangles& triangles, const SplineGhost& ghost,
               BlockMatrix& matrix);

}  // namespace wisp
