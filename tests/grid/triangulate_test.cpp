// Triangulations of blocks and polygons.
#include "grid/triangulate.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numbers>

#include "core/error.h"
#include "grid/triangulation_samples.h"

namespace wisp {
namespace {

using namespace grid_test;

/// The most that a vertex lies inside the circle through a triangle's corners, in units of its radius.
double deepest(const Triangulation& mesh) {
  double depth = 0.0;
  for (int t = 0; t < mesh.n_triangles(); ++t) {
    const Vec<2> u = mesh.corner(t, 1) - mesh.corner(t, 0), w = mesh.corner(t, 2) - mesh.corner(t, 0);
    const double twice = 2.0 * (u.x() * w.y() - u.y() * w.x());
    const Vec<2> to_centre = Vec<2>(w.y() * u.squaredNorm() - u.y() * w.squaredNorm(),
                                    u.x() * w.squaredNorm() - w.x() * u.squaredNorm()) /
                             twice;
    const double radius = to_centre.norm();
    for (int v = 0; v < mesh.n_vertices(); ++v)
      depth = std::max(depth, 1.0 - (mesh.vertex(v) - mesh.corner(t, 0) - to_centre).norm() / radius);
  }
  return depth;
}

TEST(TriangulateBlocks, SplitsInTwoOrFour) {
  for (const auto& [split, triangles, vertices] :
       {std::tuple{BlockSplit::four, 24, 18}, {BlockSplit::two, 12, 12}, {BlockSplit::mirrored, 12, 12}}) {
    const auto mesh = triangulate_blocks(unit_blocks(3, 2), split);
    EXPECT_EQ(mesh.n_triangles(), triangles);
    EXPECT_EQ(mesh.n_vertices(), vertices);
    EXPECT_NEAR(mesh.total_area(), 1.0, 1e-15);
    EXPECT_EQ(mesh.part("right").edges.size(), 2U);
  }
}

RC_GTEST_PROP(TriangulatePolygon, RandomPointsGiveADelaunayTriangulation, ()) {
  const auto mesh = random_square(*rc::gen::arbitrary<unsigned>());
  RC_ASSERT(mesh.n_vertices() == 44);
  RC_ASSERT(std::abs(mesh.total_area() - 1.0) < 1e-12);
  RC_ASSERT(deepest(mesh) < 1e-9);
}

TEST(TriangulatePolygon, PointsOnOneCircleAndGridsAreNoTrouble) {
  PolygonVertices grid;
  for (int j = 0; j <= 8; ++j)
    for (int i = 0; i <= 8; ++i) grid.given.emplace_back(i / 8.0, j / 8.0);
  const auto mesh = triangulate_polygon(Outline({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}), grid);
  EXPECT_EQ(mesh.n_vertices(), 81);
  EXPECT_EQ(mesh.n_triangles(), 128);
  Ring circle;
  for (int i = 0; i < 24; ++i)
    circle.emplace_back(std::cos(i * std::numbers::pi / 12), std::sin(i * std::numbers::pi / 12));
  EXPECT_EQ(triangulate_polygon(Outline({circle}), {}).n_triangles(), 22);
}

TEST(TriangulatePolygon, FillsWithGoodTrianglesAndNamesItsSides) {
  PolygonVertices vertices;
  vertices.spacing = 0.25;
  const auto mesh = triangulate_polygon(ring_outline(), vertices);
  EXPECT_NEAR(mesh.total_area(), 12.0, 1e-12);
  EXPECT_GT(mesh.smallest_angle() * 180 / std::numbers::pi, 25.0);
  EXPECT_LT(deepest(mesh), 0.2);  // constrained: sides are edges
  EXPECT_EQ(mesh.part("outer").edges.size(), 64U);
  EXPECT_EQ(mesh.part("hole 1").edges.size(), 32U);
  for (const int v : mesh.part("side 2").vertices) EXPECT_EQ(mesh.vertex(v).x(), 4.0);
  EXPECT_NE(quality_line(mesh).find(std::to_string(mesh.n_triangles()) + " triangles"), std::string::npos);
  EXPECT_TRUE(sliver_warning(mesh).empty());
}

TEST(TriangulatePolygon, DividesSidesThatAreNoEdges) {
  // Vertices near a long side take it from the Delaunay triangulation until it is divided.
  PolygonVertices vertices;
  for (int i = 1; i < 10; ++i) vertices.given.emplace_back(i, 0.05);
  const auto mesh = triangulate_polygon(Outline({{{0, 0}, {10, 0}, {10, 1}, {0, 1}}}), vertices);
  EXPECT_NEAR(mesh.total_area(), 10.0, 1e-12);
  double length = 0.0;
  for (const int e : mesh.part("side 1").edges) length += mesh.edge_length(e);
  EXPECT_NEAR(length, 10.0, 1e-12);
}

TEST(TriangulatePolygon, IrregularOnesDependOnTheSeedAlone) {
  PolygonVertices vertices;
  vertices.spacing = 0.2, vertices.irregularity = 0.3, vertices.seed = 7;
  const Outline square({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
  const auto a = triangulate_polygon(square, vertices), b = triangulate_polygon(square, vertices);
  vertices.seed = 8;
  const auto c = triangulate_polygon(square, vertices);
  ASSERT_EQ(a.n_vertices(), b.n_vertices());
  bool same = a.n_vertices() == c.n_vertices();
  for (int v = 0; v < a.n_vertices(); ++v) {
    EXPECT_EQ(a.vertex(v), b.vertex(v));
    same = same && a.vertex(v) == c.vertex(v);
  }
  EXPECT_FALSE(same);
}

TEST(TriangulatePolygon, SliversAreWarnedOf) {
  PolygonVertices vertices;
  vertices.given = {{0.5, 1e-3}};
  const auto mesh = triangulate_polygon(Outline({{{0, 0}, {1, 0}, {0.5, 1}}}), vertices);
  EXPECT_NE(sliver_warning(mesh).find("1 triangle has an angle below 5 degrees"), std::string::npos)
      << sliver_warning(mesh);
}

TEST(TriangulatePolygon, WrongVerticesAreInputErrors) {
  const Outline square({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
  PolygonVertices vertices;
  vertices.given = {{2, 2}};
  EXPECT_THROW(triangulate_polygon(square, vertices), InputError);
  vertices.given = {{0.5, 0.5}, {0.5, 0.5}};
  EXPECT_THROW(triangulate_polygon(square, vertices), InputError);
}

}  // namespace
}  // namespace wisp
