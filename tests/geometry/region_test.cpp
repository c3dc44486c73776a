#include "geometry/region.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <set>
#include <string>

#include "geometry/csv.h"
#include "scratch.h"

namespace wisp {
namespace {

/// The whole range from the first trial on: RapidCheck's own ranges start small and grow.
double uniform(double low, double high) {
  return low + (high - low) * *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 1000001)) / 1e6;
}

TEST(Region, BoxAndBallInBothDimensions) {
  const auto box = region<3>(AnyRegion(Box{{0, 1, 2}, {1, 3, 5}}));
  EXPECT_DOUBLE_EQ(measure(box), 6.0);
  EXPECT_EQ(bounds(box).upper, Eigen::Vector3d(1, 3, 5));
  EXPECT_TRUE(contains(box, Eigen::Vector3d(0, 1, 2)));
  EXPECT_FALSE(contains(box, Eigen::Vector3d(0.5, 2, 5)));
  const auto disc = region<2>(AnyRegion(Ball{{1, 2}, 0.5}));
  EXPECT_DOUBLE_EQ(measure(disc), std::numbers::pi / 4.0);
  EXPECT_EQ(bounds(disc).lower, Eigen::Vector2d(0.5, 1.5));
  EXPECT_TRUE(contains(disc, Eigen::Vector2d(1.3, 2.3)));
  EXPECT_FALSE(contains(disc, Eigen::Vector2d(1.4, 2.4)));
  EXPECT_DOUBLE_EQ(measure(region<3>(AnyRegion(Ball{{0, 0, 0}, 2.0}))), 32.0 / 3.0 * std::numbers::pi);
}

TEST(Region, PolygonIsScaledThenShifted) {
  const Polygon polygon{.vertices = {{0, 0}, {2, 0}, {0, 1}}, .scale = 3.0, .offset = {10, 20}};
  const auto triangle = region<2>(AnyShape(polygon));
  EXPECT_DOUBLE_EQ(measure(triangle), 9.0);
  EXPECT_EQ(bounds(triangle).lower, Eigen::Vector2d(10, 20));
  EXPECT_EQ(bounds(triangle).upper, Eigen::Vector2d(16, 23));
  EXPECT_TRUE(contains(triangle, Eigen::Vector2d(11, 21)));
}

TEST(Region, PolygonHasHolesInTheCase) {
  const Polygon polygon{.vertices = {{0, 0}, {4, 0}, {4, 4}, {0, 4}},
                        .holes = {{{1, 1}, {2, 1}, {2, 2}, {1, 2}}}};
  const auto frame = region<2>(AnyRegion(polygon));
  EXPECT_DOUBLE_EQ(measure(frame), 15.0);
  EXPECT_FALSE(contains(frame, Eigen::Vector2d(1.5, 1.5)));
  EXPECT_TRUE(contains(frame, Eigen::Vector2d(3, 3)));
}

TEST(Region, PolygonFileWithHolesCommentsAndBothLineEndings) {
  const Scratch scratch;
  scratch.write("frame.csv",
                "\xef\xbb\xbf# a frame\r\nx,y\r\n0, "
                "0\r\n4,0\r\n4,+4\r\n0,4\r\n\r\n\r\n1,1\n2,1\n2,2\n1,2\n\n3,3\n3.5,3\n3.5,3.5");
  const auto frame = region<2>(AnyShape(Polygon{.file = "frame.csv"}), scratch.folder());
  EXPECT_DOUBLE_EQ(measure(frame), 16.0 - 1.0 - 0.125);
  EXPECT_FALSE(contains(frame, Eigen::Vector2d(1.5, 1.5)));
  EXPECT_TRUE(contains(frame, Eigen::Vector2d(2.5, 1.5)));
  // An absolute path does not depend on the folder.
  const auto path = (scratch.folder() / "frame.csv").string();
  EXPECT_DOUBLE_EQ(measure(region<2>(AnyShape(Polygon{.file = path}), "/nowhere")), measure(frame));
}

RC_GTEST_PROP(Region, APointBelongsToOneOfTheBoxesThatTile, ()) {
  const double a = uniform(-1.0, 0.0), b = uniform(0.1, 0.9), c = uniform(1.0, 2.0);
  const auto left = region<2>(AnyRegion(Box{{a, 0}, {b, 1}})),
             right = region<2>(AnyRegion(Box{{b, 0}, {c, 1}}));
  const Eigen::Vector2d x(*rc::gen::element(a, b, 0.5 * (a + b), 0.5 * (b + c)), uniform(0.0, 0.999));
  RC_ASSERT(contains(left, x) != contains(right, x));
}

RC_GTEST_PROP(Region, PolygonsAgreeWithBoxes, ()) {
  const Eigen::Vector2d lower(uniform(-2, 0), uniform(-2, 0)), upper(uniform(0.1, 2), uniform(0.1, 2));
  const auto box = region<2>(AnyRegion(Box{{lower[0], lower[1]}, {upper[0], upper[1]}}));
  const auto polygon = region<2>(AnyRegion(Polygon{
      .vertices = {{lower[0], lower[1]}, {upper[0], lower[1]}, {upper[0], upper[1]}, {lower[0], upper[1]}}}));
  const double xs[] = {lower[0], upper[0], uniform(-2, 2)}, ys[] = {lower[1], upper[1], uniform(-2, 2)};
  for (const double x : xs)
    for (const double y : ys)
      RC_ASSERT(contains(box, Eigen::Vector2d(x, y)) == contains(polygon, Eigen::Vector2d(x, y)));
  RC_ASSERT(std::abs(measure(box) - measure(polygon)) <= 1e-14 * measure(box));
}

RC_GTEST_PROP(Region, WhatIsContainedLiesInTheBounds, ()) {
  const auto ball =
      region<3>(AnyRegion(Ball{{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}, uniform(0.1, 1.0)}));
  const Eigen::Vector3d x(uniform(-2, 2), uniform(-2, 2), uniform(-2, 2));
  if (contains(ball, x)) RC_ASSERT(bounds(ball).contains(x));
}

TEST(Points, ColumnsInAnyOrder) {
  const Scratch scratch;
  scratch.write("points.csv",
                "# two points\n volume , y, x,ly,lx,vx,vy\n0.5,2,1,.25,.5,-1,1e1\n\n0.25,4,3,.1,.2,0,-0\n");
  const auto table = read_points<2>({"points.csv"}, scratch.folder());
  ASSERT_EQ(table.positions.size(), 2u);
  EXPECT_EQ(table.positions[0], Eigen::Vector2d(1, 2));
  EXPECT_EQ(table.volumes[1], 0.25);
  EXPECT_EQ(table.velocities[0], Eigen::Vector2d(-1, 10));
  EXPECT_EQ(table.half_lengths[1], Eigen::Vector2d(0.2, 0.1));
  EXPECT_DOUBLE_EQ(measure(table), 0.75);
  EXPECT_EQ(bounds(table).lower, Eigen::Vector2d(0.5, 1.75));
  EXPECT_EQ(bounds(table).upper, Eigen::Vector2d(3.2, 4.1));
}

TEST(Points, OptionalColumnsLeftOutIn3D) {
  const Scratch scratch;
  scratch.write("points.csv", "x,y,z,volume\n1,2,3,4");
  const auto table = read_points<3>({"points.csv"}, scratch.folder());
  ASSERT_EQ(table.positions.size(), 1u);
  EXPECT_EQ(table.positions[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(table.volumes[0], 4.0);
  EXPECT_TRUE(table.velocities.empty());
  EXPECT_TRUE(table.half_lengths.empty());
}

RC_GTEST_PROP(Points, NumbersSurviveTheFileToTheLastBit, ()) {
  const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 20));
  std::vector<double> values;
  std::string text = "x,y,volume\n";
  for (std::size_t i = 0; i < n; ++i) {
    const double x = uniform(-1, 1) * 1e-3, y = uniform(-1, 1) / 3.0, v = uniform(0.1, 1) / 7.0;
    values.insert(values.end(), {x, y, v});
    text += fmt::format("{:.17g},{:.17g},{:.17g}\n", x, y, v);
  }
  const Scratch scratch;
  scratch.write("points.csv", text);
  const auto table = read_points<2>({"points.csv"}, scratch.folder());
  RC_ASSERT(table.positions.size() == n);
  for (std::size_t i = 0; i < n; ++i) {
    RC_ASSERT(table.positions[i] == Eigen::Vector2d(values[3 * i], values[3 * i + 1]));
    RC_ASSERT(table.volumes[i] == values[3 * i + 2]);
  }
}

RC_GTEST_PROP(Csv, AnyTextEitherReadsOrGivesOneLine, ()) {
  const auto pieces = *rc::gen::container<std::vector<std::string>>(rc::gen::element<std::string>(
      "x", "y", "volume", ",", ",", "\n", "1", "-2.5", "1e", "nan", " ", "#", "\r\n", "\xff"));
  std::string text = *rc::gen::element<std::string>("", "x,y,volume\n");
  for (const auto& piece : pieces) text += piece;
  const Scratch scratch;
  scratch.write("any.csv", text);
  const std::string message = message_of([&] { read_points<2>({"any.csv"}, scratch.folder()); });
  RC_ASSERT(message == "(no error)" || says(message, "any.csv:"));
}

TEST(List, NamesAndKeysAreUniqueAndExplained) {
  std::set<std::string_view> names;
  const auto check = [&]<class Shape>(const Shape&) {
    static_assert(Described<Shape>);
    EXPECT_TRUE(names.insert(Shape::name).second) << Shape::name;
    EXPECT_FALSE(Shape::summary.empty());
    std::set<std::string_view> keys;
    for_each_key<Shape>([&](const auto& k) {
      EXPECT_TRUE(keys.insert(k.name).second) << k.name;
      EXPECT_FALSE(k.meaning.empty());
    });
  };
  check(Box{});
  check(Ball{});
  check(Polygon{});
  check(PointFile{});
  check(MeshShape{});
  check(StlSolid{});
  EXPECT_EQ(names.size(), std::variant_size_v<AnyShape>);
}

}  // namespace
}  // namespace wisp
