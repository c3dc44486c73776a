// The Powell–Sabin split and control triangles: where points lie, what contains what, known least triangles.
#include "grid/powell_sabin_split.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "grid/triangulations.h"

namespace wisp {
namespace {

using grid_test::meshes;

double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

bool contains(const ControlTriangle& q, const Vec<2>& x, double tolerance) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec<2> side = q[(k + 1) % 3] - q[k];
    if (cross(side, x - q[k]) < -tolerance * side.norm()) return false;
  }
  return true;
}

TEST(PowellSabinSplit, InnerPointsHaveEqualDistancesFromTheEdges) {
  for (const auto& mesh : meshes()) {
    const PowellSabinSplit split(mesh);
    for (int t = 0; t < mesh.n_triangles(); ++t) {
      double distance[3];
      for (int k = 0; k < 3; ++k) {
        const Vec<2> side = mesh.corner(t, (k + 1) % 3) - mesh.corner(t, k);
        distance[k] = cross(side, split.centre(t) - mesh.corner(t, k)) / side.norm();
      }
      EXPECT_NEAR(distance[1], distance[0], 1e-13);
      EXPECT_NEAR(distance[2], distance[0], 1e-13);
    }
  }
}

TEST(PowellSabinSplit, SplitPointsLieOnTheirEdgesAndBetweenTheInnerPoints) {
  for (const auto& mesh : meshes()) {
    const PowellSabinSplit split(mesh);
    for (int e = 0; e < mesh.n_edges(); ++e) {
      const auto& edge = mesh.edge(e);
      ASSERT_GT(split.edge_share(e), 0.0);
      ASSERT_LT(split.edge_share(e), 1.0);
      if (edge.boundary()) {
        EXPECT_EQ(split.edge_share(e), 0.5);
        continue;
      }
      const double lambda = split.centre_share(e);
      const Vec<2> r =
          lambda * split.centre(edge.triangle[0]) + (1.0 - lambda) * split.centre(edge.triangle[1]);
      EXPECT_LT((r - split.edge_point(e)).norm(), 1e-13);
      EXPECT_GT(lambda, 0.0);
      EXPECT_LT(lambda, 1.0);
    }
  }
}

TEST(PowellSabinSplit, LocatesPointsInSubTriangles) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::array<int, 6> hits{};
  for (const auto& mesh : meshes()) {
    const PowellSabinSplit split(mesh);
    for (int t = 0; t < mesh.n_triangles(); ++t)
      for (int n = 0; n < 12; ++n) {
        double a = unit(random), b = unit(random);
        if (a + b > 1.0) a = 1.0 - a, b = 1.0 - b;
        const std::array<double, 3> c{a, b, 1.0 - a - b};
        const auto p = split.locate(t, c);
        ++hits[static_cast<std::size_t>(2 * p.edge + p.side)];
        const Vec<2> x = p.share[0] * mesh.corner(t, (p.edge + p.side) % 3) +
                         p.share[1] * split.edge_point(mesh.edge(t, p.edge)) + p.share[2] * split.centre(t);
        EXPECT_LT((x - mesh.point(t, c)).norm(), 1e-14);
        EXPECT_NEAR(p.share[0] + p.share[1] + p.share[2], 1.0, 1e-14);
      }
  }
  for (const int n : hits) EXPECT_GT(n, 50);
}

TEST(ControlTriangle, ContainsThePowellSabinPoints) {
  for (const auto& mesh : meshes())
    for (const auto rule : {ControlTriangleRule::hull_edges, ControlTriangleRule::minimum_area})
      for (const bool on_boundary : {true, false})
        for (const int degree : {2, 3}) {
          const PowellSabinSplit split(mesh);
          const auto all = control_triangles(split, degree, {rule, on_boundary});
          ASSERT_EQ(static_cast<int>(all.size()), mesh.n_vertices());
          for (int t = 0; t < mesh.n_triangles(); ++t)
            for (int k = 0; k < 3; ++k) {
              const auto& q = all[static_cast<std::size_t>(mesh.triangle(t)[static_cast<std::size_t>(k)])];
              const Vec<2>& v = mesh.corner(t, k);
              EXPECT_TRUE(contains(q, v, 1e-13));
              EXPECT_TRUE(contains(q, v + (split.centre(t) - v) / degree, 1e-13));
              for (const int e : {mesh.edge(t, k), mesh.edge(t, (k + 2) % 3)})
                EXPECT_TRUE(contains(q, v + (split.edge_point(e) - v) / degree, 1e-13));
            }
        }
}

TEST(ControlTriangle, TheLeastOneIsNeverLargerThanThatOfHullEdges) {
  int smaller = 0;
  for (const auto& mesh : meshes()) {
    const PowellSabinSplit split(mesh);
    const auto by_edges = control_triangles(split, 2, {ControlTriangleRule::hull_edges, true});
    const auto least = control_triangles(split, 2, {ControlTriangleRule::minimum_area, true});
    for (std::size_t v = 0; v < by_edges.size(); ++v) {
      EXPECT_LE(signed_area(least[v]), signed_area(by_edges[v]) * (1.0 + 1e-8));
      smaller += signed_area(least[v]) < 0.99 * signed_area(by_edges[v]);
    }
  }
  EXPECT_GT(smaller, 10);
}

TEST(ControlTriangle, KnownLeastTriangles) {
  const auto least = [](const std::vector<Vec<2>>& points) {
    const auto search = find_control_triangle(points, ControlTriangleRule::minimum_area);
    EXPECT_TRUE(search.found);
    return signed_area(search.triangle);
  };
  // A parallelogram's least triangle has twice its area, a regular hexagon's 3/2 of it.
  EXPECT_NEAR(least({{0, 0}, {2, 0}, {2.5, 1}, {0.5, 1}}), 4.0, 1e-12);
  std::vector<Vec<2>> hexagon;
  for (int k = 0; k < 6; ++k) hexagon.emplace_back(std::cos(k * M_PI / 3), std::sin(k * M_PI / 3));
  EXPECT_NEAR(least(hexagon), 1.5 * 1.5 * std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(least({{0, 0}, {1, 0}, {0, 1}, {0.2, 0.2}, {0.5, 0.5}}), 0.5, 1e-12);
}

TEST(ControlTriangle, NoTriangleFoundByChanceIsSmallerThanTheLeast) {
  // Three supporting lines at random angles make a triangle around the points.
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> angle(0.0, 2.0 * M_PI);
  for (int set = 0; set < 20; ++set) {
    std::vector<Vec<2>> points;
    for (int k = 0; k < 9; ++k) points.emplace_back(normal(random), 0.4 * normal(random));
    const double least =
        signed_area(find_control_triangle(points, ControlTriangleRule::minimum_area).triangle);
    double by_chance = 1e300;
    for (int trial = 0; trial < 20000; ++trial) {
      std::array<double, 3> a{angle(random), angle(random), angle(random)};
      std::sort(a.begin(), a.end());
      if (a[1] - a[0] > 3.1 || a[2] - a[1] > 3.1 || a[2] - a[0] < M_PI + 0.05) continue;
      std::array<Vec<2>, 3> normals;
      std::array<double, 3> reach{};
      for (std::size_t k = 0; k < 3; ++k) {
        normals[k] = {std::cos(a[k]), std::sin(a[k])};
        reach[k] = -1e300;
        for (const auto& p : points) reach[k] = std::max(reach[k], normals[k].dot(p));
      }
      ControlTriangle q;
      for (std::size_t k = 0; k < 3; ++k) {
        Mat<2> m;
        m << normals[k].transpose(), normals[(k + 1) % 3].transpose();
        q[k] = m.inverse() * Vec<2>(reach[k], reach[(k + 1) % 3]);
      }
      by_chance = std::min(by_chance, std::abs(signed_area(q)));
    }
    EXPECT_GE(by_chance, least * (1.0 - 1e-9));
    EXPECT_LE(by_chance, least * 1.3);  // the search by chance does look in the right places
  }
}

TEST(ControlTriangle, HasSidesOnAStraightBoundaryAndAtConvexCorners) {
  const auto mesh = grid_test::block(4, 3, 0.25, 5);
  const PowellSabinSplit split(mesh);
  for (const auto rule : {ControlTriangleRule::hull_edges, ControlTriangleRule::minimum_area}) {
    const auto all = control_triangles(split, 2, {rule, true});
    int corners = 0;
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      const Vec<2>& x = mesh.vertex(v);
      const auto& q = all[static_cast<std::size_t>(v)];
      int n_lines = 0;
      for (int d = 0; d < 2; ++d)
        for (const double line : {mesh.lower()[d], mesh.upper()[d]}) {
          if (x[d] != line) continue;
          ++n_lines;
          int on = 0;
          for (const auto& corner : q) on += std::abs(corner[d] - line) < 1e-14;
          EXPECT_EQ(on, 2);
        }
      if (n_lines == 1) {
        EXPECT_GT((q[2] - x).norm(), 0.01);
      } else if (n_lines == 2) {
        ++corners;
        EXPECT_LT((q[0] - x).norm(), 1e-14);
      }
    }
    EXPECT_EQ(corners, 4);
  }
}

}  // namespace
}  // namespace wisp
