// Structured grids: lines, continuation beyond the edge, and finding the cell of a coordinate.
#include "grid/structured.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "core/error.h"

namespace wisp {
namespace {

using Lines = std::array<std::vector<double>, 2>;
const std::vector<double> uneven{-1.0, -0.9, -0.25, 0.0, 0.1, 1.7, 1.75, 3.0};

/// The cell by definition: lower line <= x < upper line, phantom cells included.
int by_search(const StructuredGrid<2>& grid, int d, double x) {
  constexpr int padding = StructuredGrid<2>::padding;
  int cell = -padding;
  for (int i = -padding; i < grid.cells(d) + padding; ++i)
    if (x >= grid.line(d, i)) cell = i;
  return cell;
}

TEST(StructuredGrid, LinesContinueWithTheSpacingOfTheLastCell) {
  const StructuredGrid<2> grid(Lines{std::vector<double>{0.0, 1.0, 3.0}, uneven});
  EXPECT_EQ(grid.cells(0), 2);
  EXPECT_DOUBLE_EQ(grid.line(0, -2), -2.0);
  EXPECT_DOUBLE_EQ(grid.line(0, 4), 7.0);
  EXPECT_DOUBLE_EQ(grid.spacing(1, 4), 1.6);
  EXPECT_DOUBLE_EQ(grid.shortest_side(), 1.75 - 1.7);
  EXPECT_EQ(grid.lower(), Vec<2>(0.0, -1.0));
  EXPECT_EQ(grid.upper(), Vec<2>(3.0, 3.0));
}

TEST(StructuredGrid, EqualSpacingEndsExactlyAtItsCorners) {
  const StructuredGrid<3> grid(Vec<3>(0.1, -0.7, 2.0), Vec<3>(0.7, 0.3, 2.3), MultiIndex<3>(7, 3, 11));
  EXPECT_EQ(grid.lower(), Vec<3>(0.1, -0.7, 2.0));
  EXPECT_EQ(grid.upper(), Vec<3>(0.7, 0.3, 2.3));
  for (int d = 0; d < 3; ++d)
    for (int i = 0; i < grid.cells(d); ++i) EXPECT_LT(grid.line(d, i), grid.line(d, i + 1));
}

TEST(StructuredGrid, LocateIsTheSearchThroughAllLines) {
  const StructuredGrid<2> grid(Lines{uneven, std::vector<double>{0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7}});
  std::mt19937 random(5);
  for (int d = 0; d < 2; ++d) {
    const double low = grid.line(d, -4), high = grid.line(d, grid.cells(d) + 4);
    std::uniform_real_distribution<double> anywhere(low, high);
    for (int k = 0; k < 5000; ++k) {
      const double x = anywhere(random);
      ASSERT_EQ(grid.locate(d, x), by_search(grid, d, x)) << x;
    }
    for (int i = -4; i < grid.cells(d) + 4; ++i) {
      const double x = grid.line(d, i);
      EXPECT_EQ(grid.locate(d, x), i);
      EXPECT_EQ(grid.locate(d, std::nextafter(x, 1e9)), i);
      if (i > -4) {
        EXPECT_EQ(grid.locate(d, std::nextafter(x, -1e9)), i - 1);
      }
    }
  }
}

TEST(StructuredGrid, LocateInsideKnowsTheEdges) {
  const StructuredGrid<2> grid(Lines{uneven, uneven});
  EXPECT_EQ(grid.locate_inside(0, -1.0), 0);
  EXPECT_EQ(grid.locate_inside(0, std::nextafter(-1.0, -2.0)), -1);
  EXPECT_EQ(grid.locate_inside(0, 3.0), 6);
  EXPECT_EQ(grid.locate_inside(0, std::nextafter(3.0, 4.0)), 7);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(grid.locate_inside(0, infinity), 7);
  EXPECT_EQ(grid.locate_inside(0, -infinity), -1);
  EXPECT_EQ(grid.locate_inside(0, std::numeric_limits<double>::quiet_NaN()), -1);
}

TEST(StructuredGrid, WrongDescriptionsAreInputErrors) {
  EXPECT_THROW(StructuredGrid<2>(Vec<2>(0, 0), Vec<2>(1, 0), MultiIndex<2>(1, 1)), InputError);
  EXPECT_THROW(StructuredGrid<2>(Vec<2>(0, 0), Vec<2>(1, 1), MultiIndex<2>(1, 0)), InputError);
  EXPECT_THROW(StructuredGrid<2>(Lines{std::vector<double>{0.0}, uneven}), InputError);
  EXPECT_THROW(StructuredGrid<2>(Lines{std::vector<double>{0.0, 0.0}, uneven}), InputError);
  EXPECT_THROW(StructuredGrid<2>(Lines{std::vector<double>{0.0, std::nan("")}, uneven}), InputError);
  StructuredGridOptions both;
  both.lower = {0, 0}, both.upper = {1, 1}, both.cells = {2, 2}, both.coordinates = {uneven, uneven};
  EXPECT_THROW(StructuredGrid<2>{both}, InputError);
  EXPECT_THROW(StructuredGrid<2>{StructuredGridOptions{}}, InputError);
}

}  // namespace
}  // namespace wisp
