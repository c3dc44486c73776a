#include "geometry/outline.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "geometry/polygon.h"

namespace wisp {
namespace {

const std::filesystem::path ghost_folder = std::filesystem::path(WISP_SOURCE_DIR) / "verification" / "ghost";

/// The whole range from the first trial on: RapidCheck's own ranges start small and grow.
int integer(int low, int high) { return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high)); }
double uniform(double low, double high) { return low + (high - low) * integer(0, 1000001) / 1e6; }

/// A star-shaped ring of `fewest` to 24 vertices about `centre`, radii between `least` and `most`, in either
/// sense.
Ring star(const Eigen::Vector2d& centre, double least, double most, int fewest = 3) {
  const int n = integer(fewest, 25);
  Ring ring;
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + uniform(0.0, 0.8)) / n;
    ring.push_back(centre + uniform(least, most) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  if (*rc::gen::arbitrary<bool>()) std::reverse(ring.begin(), ring.end());
  return ring;
}

/// A star with a star-shaped hole around the same centre (a triangle's sides come as near as 0.1 of the least
/// radius).
Outline star_with_hole() {
  const Eigen::Vector2d centre(uniform(-3.0, 3.0), uniform(-3.0, 3.0));
  return Outline({star(centre, 0.7, 1.0, 6), star(centre, 0.02, 0.1)});
}

struct Sums {
  double area = 0.0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
};

/// Clips by every cell of a grid that starts below the polygon and covers it.
Sums sum_over_grid(const Outline& outline, const Eigen::Vector2d& origin, double h) {
  Sums sums;
  const Eigen::Array2d extent = (outline.upper() - origin).array() / h;
  for (int j = 0; j <= static_cast<int>(extent[1]); ++j) {
    for (int i = 0; i <= static_cast<int>(extent[0]); ++i) {
      const Eigen::Vector2d lower = origin + h * Eigen::Vector2d(i, j);
      const auto clipped = clip_cell(outline, lower, origin + h * Eigen::Vector2d(i + 1, j + 1));
      sums.area += clipped.area;
      sums.first += clipped.area * clipped.centroid;
    }
  }
  return sums;
}

TEST(Outline, AreaOfASquareWithAHole) {
  const Outline outline({{{0, 0}, {0, 4}, {4, 4}, {4, 0}}, {{1, 1}, {2, 1}, {2, 3}, {1, 3}}});
  EXPECT_DOUBLE_EQ(outline.area(), 14.0);
  EXPECT_EQ(outline.lower(), Eigen::Vector2d(0, 0));
  EXPECT_EQ(outline.upper(), Eigen::Vector2d(4, 4));
  EXPECT_TRUE(outline.contains({0.5, 2.0}));
  EXPECT_FALSE(outline.contains({1.5, 2.0}));
  EXPECT_TRUE(outline.contains({3.0, 2.0}));
  EXPECT_FALSE(outline.contains({-0.1, 2.0}));
  EXPECT_FALSE(outline.contains({4.1, 2.0}));
}

TEST(Outline, ClosedRingsAndRepeatedVerticesAreAccepted) {
  const Outline outline({{{0, 0}, {0, 0}, {1, 0}, {1, 1}, {1, 1}, {0, 1}, {0, 0}}});
  EXPECT_EQ(outline.rings()[0].size(), 4u);
  EXPECT_DOUBLE_EQ(outline.area(), 1.0);
}

TEST(Outline, BoundaryIsHalfOpen) {
  const Outline unit({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
  EXPECT_TRUE(unit.contains({0.0, 0.0}));
  EXPECT_TRUE(unit.contains({0.0, 0.5}));
  EXPECT_TRUE(unit.contains({0.5, 0.0}));
  EXPECT_FALSE(unit.contains({1.0, 0.5}));
  EXPECT_FALSE(unit.contains({0.5, 1.0}));
}

RC_GTEST_PROP(Outline, StarContainsWhatItsRadiusSays, ()) {
  const Eigen::Vector2d centre(uniform(-3.0, 3.0), uniform(-3.0, 3.0));
  const Outline outline({star(centre, 0.5, 1.0)});
  const Ring& ring = outline.rings()[0];
  // A point of a triangle from the centre to a side is inside, and beyond the side outside.
  const auto i = static_cast<std::size_t>(integer(0, static_cast<int>(ring.size())));
  const double s = uniform(0.05, 0.95);
  const Eigen::Vector2d a = ring[i] - centre, b = ring[(i + 1) % ring.size()] - centre;
  RC_PRE(a.x() * b.y() - a.y() * b.x() > 1e-6);  // the centre is left of this side
  const Eigen::Vector2d on_side = (1.0 - s) * a + s * b;
  RC_ASSERT(outline.contains(centre + 0.999 * on_side));
  RC_ASSERT(!outline.contains(centre + 1.001 * on_side));
}

RC_GTEST_PROP(Outline, ExactlyOneOfTwoHalvesHoldsAPointOfTheCut, ()) {
  const Eigen::Vector2d a(uniform(0.1, 0.9), 0.0), b(uniform(0.1, 0.9), 1.0);
  const Outline left({{{0, 0}, a, b, {0, 1}}}), right({{a, {1, 0}, {1, 1}, b}});
  const double s = uniform(0.0, 1.0);
  const Eigen::Vector2d x = (1.0 - s) * a + s * b;
  if (x.y() < 1.0) RC_ASSERT(left.contains(x) != right.contains(x));
}

RC_GTEST_PROP(Clip, CellsOfAGridSumToThePolygon, ()) {
  const Outline outline = star_with_hole();
  const double h = uniform(0.05, 0.7);
  const Eigen::Vector2d origin = outline.lower() - Eigen::Vector2d(uniform(0.0, 0.5), uniform(0.0, 0.5));
  const Sums sums = sum_over_grid(outline, origin, h);
  RC_ASSERT(std::abs(sums.area - outline.area()) <= 1e-13 * outline.area());
  // The same first moments in one cell around everything as in many.
  const auto whole = clip_cell(outline, origin, outline.upper() + Eigen::Vector2d(0.1, 0.1));
  RC_ASSERT(std::abs(whole.area - outline.area()) <= 1e-13 * outline.area());
  RC_ASSERT((sums.first / sums.area - whole.centroid).norm() <= 1e-12);
}

RC_GTEST_PROP(Clip, CellAgreesWithSampling, ()) {
  const Outline outline = star_with_hole();
  const Eigen::Vector2d lower = outline.lower() + Eigen::Vector2d(uniform(0.0, 1.0), uniform(0.0, 1.0));
  const Eigen::Vector2d size(uniform(0.2, 1.0), uniform(0.2, 1.0));
  const auto clipped = clip_cell(outline, lower, lower + size);
  constexpr int n = 60;
  double area = 0.0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const Eigen::Vector2d x = lower + size.cwiseProduct(Eigen::Vector2d(i + 0.5, j + 0.5) / n);
      if (!outline.contains(x)) continue;
      area += size.prod() / (n * n);
      first += size.prod() / (n * n) * x;
    }
  }
  RC_ASSERT(std::abs(area - clipped.area) <= 0.03 * size.prod());
  if (clipped.area > 0.3 * size.prod())
    RC_ASSERT((first / area - clipped.centroid).norm() <= 0.05 * size.norm());
}

TEST(Clip, ConcavePolygonThatFallsIntoTwoParts) {
  // A U of two legs; the cell sees both legs but not the bar that joins them.
  const Outline u({{{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}});
  const auto clipped = clip_cell(u, {0.5, 2.0}, {2.25, 2.5});
  EXPECT_DOUBLE_EQ(clipped.area, 0.5 * 0.5 + 0.25 * 0.5);
  EXPECT_NEAR(clipped.centroid.x(), (0.25 * 0.75 + 0.125 * 2.125) / 0.375, 1e-15);
  EXPECT_NEAR(clipped.centroid.y(), 2.25, 1e-15);
}

TEST(Clip, CellsInsideOutsideAndInAHole) {
  const Outline outline({{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{1, 1}, {3, 1}, {3, 3}, {1, 3}}});
  EXPECT_DOUBLE_EQ(clip_cell(outline, {0.25, 0.25}, {0.75, 0.75}).area, 0.25);
  EXPECT_EQ(clip_cell(outline, {5, 5}, {6, 6}).area, 0.0);
  EXPECT_EQ(clip_cell(outline, {4, 0}, {5, 1}).area, 0.0);
  const auto hole = clip_cell(outline, {1.3, 1.7}, {2.1, 2.9});
  EXPECT_EQ(hole.area, 0.0);
  EXPECT_NEAR((hole.centroid - Eigen::Vector2d(1.7, 2.3)).norm(), 0.0, 1e-15);
  EXPECT_THROW(clip_cell(outline, {1, 1}, {1, 2}), std::runtime_error);
}

TEST(Ghost, OutlineHasThePapersSizeAndArea) {
  const Outline ghost = outline(Polygon{.file = "outline.csv"}, ghost_folder);
  ASSERT_EQ(ghost.rings().size(), 4u);
  EXPECT_EQ(ghost.lower(), Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(ghost.upper(), Eigen::Vector2d(0.4, 0.4));
  EXPECT_NEAR(ghost.area(), 0.10736, 1e-12);
}

TEST(Ghost, SampledCountsAreNearThePapers) {
  const Outline ghost = outline(Polygon{.file = "outline.csv"}, ghost_folder);
  const int across[] = {31, 60, 120}, paper[] = {646, 2389, 9613};
  for (int k = 0; k < 3; ++k) {
    int count = 0;
    for (int j = 0; j < across[k]; ++j)
      for (int i = 0; i < across[k]; ++i)
        if (ghost.contains(0.4 / across[k] * Eigen::Vector2d(i + 0.5, j + 0.5))) ++count;
    EXPECT_NEAR(count, paper[k], 0.01 * paper[k]) << across[k];
  }
}

TEST(Ghost, CellsSumToItsArea) {
  const Outline ghost =
      outline(Polygon{.file = "outline.csv", .scale = 2.5, .offset = {100.0, -7.0}}, ghost_folder);
  const Sums sums = sum_over_grid(ghost, {99.99, -7.02}, 0.03125);
  EXPECT_NEAR(sums.area / ghost.area(), 1.0, 1e-13);
  EXPECT_NEAR(ghost.area(), 0.10736 * 6.25, 1e-12);
}

}  // namespace
}  // namespace wisp
