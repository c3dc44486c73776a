// Control triangles of Powell–Sabin splines: small triangles that contain the Powell–Sabin points of a
// vertex.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "core/describe.h"
#include "tensor/tensor.h"

namespace wisp {

/// How the smallest control triangle is searched for.
enum class ControlTriangleRule {
  hull_edges,    ///< two or three sides on edges of the convex hull, a third side across the bisector
  minimum_area,  ///< the triangle of least area
  corner_sides,  ///< hull edges; at corners that turn inwards two sides on the boundary
};
template <>
inline constexpr auto choices<ControlTriangleRule> =
    choice_list<ControlTriangleRule>({{"hull-edges", ControlTriangleRule::hull_edges},
                                      {"minimum-area", ControlTriangleRule::minimum_area},
                                      {"corner-sides", ControlTriangleRule::corner_sides}});

/// An oriented line; points on its left are inside.
struct DirectedLine {
  Vec<2> point;
  Vec<2> direction;
};

/// Corners of a control triangle, counter-clockwise, m.
using ControlTriangle = std::array<Vec<2>, 3>;

/// Area, positive if counter-clockwise, m².
double signed_area(const ControlTriangle& triangle);

/// The smallest triangle around `points` by a rule.
///
/// hull_edges: all triangles with three sides on edges of the hull, and those with two, whose third side
/// stands at right angles to the bisector of the two and touches the farthest point (Dierckx 1997; Speleers
/// et al. 2012). minimum_area: two sides of a least triangle can be taken on hull edges, and the third is
/// another edge or has a vertex of the hull as its midpoint (Klee and Laskowski 1985; O'Rourke et al. 1986);
/// all such triangles are compared.
///
/// @param points   at least three, not on one line
/// @param required up to two lines that must carry sides of the triangle; no point may lie on their right.
/// The
///                 corner where two of them meet comes first; with one, corners 0 and 1 lie on it.
/// @return the triangle; with `required` lines that no triangle can have as sides, an empty vector's worth:
///         see `found`
struct ControlTriangleSearch {
  bool found = false;
  ControlTriangle triangle{};
};
ControlTriangleSearch find_control_triangle(std::span<const Vec<2>> points, ControlTriangleRule rule,
                                            std::span<const DirectedLine> required = {});

}  // namespace wisp
