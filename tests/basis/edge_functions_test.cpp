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

TEST(TraceOfSplines, KinkedBoundariesFixWholeVertices) {
  // A corner of 150 degrees at (1, 0): no control triangle has sides on both of its edges.
  const Vec<2> tip(1.0 + std::cos(0.5236), std::sin(0.5236));
  PolygonVertices vertices;
  vertices.spacing = 0.35;
  const Triangulation mesh = triangulate_polygon(Outline({{{0, 0}, {1, 0}, tip, {1, 2}, {0, 2}}}), vertices);
  const PowellSabinQuadratic basis(mesh);
  std::vector<int> both = mesh.part("side 1").edges;
  EXPECT_THROW(trace_functions(basis, both, {}), InputError);
  both.insert(both.end(), mesh.part("side 2").edges.begin(), mesh.part("side 2").edges.end());
  const auto held = trace_functions(basis, both, {});
  int corner = -1;
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if ((mesh.vertex(v) - Vec<2>(1, 0)).norm() < 1e-12) corner = v;
  ASSERT_GE(corner, 0);
  for (int q = 0; q < 3; ++q) EXPECT_TRUE(std::binary_search(held.begin(), held.end(), 3 * corner + q));
  EXPECT_THROW(trace_functions(basis, {}, {corner}), InputError);
}

}  // namespace
}  // namespace wisp
