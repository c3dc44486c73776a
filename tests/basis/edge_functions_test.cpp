// Which functions a condition along edges fixes.
#include "basis/edge_functions.h"

#include <gtest/gtest.h>

#include "basis/lagrange_quadratic.h"
#include "basis/linear_triangle.h"
#include "basis/powell_sabin_cubic.h"
#include "basis/powell_sabin_quadratic.h"
#include "grid/triangulate.h"

namespace wisp {
namespace {

Triangulation square() {
  PolygonVertices vertices;
  vertices.spacing = 0.3, vertices.irregularity = 0.3;
  return triangulate_polygon(Outline({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}), vertices);
}

template <class Basis>
struct Trace : testing::Test {};
using Bases = testing::Types<LinearTriangle, LagrangeQuadratic, PowellSabinQuadratic, PowellSabinCubic>;
TYPED_TEST_SUITE(Trace, Bases);

TYPED_TEST(Trace, FixesTheEdgeAndNothingElse) {
  const Triangulation mesh = square();
  const TypeParam basis(mesh);
  const auto& edges = mesh.part("side 1").edges;
  const auto held = trace_functions(basis, edges, {});
  // A field that is 1 in the held functions and 0 in the others is 1 along the edge ...
  const auto value = [&](const Vec<2>& x) {
    double sum = 0.0;
    basis.tabulate_in(mesh.locate(x), x).for_each([&](int, int i, double phi, const Vec<2>&) {
      if (std::binary_search(held.begin(), held.end(), i)) sum += phi;
    });
    return sum;
  };
  for (const int e : edges)
    for (const double s : {0.0, 0.13, 0.5, 0.77, 1.0})
      EXPECT_NEAR(
          value((1 - s) * mesh.vertex(mesh.edge(e).vertex[0]) + s * mesh.vertex(mesh.edge(e).vertex[1])), 1.0,
          1e-11);
  // ... and held at zero they leave the normal derivative free: other functions change it.
  const Vec<2> x(0.41, 0.0);
  double most = 0.0;
  basis.tabulate_in(mesh.locate(x), x).for_each([&](int, int i, double, const Vec<2>& dphi) {
    if (!std::binary_search(held.begin(), held.end(), i)) most = std::max(most, std::abs(dphi.y()));
  });
  EXPECT_GT(most, 0.1);
  // As many as the edge has values and tangential derivatives, edges of the side and vertices.
  const auto n = edges.size(), v = n + 1;
  const std::size_t expected = TypeParam::continuity > 0 ? (TypeParam::degree == 3 ? 2 * v + 2 * n : 2 * v)
                               : TypeParam::degree == 2  ? v + n
                                                         : v;
  EXPECT_EQ(held.size(), expected);
}

int vertex_at(const Triangulation& mesh, const Vec<2>& x) {
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if ((mesh.vertex(v) - x).norm() < 1e-12) return v;
  ADD_FAILURE() << "no vertex there";
  return 0;
}

/// Functions of a vertex among those that are held.
int held_at(const std::vector<int>& held, int v) {
  int n = 0;
  for (int q = 0; q < 3; ++q) n += std::binary_search(held.begin(), held.end(), 3 * v + q);
  return n;
}

/// Largest value along edges of the field that is 1 in all functions but the held ones.
template <class Basis>
double left_on(const Basis& basis, const std::vector<int>& held, const std::vector<int>& edges) {
  const Triangulation& mesh = basis.triangulation();
  double most = 0.0;
  for (const int e : edges)
    for (int k = 0; k <= 20; ++k) {
      const double s = k / 20.0;
      const Vec<2> x =
          (1 - s) * mesh.vertex(mesh.edge(e).vertex[0]) + s * mesh.vertex(mesh.edge(e).vertex[1]);
      basis.tabulate_in(mesh.edge(e).triangle[0], x).for_each([&](int, int i, double phi, const Vec<2>&) {
        if (!std::binary_search(held.begin(), held.end(), i)) most = std::max(most, std::abs(phi));
      });
    }
  return most;
}

TEST(TraceOfSplines, KinkedBoundariesAreHeldOnOneSideOrBoth) {
  // A corner of 150 degrees at (1, 0).
  const Vec<2> tip(1.0 + std::cos(0.5236), std::sin(0.5236));
  PolygonVertices vertices;
  vertices.spacing = 0.35;
  const Triangulation mesh = triangulate_polygon(Outline({{{0, 0}, {1, 0}, tip, {1, 2}, {0, 2}}}), vertices);
  const PowellSabinQuadratic basis(mesh);
  const int corner = vertex_at(mesh, {1, 0});
  std::vector<int> both = mesh.part("side 1").edges;
  const auto one = trace_functions(basis, both, {});
  EXPECT_EQ(held_at(one, corner), 2);
  EXPECT_LT(left_on(basis, one, both), 1e-12);
  both.insert(both.end(), mesh.part("side 2").edges.begin(), mesh.part("side 2").edges.end());
  const auto held = trace_functions(basis, both, {});
  EXPECT_EQ(held_at(held, corner), 3);
  EXPECT_LT(left_on(basis, held, both), 1e-12);
  EXPECT_THROW(trace_functions(basis, {}, {corner}), InputError);
}

TEST(TraceOfSplines, AtAReentrantCornerOneSideIsHeldByControlTrianglesWithSidesThere) {
  // An L: the corner at (1, 1) turns inwards, between side 3 on y = 1 and side 4 on x = 1.
  PolygonVertices vertices;
  vertices.spacing = 0.35, vertices.irregularity = 0.2;
  const Triangulation mesh =
      triangulate_polygon(Outline({{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}}), vertices);
  const int corner = vertex_at(mesh, {1, 1});
  const auto& side = mesh.part("side 3").edges;
  EXPECT_THROW(trace_functions(PowellSabinQuadratic(mesh), side, {}), InputError);
  const ControlTriangleOptions sides{ControlTriangleRule::corner_sides};
  const auto holds = [&](const auto& basis) {
    const auto held = trace_functions(basis, side, {});
    EXPECT_EQ(held_at(held, corner), 2);
    EXPECT_LT(left_on(basis, held, side), 1e-12);
    const auto other = trace_functions(basis, mesh.part("side 4").edges, {});
    EXPECT_EQ(held_at(other, corner), 2);
    EXPECT_LT(left_on(basis, other, mesh.part("side 4").edges), 1e-12);
    // The space is that of the other rule: the functions sum to one and reproduce x.
    for (const Vec<2>& x : {Vec<2>(0.9, 0.95), Vec<2>(1.1, 0.97), Vec<2>(0.97, 1.08)}) {
      double sum = 0.0;
      Vec<2> place = Vec<2>::Zero();
      basis.tabulate(x, -1).for_each(
          [&](int, int i, double phi, const Vec<2>&) { sum += phi, place += phi * basis.control_point(i); });
      EXPECT_NEAR(sum, 1.0, 1e-13);
      EXPECT_LT((place - x).norm(), 1e-13);
    }
  };
  holds(PowellSabinQuadratic(mesh, sides));
  holds(PowellSabinCubic(mesh, sides));
}

}  // namespace
}  // namespace wisp
