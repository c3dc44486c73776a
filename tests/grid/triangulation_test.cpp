// Triangulations: their edges and neighbours, finding triangles, and what is refused.
#include "grid/triangulation.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <numbers>

#include "core/error.h"
#include "geometry/orientation.h"
#include "grid/triangulation_samples.h"

namespace wisp {
namespace {

using namespace grid_test;
using Triangles = std::vector<std::array<int, 3>>;
using Points = std::vector<Vec<2>>;

/// The definition: all triangles that hold x, edges and corners included.
std::vector<int> holders(const Triangulation& mesh, const Vec<2>& x) {
  std::vector<int> list;
  for (int t = 0; t < mesh.n_triangles(); ++t)
    if (orientation(mesh.corner(t, 0), mesh.corner(t, 1), x) >= 0 &&
        orientation(mesh.corner(t, 1), mesh.corner(t, 2), x) >= 0 &&
        orientation(mesh.corner(t, 2), mesh.corner(t, 0), x) >= 0)
      list.push_back(t);
  return list;
}

int by_search(const Triangulation& mesh, const Vec<2>& x) {
  const auto list = holders(mesh, x);
  return list.empty() ? -1 : list.front();
}

std::string message(const Points& points, const Triangles& triangles) {
  try {
    const Triangulation mesh(points, triangles);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no error)";
}

TEST(Orientation, IsExactWhereDoublesRound) {
  // Points of a lattice of the last digit around (0.5, 0.5), against the line through (12, 12) and (24, 24):
  // on the diagonal 0, above it left, below it right (Kettner et al. 2008).
  const double u = std::numeric_limits<double>::epsilon() / 2;
  for (int i = 0; i < 64; ++i)
    for (int j = 0; j < 64; ++j) {
      const Vec<2> p(0.5 + i * u, 0.5 + j * u);
      EXPECT_EQ(orientation({12, 12}, {24, 24}, p), i == j ? 0 : (j > i ? 1 : -1));
      EXPECT_EQ(orientation(p, {12, 12}, {24, 24}), i == j ? 0 : (j > i ? 1 : -1));
    }
}

TEST(Triangulation, KnowsEdgesAndNeighbours) {
  const Triangulation mesh(Points{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, Triangles{{0, 1, 2}, {0, 2, 3}});
  EXPECT_EQ(mesh.n_edges(), 5);
  EXPECT_EQ(mesh.neighbour(0, 0), -1);
  EXPECT_EQ(mesh.neighbour(0, 2), 1);
  EXPECT_EQ(mesh.neighbour(1, 0), 0);
  EXPECT_EQ(mesh.edge(0, 2), mesh.edge(1, 0));
  const auto& shared = mesh.edge(mesh.edge(1, 0));
  EXPECT_EQ(shared.triangle, (std::array<int, 2>{0, 1}));
  EXPECT_EQ(shared.vertex, (std::array<int, 2>{2, 0}));
  EXPECT_EQ(mesh.find_edge(1, 3), -1);
  EXPECT_DOUBLE_EQ(mesh.shortest_height(), std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(mesh.smallest_angle(), std::numbers::pi / 4);
  EXPECT_DOUBLE_EQ(mesh.total_area(), 1.0);
}

TEST(Triangulation, ClockwiseTrianglesAreTurned) {
  const Triangulation mesh(Points{{0, 0}, {1, 0}, {1, 1}}, Triangles{{0, 2, 1}});
  EXPECT_DOUBLE_EQ(mesh.area(0), 0.5);
}

RC_GTEST_PROP(Triangulation, EulerAndFans, ()) {
  const auto mesh = random_square(*rc::gen::arbitrary<unsigned>());
  RC_ASSERT(mesh.n_vertices() - mesh.n_edges() + mesh.n_triangles() == 1);
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const auto around = mesh.triangles_of_vertex(v);
    double angle = 0.0;
    for (std::size_t i = 0; i < around.size(); ++i) {
      const auto& t = mesh.triangle(around[i]);
      const int k = static_cast<int>(std::find(t.begin(), t.end(), v) - t.begin());
      RC_ASSERT(k < 3);
      const Vec<2> p = mesh.corner(around[i], (k + 1) % 3) - mesh.vertex(v),
                   q = mesh.corner(around[i], (k + 2) % 3) - mesh.vertex(v);
      angle += std::atan2(p.x() * q.y() - p.y() * q.x(), p.dot(q));
      const int next = mesh.neighbour(around[i], (k + 2) % 3);  // counter-clockwise
      const bool last = i + 1 == around.size();
      RC_ASSERT(next == (last ? (mesh.on_boundary(v) ? -1 : around[0]) : around[i + 1]));
    }
    RC_ASSERT(mesh.on_boundary(v) == (angle < 6.0));
  }
}

RC_GTEST_PROP(Triangulation, LocateIsTheSearchThroughAll, ()) {
  const auto mesh = random_square(*rc::gen::arbitrary<unsigned>(), 60);
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  std::uniform_real_distribution<double> anywhere(-0.1, 1.1);
  std::uniform_int_distribution<int> hint(-1, mesh.n_triangles() - 1);
  for (int i = 0; i < 200; ++i) {
    const double x = anywhere(random);
    const Vec<2> p(x, anywhere(random));
    RC_ASSERT(mesh.locate(p, hint(random)) == by_search(mesh, p));
  }
}

RC_GTEST_PROP(Triangulation, LocateOnEdgesAndVerticesIsTheLowestWhateverTheHint, ()) {
  const auto mesh = random_square(*rc::gen::arbitrary<unsigned>());
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  std::uniform_int_distribution<int> any(0, mesh.n_triangles() - 1);
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const auto around = mesh.triangles_of_vertex(v);
    const int lowest = *std::min_element(around.begin(), around.end());
    RC_ASSERT(mesh.locate(mesh.vertex(v)) == lowest);
    for (const int t : around) RC_ASSERT(mesh.locate(mesh.vertex(v), t) == lowest);
    RC_ASSERT(mesh.locate(mesh.vertex(v), any(random)) == lowest);
  }
  for (int e = 0; e < mesh.n_edges(); ++e) {
    const auto& edge = mesh.edge(e);
    // Rounded, so in one of the two, off the edge by the last digit, or outside and taken back.
    const Vec<2> x = 0.3 * mesh.vertex(edge.vertex[0]) + 0.7 * mesh.vertex(edge.vertex[1]);
    const int found = mesh.locate(x);
    RC_ASSERT(found >= 0);
    RC_ASSERT(found == edge.triangle[0] || found == edge.triangle[1]);
    for (const int hint : {edge.triangle[0], std::max(edge.triangle[1], 0), any(random)})
      RC_ASSERT(mesh.locate(x, hint) == found);
  }
}

TEST(Triangulation, LocateGoesAroundHolesAndOutside) {
  PolygonVertices vertices;
  vertices.spacing = 0.4;
  const auto mesh = triangulate_polygon(ring_outline(), vertices);
  for (int t = 0; t < mesh.n_triangles(); ++t)
    for (int hint = 0; hint < mesh.n_triangles(); hint += 7)
      EXPECT_EQ(mesh.locate(mesh.centroid(t), hint), t);
  EXPECT_EQ(mesh.locate({2, 2}), -1);
  EXPECT_EQ(mesh.locate({2, 2}, 3), -1);
  EXPECT_EQ(mesh.locate({-1, 2}), -1);
  EXPECT_EQ(mesh.locate({std::nan(""), 2}, 3), -1);
  EXPECT_EQ(mesh.locate({std::numeric_limits<double>::infinity(), 2}), -1);
}

TEST(Triangulation, GradedMeshesAreWalkedThrough) {
  // 4000 triangles in a corner that is one bin of the coarse rest.
  std::vector<double> lines{0.0};
  for (int i = 1; i <= 32; ++i) lines.push_back(1e-4 * i);
  lines.push_back(100.0);
  const auto mesh = triangulate_blocks(StructuredGrid<2>(std::array{lines, lines}), BlockSplit::four);
  for (int t = 0; t < mesh.n_triangles(); ++t) ASSERT_EQ(mesh.locate(mesh.centroid(t)), t);
}

RC_GTEST_PROP(Triangulation, BarycentricCoordinatesReproduceTheirPoint, ()) {
  const auto mesh = random_square(*rc::gen::arbitrary<unsigned>(), 10);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(0.0, 1.0);
  for (int i = 0; i < 50; ++i) {
    const double x = anywhere(random);
    const Vec<2> p(x, anywhere(random));
    const int t = mesh.locate(p);
    const auto b = mesh.barycentric(t, p);
    RC_ASSERT((mesh.point(t, b) - p).norm() < 1e-13);
    const auto g = mesh.barycentric_gradients(t);
    Vec<2> linear = Vec<2>::Zero();
    for (int k = 0; k < 3; ++k)
      linear += g[static_cast<std::size_t>(k)] * mesh.corner(t, k).dot(Vec<2>(2, -3));
    RC_ASSERT((linear - Vec<2>(2, -3)).norm() < 1e-9);
  }
}

TEST(Triangulation, WrongOnesAreInputErrors) {
  const Points square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const auto says = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos && text.find('\n') == std::string::npos;
  };
  EXPECT_TRUE(says(message(square, {}), "no triangle"));
  EXPECT_TRUE(says(message(square, {{0, 1, 4}}), "names vertex 4, expected 0 to 3"));
  EXPECT_TRUE(
      says(message(square, {{0, 1, 2}}), "1 of 4 vertices belong to no triangle, the first is vertex 3"));
  EXPECT_TRUE(says(message(square, {{0, 1, 2}, {0, 3, 2}}), "1 of 2 triangles are inverted"));
  EXPECT_TRUE(says(message(square, {{0, 1, 2}, {0, 1, 3}}), "overlap"));
  EXPECT_TRUE(says(message(square, {{0, 1, 2}, {0, 2, 3}, {3, 3, 0}}), "has no area"));
  // Overlapping without a common edge, a hanging vertex, coinciding vertices, a number that is none.
  EXPECT_TRUE(
      says(message({{0, 0}, {2, 0}, {1, 2}, {0, 1}, {2, 1}, {1, -1}}, {{0, 1, 2}, {4, 3, 5}}), "overlap"));
  EXPECT_TRUE(says(message({{0, 0}, {2, 0}, {1, 1}, {1, 0}, {0, -1}, {2, -1}}, {{0, 1, 2}, {3, 4, 5}}),
                   "lies on an edge"));
  EXPECT_TRUE(
      says(message({{0, 0}, {1, 0}, {0, 1}, {1, 0}, {0, 1}, {1, 1}}, {{0, 1, 2}, {3, 5, 4}}), "coincide"));
  EXPECT_TRUE(says(message({{0, 0}, {std::nan(""), 0}, {0, 1}}, {{0, 1, 2}}), "finite"));
}

TEST(Triangulation, PartsHaveNames) {
  auto mesh = triangulate_blocks(unit_blocks(3, 2), BlockSplit::four);
  EXPECT_EQ(mesh.part("left").edges.size(), 2U);
  EXPECT_EQ(mesh.part("top").vertices.size(), 4U);
  for (const int v : mesh.part("top").vertices) EXPECT_EQ(mesh.vertex(v).y(), 1.0);
  EXPECT_THROW(mesh.part("tpo"), InputError);
  EXPECT_THROW(mesh.add_part("wrong", std::vector<std::array<int, 2>>{{0, 7}}), InputError);
  mesh.add_part("top", {}, std::vector<int>{0});
  EXPECT_EQ(mesh.part("top").vertices.size(), 5U);
}

}  // namespace
}  // namespace wisp
