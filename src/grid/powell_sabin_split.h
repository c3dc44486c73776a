// The Powell–Sabin split: every triangle into six, so that smooth piecewise quadratics and cubics exist.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "grid/control_triangle.h"
#include "grid/triangulation.h"

namespace wisp {

/// A point in one of the six sub-triangles of a triangle. Sub-triangle 2k + side lies at edge k: its corners
/// are corner k + side of the triangle (`near`), the edge's split point R_k and the inner point Z.
struct SplitPoint {
  int edge = 0;                   ///< k, 0..2
  int side = 0;                   ///< 0: at corner k, 1: at corner k+1
  std::array<double, 3> share{};  ///< barycentric coordinates in near corner, R_k, Z; never below zero
};

/// Inner points (incentres) and split points of edges. The split point of an inner edge lies on the line
/// between the two inner points, that of a boundary edge in the middle (de Koster 2018, section 3.5.1).
class PowellSabinSplit {
 public:
  explicit PowellSabinSplit(const Triangulation& triangulation);

  const Triangulation& triangulation() const { return *triangulation_; }

  /// Z and its barycentric coordinates in its triangle.
  Vec<2> centre(int t) const { return triangulation_->point(t, centre_barycentric(t)); }
  const std::array<double, 3>& centre_barycentric(int t) const {
    return centres_[static_cast<std::size_t>(t)];
  }
  /// R = share V_0 + (1 - share) V_1 of an edge with its vertices in their order.
  double edge_share(int e) const { return edge_shares_[static_cast<std::size_t>(e)]; }
  Vec<2> edge_point(int e) const {
    const auto& edge = triangulation_->edge(e);
    return edge_share(e) * triangulation_->vertex(edge.vertex[0]) +
           (1.0 - edge_share(e)) * triangulation_->vertex(edge.vertex[1]);
  }
  /// R_k = share V_k + (1 - share) V_{k+1} as triangle t sees it.
  double share(int t, int k) const {
    const int e = triangulation_->edge(t, k);
    const bool first =
        triangulation_->edge(e).vertex[0] == triangulation_->triangle(t)[static_cast<std::size_t>(k)];
    return first ? edge_share(e) : 1.0 - edge_share(e);
  }
  /// R = share Z_0 + (1 - share) Z_1 with the inner points of an inner edge's triangles; 1 on the boundary.
  double centre_share(int e) const { return centre_shares_[static_cast<std::size_t>(e)]; }

  /// The sub-triangle that holds a point of triangle t, by its barycentric coordinates there.
  SplitPoint locate(int t, const std::array<double, 3>& barycentric) const {
    const auto& a = centre_barycentric(t);
    return locate(barycentric, a, {share(t, 0), share(t, 1), share(t, 2)});
  }
  /// The same from the split's numbers: barycentric coordinates of Z and shares of the three edges.
  static SplitPoint locate(const std::array<double, 3>& b, const std::array<double, 3>& centre,
                           const std::array<double, 3>& share) {
    // The point is nearest to the edge whose opposite corner has the least coordinate in units of Z's.
    const double r0 = b[0] * (centre[1] * centre[2]), r1 = b[1] * (centre[2] * centre[0]),
                 r2 = b[2] * (centre[0] * centre[1]);
    const int opposite = r0 < r1 ? (r0 < r2 ? 0 : 2) : (r1 < r2 ? 1 : 2);
    const int k = next(opposite), next_k = next(k);
    const auto i = static_cast<std::size_t>(k), j = static_cast<std::size_t>(next_k),
               o = static_cast<std::size_t>(opposite);
    const double z = b[o] / centre[o], s = share[i];
    const double to_i = b[i] - z * centre[i], to_j = b[j] - z * centre[j];
    SplitPoint p;
    p.edge = k;
    p.side = to_i * (1.0 - s) >= to_j * s ? 0 : 1;
    const double r = p.side == 0 ? to_j / (1.0 - s) : to_i / s;
    p.share = {p.side == 0 ? to_i - s * r : to_j - (1.0 - s) * r, r, z};
    // Rounding must not make a spline negative.
    for (double& c : p.share) c = c > 0.0 ? c : 0.0;
    return p;
  }
  static int next(int k) { return k == 2 ? 0 : k + 1; }

 private:
  const Triangulation* triangulation_;
  std::vector<std::array<double, 3>> centres_;
  std::vector<double> edge_shares_, centre_shares_;
};

/// Which vertices at the boundary get a control triangle with sides on the boundary.
struct ControlTriangleOptions {
  ControlTriangleRule rule = ControlTriangleRule::hull_edges;
  /// One side on a straight boundary, two on the edges of a convex corner of at most 170 degrees, so that
  /// essential conditions fix single functions. Elsewhere (corners that turn inwards or hardly) and without
  /// it the conditions are equations among a vertex' three functions; by the rule `corner_sides` corners that
  /// turn inwards by at least 10 degrees have two sides on their edges too. No triangle of that kind holds
  /// all Powell-Sabin points, so that some functions are negative in places.
  bool on_boundary = true;
};

/// Control triangles of all vertices for splines of `degree`: they contain the vertex V and V + (X -
/// V)/degree for the split points X around it (de Koster 2018, section 3.5.2 and appendix A.3), but for
/// `corner_sides`.
std::vector<ControlTriangle> control_triangles(const PowellSabinSplit& split, int degree,
                                               const ControlTriangleOptions& options = {});

}  // namespace wisp
