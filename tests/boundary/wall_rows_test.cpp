// Walls cut by the cells of the grid: rows are means of linear fields.
#include "boundary/wall_rows.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>

#include "boundary/samples.h"
#include "geometry/wall_shape.h"

namespace wisp {
namespace {

double uniform(double low, double high) {
  return low + (high - low) * *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 1000001)) / 1e6;
}

template <int dim>
std::vector<WallRow<dim>> rows_of(const Space<dim>& space, const std::vector<WallPiece<dim>>& pieces) {
  WallCutter<dim> cutter(space);
  for (const auto& piece : pieces) cutter.add(piece);
  std::vector<WallRow<dim>> rows;
  cutter.finish(0, rows);
  return rows;
}

/// Sizes sum to the wall's, and each row gives the mean of a linear field over its part.
template <int dim>
void check_rows(const Space<dim>& space, const std::vector<WallRow<dim>>& rows, double size) {
  double sum = 0.0;
  for (const auto& row : rows) {
    double weight = 0.0;
    Vec<dim> mean = Vec<dim>::Zero();
    for (std::size_t i = 0; i < row.weight.size(); ++i) {
      RC_ASSERT(row.weight[i] >= 0.0);
      weight += row.weight[i];
      mean += row.weight[i] * space.node_position(row.function[i]);
    }
    RC_ASSERT(std::abs(weight - 1.0) < 1e-13);
    RC_ASSERT((mean - row.middle).norm() < 1e-12);
    RC_ASSERT(std::abs(row.normal.norm() - 1.0) < 1e-14);
    sum += row.size;
  }
  RC_ASSERT(std::abs(sum - size) < 1e-7 * size);  // parts shorter than 1e-9 of a cell are left out
}

RC_GTEST_PROP(WallRows, AreMeansOfLinearFieldsAlongSegments, ()) {
  const auto s = boundary_test::scene<2>(2);
  const Vec<2> a(uniform(0, 4), uniform(0, 4)), b(uniform(0, 4), uniform(0, 4));
  RC_PRE((b - a).norm() > 1e-3);
  const WallShape<2> wall(PolylineWall{{{a[0], a[1]}, {b[0], b[1]}}});
  check_rows<2>(*s.space, rows_of<2>(*s.space, wall.pieces(1.0, {})), (b - a).norm());
}

RC_GTEST_PROP(WallRows, AreMeansOfLinearFieldsOverTriangles, ()) {
  const auto s = boundary_test::scene<3>(2);
  WallPiece<3> piece;
  for (auto& v : piece.vertex) v = Vec<3>(uniform(0, 4), uniform(0, 4), uniform(0, 4));
  const Vec<3> area = 0.5 * (piece.vertex[1] - piece.vertex[0]).cross(piece.vertex[2] - piece.vertex[0]);
  RC_PRE(area.norm() > 1e-2);
  piece.normal = area.normalized();
  check_rows<3>(*s.space, rows_of<3>(*s.space, {piece}), area.norm());
}

TEST(WallRows, OnAGridLineBelongToTheSolidSide) {
  const auto s = boundary_test::scene<2>(2);
  for (const bool up : {true, false}) {
    const auto rows = rows_of<2>(
        *s.space, WallShape<2>(PolylineWall{{{1.0, 1.5}, {2.0, 1.5}}, up ? LineSide::left : LineSide::right})
                      .pieces(1.0, {}));
    ASSERT_EQ(rows.size(), 2u);  // a vertex of the grid lies between
    for (const auto& row : rows) {
      const MultiIndex<2> cell = s.space->window().cell_multi_index(row.cell);
      EXPECT_EQ(cell[1], up ? 3 : 2);
      EXPECT_DOUBLE_EQ(row.size, 0.5);
    }
  }
}

TEST(WallRows, CornersInACellHaveOneForEachSide) {
  const auto s = boundary_test::scene<2>(2);
  const auto rows = rows_of<2>(
      *s.space,
      WallShape<2>(PolylineWall{{{0.5, 0.9}, {0.7, 0.7}, {0.9, 0.9}}, LineSide::left}).pieces(1.0, {}));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].cell, rows[1].cell);
  EXPECT_NEAR(rows[0].normal.dot(rows[1].normal), 0.0, 1e-15);
}

TEST(WallRows, LeaveOutWhatLiesOutsideTheGrid) {
  const auto s = boundary_test::scene<2>(2);
  double size = 0.0;
  for (const auto& row :
       rows_of<2>(*s.space, WallShape<2>(PolylineWall{{{-3.0, 2.1}, {7.0, 2.1}}}).pieces(1.0, {})))
    size += row.size;
  EXPECT_NEAR(size, 4.0, 1e-14);
  EXPECT_TRUE(rows_of<2>(*s.space, WallShape<2>(PolylineWall{{{-3, -2}, {7, -2}}}).pieces(1.0, {})).empty());
}

}  // namespace
}  // namespace wisp
