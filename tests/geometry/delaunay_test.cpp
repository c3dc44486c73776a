// Voronoi cells in a polygon. Triangulations are tested with the grids that they make.
#include "geometry/delaunay.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numeric>
#include <random>

#include "core/error.h"

namespace wisp {
namespace {

const Outline notched({{{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}});

TEST(Voronoi, KnownCells) {
  const Outline square({{{0, 0}, {2, 0}, {2, 2}, {0, 2}}});
  EXPECT_DOUBLE_EQ(voronoi_areas({{0.3, 0.4}}, square)[0], 4.0);
  const auto two = voronoi_areas({{0.5, 1}, {1.0, 1}}, square);
  EXPECT_DOUBLE_EQ(two[0], 1.5);
  EXPECT_DOUBLE_EQ(two[1], 2.5);
  const auto row = voronoi_areas({{1.5, 1}, {0.5, 1}, {1.0, 1}}, square);  // on one line, not in order
  EXPECT_DOUBLE_EQ(row[0], 1.5);
  EXPECT_DOUBLE_EQ(row[1], 1.5);
  EXPECT_DOUBLE_EQ(row[2], 1.0);
  std::vector<Eigen::Vector2d> grid;
  for (int i = 0; i < 16; ++i) grid.emplace_back(0.25 + 0.5 * (i % 4), 0.25 + 0.5 * (i / 4));
  for (const double a : voronoi_areas(grid, square)) EXPECT_NEAR(a, 0.25, 1e-14);
}

RC_GTEST_PROP(Voronoi, CellsFillThePolygonAndHoldWhatIsNearest, ()) {
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  std::uniform_real_distribution<double> x(0.0, 3.0), y(0.0, 2.0);
  std::vector<Eigen::Vector2d> points;
  while (points.size() < 12) {
    const double a = x(random);
    const Eigen::Vector2d p(a, y(random));
    if (notched.contains(p)) points.push_back(p);
  }
  const auto areas = voronoi_areas(points, notched);
  RC_ASSERT(std::abs(std::accumulate(areas.begin(), areas.end(), 0.0) - notched.area()) < 1e-12);
  // Against counting on a lattice of 150 x 100 places.
  std::vector<double> counted(points.size(), 0.0);
  for (int j = 0; j < 100; ++j)
    for (int i = 0; i < 150; ++i) {
      const Eigen::Vector2d p(0.02 * (i + 0.5), 0.02 * (j + 0.5));
      if (!notched.contains(p)) continue;
      std::size_t best = 0;
      for (std::size_t k = 1; k < points.size(); ++k)
        if ((points[k] - p).norm() < (points[best] - p).norm()) best = k;
      counted[best] += 4e-4;
    }
  for (std::size_t k = 0; k < points.size(); ++k) RC_ASSERT(std::abs(counted[k] - areas[k]) < 0.04);
}

TEST(Delaunay, WrongPointsAreInputErrors) {
  EXPECT_THROW(delaunay({{0, 0}, {1, 0}}), InputError);
  EXPECT_THROW(delaunay({{0, 0}, {1, 1}, {3, 3}, {2, 2}}), InputError);
  EXPECT_THROW(delaunay({{0, 0}, {1, 0}, {0, std::nan("")}}), InputError);
  EXPECT_THROW(voronoi_areas({}, notched), InputError);
  EXPECT_THROW(voronoi_areas({{0.5, 0.5}, {0.5, 0.5}}, notched), InputError);
}

}  // namespace
}  // namespace wisp
