// Conditions on lines, planes, nodes and parts of them; how they are prescribed in time.
#include "boundary/list.h"

#include <gtest/gtest.h>

#include "boundary/samples.h"

namespace wisp {
namespace {

using namespace boundary_test;

ConformingOptions on(const std::string& normal, double at, std::vector<std::string> directions) {
  ConformingOptions o;
  o.label = "wall", o.normal = normal, o.at = at, o.directions = std::move(directions);
  return o;
}

Curve curve(std::vector<double> times, std::vector<double> values) {
  Curve c;
  c.times = std::move(times), c.values = std::move(values);
  return c;
}

TEST(Conforming, HoldsTheNodesOfALine) {
  const auto s = scene<2>(2);
  const Conforming<2> wall(on("x", 1.5, {"y"}), *s.space);
  EXPECT_EQ(wall.functions().size(), 8U);
  for (const int i : wall.functions()) EXPECT_EQ(s.space->node_position(i)[0], 1.5);
  EXPECT_FALSE(wall.holds(0));
  EXPECT_TRUE(wall.holds(1));
  EXPECT_EQ(held_edges<2>({wall}).side, (std::array<bool, 4>{}));
}

TEST(Conforming, HoldsTheNodesOfAPlaneAndOfAPartOfIt) {
  const auto s = scene<3>(2);
  auto options = on("z", 4.0, {"x", "z"});
  const Conforming<3> plane(options, *s.space);
  EXPECT_EQ(plane.functions().size(), 64U);
  EXPECT_TRUE(plane.on_edge(2, 1));
  EXPECT_FALSE(plane.on_edge(2, 0) || plane.on_edge(0, 0) || plane.on_edge(1, 1));
  options.lower = {0.4, 1.0, 0.0}, options.upper = {2.0, 1.9, 4.0};
  const Conforming<3> part(options, *s.space);
  EXPECT_EQ(part.functions().size(), 4U * 2U);
  for (const int i : part.functions()) {
    const Vec<3> x = s.space->node_position(i);
    EXPECT_TRUE(x[0] >= 0.4 && x[0] <= 2.0 && x[1] >= 1.0 && x[1] <= 1.9 && x[2] == 4.0);
  }
  EXPECT_FALSE(part.on_edge(2, 1)) << "the rest of the edge is free";
}

TEST(Conforming, HoldsASingleNode) {
  const auto s = scene<2>(2);
  ConformingOptions o;
  o.label = "pin", o.node = {0.0, 4.0}, o.directions = {"x", "y"};
  const Conforming<2> pin(o, *s.space);
  ASSERT_EQ(pin.functions().size(), 1U);
  EXPECT_EQ(s.space->node_position(pin.functions()[0]), Vec<2>(0.0, 4.0));
  EXPECT_EQ(held_edges<2>({pin}).side, (std::array<bool, 4>{})) << "one node does not hold an edge";
}

TEST(Conforming, IsPrescribedByDisplacement) {
  const auto s = scene<2>(2);
  auto o = on("x", 0.0, {"x"});
  o.displacement = curve({0.0, 1.0, 2.0}, {0.0, 3.0, 2.0});
  const Conforming<2> wall(o, *s.space);
  EXPECT_DOUBLE_EQ(wall.increment(0.2, 0.3), 0.9);
  EXPECT_DOUBLE_EQ(wall.increment(0.5, 1.0), 1.0);
  EXPECT_DOUBLE_EQ(wall.velocity(0.2, 0.3), 3.0);
  EXPECT_DOUBLE_EQ(wall.velocity(0.5, 1.0), 1.0);
}

TEST(Conforming, IsPrescribedByVelocity) {
  const auto s = scene<2>(2);
  auto o = on("x", 0.0, {"x"});
  o.velocity = curve({0.0, 2.0}, {0.0, 4.0});
  const Conforming<2> wall(o, *s.space);
  EXPECT_DOUBLE_EQ(wall.velocity(0.5, 0.5), 2.0);
  EXPECT_DOUBLE_EQ(wall.velocity(0.5, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(wall.increment(0.5, 1.0), 2.0);
}

TEST(Conforming, MotionVariesLinearlyByItsProfile) {
  const auto s = scene<2>(2);
  auto o = on("x", 0.0, {"x"});
  o.velocity = curve({0.0, 2.0}, {0.0, 4.0}), o.profile = {0.5, 3.0, -2.0};
  const std::vector<AnyBoundary<2>> conditions{Conforming<2>(o, *s.space)};
  Constraints<2> c = constraints_of(conditions, s.space->n_functions());
  set_velocities(conditions, 0.0, 1.0, c);
  ASSERT_FALSE(c.held.empty());
  for (const std::size_t k : c.held) {
    const Vec<2> x = s.space->node_position(static_cast<int>(k / 2));
    EXPECT_DOUBLE_EQ(c.prescribed(k), 2.0 * (0.5 + 3.0 * x[0] - 2.0 * x[1]));
  }
  o.profile = {1.0, 2.0};
  EXPECT_THROW(Conforming<2>(o, *s.space), InputError);
}

TEST(Conforming, TheLastConditionWins) {
  const auto s = scene<2>(2);
  const std::vector<AnyBoundary<2>> conditions{Conforming<2>(on("x", 0.0, {"x", "y"}), *s.space),
                                               Conforming<2>(on("y", 0.0, {"y"}), *s.space)};
  const Constraints<2> c = constraints_of(conditions, s.space->n_functions());
  const auto at = [&](int i, int j) {
    return static_cast<std::size_t>(2 * s.space->window().node_index({i, j}));
  };
  EXPECT_EQ(c.condition[at(0, 0)], 0);
  EXPECT_EQ(c.condition[at(0, 0) + 1], 1);
  EXPECT_EQ(c.condition[at(0, 3) + 1], 0);
  EXPECT_EQ(c.condition[at(3, 0) + 1], 1);
  EXPECT_EQ(c.condition[at(3, 0)], -1);
  EXPECT_EQ(std::count(c.fixed.begin(), c.fixed.end(), 1), 8 + 8 + 7);
  EXPECT_EQ(held_edges(conditions).side, (std::array<bool, 4>{true, false, true, false}));
}

TEST(Conforming, WrongDescriptionsAreInputErrors) {
  const auto s = scene<2>(2);
  const auto wrong = [&](auto&& change) {
    auto o = on("x", 0.0, {"x"});
    change(o);
    EXPECT_THROW(Conforming<2>(o, *s.space), InputError);
  };
  wrong([](auto& o) { o.normal = ""; });
  wrong([](auto& o) { o.normal = "z"; });
  wrong([](auto& o) { o.node = {0.0, 0.0}; });
  wrong([](auto& o) { o.at = 0.1; });
  wrong([](auto& o) { o.directions = {}; });
  wrong([](auto& o) { o.directions = {"q"}; });
  wrong([](auto& o) { o.lower = {1.0}; });
  wrong([](auto& o) { o.lower = {0.0, 5.0}; });
  wrong([](auto& o) { o.displacement = Curve(1.0), o.velocity = Curve(1.0); });
}

}  // namespace
}  // namespace wisp
