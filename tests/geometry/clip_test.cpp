// Boxes cut by shapes and planes: nothing is lost or counted twice.
#include "geometry/clip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/error.h"

namespace wisp {
namespace {

template <int dim>
using Point = Eigen::Matrix<double, dim, 1>;

template <int dim>
struct Sum {
  double volume = 0.0;
  Point<dim> first = Point<dim>::Zero();
  void add(const ClippedBox<dim>& part) { volume += part.volume, first += part.volume * part.centroid; }
};

TEST(Clip, PartsOfAnInclinedSquareSumToIt) {
  for (const double angle : {0.0, 0.3, 0.7854, 1.2}) {
    const double c = std::cos(angle), s = std::sin(angle);
    std::vector<Eigen::Vector2d> ring;
    for (const auto& [x, y] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
      ring.push_back({c * x - s * y + 0.1, s * x + c * y});
    const Region<2> shape = Outline({ring});
    Sum<2> sum;
    for (int i = -16; i < 16; ++i)
      for (int j = -16; j < 16; ++j)
        sum.add(clip_box<2>(shape, {}, {0.1 * i, 0.1 * j}, {0.1 * (i + 1), 0.1 * (j + 1)}));
    EXPECT_NEAR(sum.volume, 4.0, 2e-14 * 4.0);
    EXPECT_NEAR(sum.first[0] / 4.0, 0.1, 1e-13);
    EXPECT_NEAR(sum.first[1] / 4.0, 0.0, 1e-13);
  }
}

TEST(Clip, AWholeBoxKeepsItsSpread) {
  const Region<2> shape = Block<2>{{0.0, 0.0}, {3.0, 3.0}};
  const auto part = clip_box<2>(shape, {}, {1.0, 1.0}, {1.5, 2.0});
  EXPECT_DOUBLE_EQ(part.volume, 0.5);
  EXPECT_NEAR(part.variance[0], 0.25 / 12.0, 1e-15);
  EXPECT_NEAR(part.variance[1], 1.0 / 12.0, 1e-15);
}

TEST(Clip, ATriangleHasTheCentroidAndSpreadOfOne) {
  const Region<2> shape = Block<2>{{0.0, 0.0}, {1.0, 1.0}};
  // Below the diagonal x + y = 1
  const auto part = clip_box<2>(shape, {{{1.0, 0.0}, {-1.0, -1.0}}}, {0.0, 0.0}, {1.0, 1.0});
  EXPECT_NEAR(part.volume, 0.5, 1e-15);
  EXPECT_NEAR(part.centroid[0], 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(part.variance[1], 1.0 / 18.0, 1e-15);
}

TEST(Clip, BothSidesOfAPlaneMakeUpTheBox) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const Region<3> shape = Block<3>{{-5.0, -5.0, -5.0}, {5.0, 5.0, 5.0}};
  const Point<3> a(-1.0, -0.5, -0.8), b(0.7, 1.0, 0.9);
  const double whole = (b - a).prod();
  for (int k = 0; k < 200; ++k) {
    const Point<3> at(u(random), u(random), u(random)), n(u(random), u(random), u(random));
    const HalfSpace<3> other{{u(random), u(random), u(random)}, {u(random), u(random), u(random)}};
    const auto all = clip_box<3>(shape, {other}, a, b);
    const auto one = clip_box<3>(shape, {other, {at, n}}, a, b),
               two = clip_box<3>(shape, {other, {at, -n}}, a, b);
    EXPECT_NEAR(one.volume + two.volume, all.volume, 2e-14 * whole);
    EXPECT_LT((one.volume * one.centroid + two.volume * two.centroid - all.volume * all.centroid).norm(),
              1e-13 * whole);
  }
}

TEST(Clip, ATurnedCubeIsWholeOverAGrid) {
  const Region<3> shape = Block<3>{{-2.0, -2.0, -2.0}, {2.0, 2.0, 2.0}};
  const Eigen::Matrix3d r =
      (Eigen::Matrix3d() << 0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6).finished();
  std::vector<HalfSpace<3>> cuts;
  for (int d = 0; d < 3; ++d)
    for (const double sign : {1.0, -1.0}) cuts.push_back({-sign * r.col(d), sign * r.col(d)});
  Sum<3> sum;
  for (int i = -8; i < 8; ++i)
    for (int j = -8; j < 8; ++j)
      for (int k = -8; k < 8; ++k) {
        const Point<3> low(0.25 * i, 0.25 * j, 0.25 * k);
        sum.add(clip_box<3>(shape, cuts, low, low + Point<3>::Constant(0.25)));
      }
  EXPECT_NEAR(sum.volume, 8.0, 1e-13 * 8.0);
  EXPECT_LT(sum.first.norm(), 1e-13);
}

TEST(Clip, APlaneOnAFaceOfTheBoxChangesNothingOrLeavesNothing) {
  const Region<3> shape = Block<3>{{0.0, 0.0, 0.0}, {2.0, 2.0, 2.0}};
  for (int d = 0; d < 3; ++d)
    for (const double sign : {1.0, -1.0}) {
      const HalfSpace<3> half{Point<3>::Ones(), sign * Point<3>::Unit(d)};
      Point<3> low = Point<3>::Zero(), high = Point<3>::Ones();
      EXPECT_NEAR(clip_box<3>(shape, {half}, low, high).volume, sign > 0 ? 0.0 : 1.0, 1e-15);
      low[d] += 1.0, high[d] += 1.0;
      EXPECT_NEAR(clip_box<3>(shape, {half}, low, high).volume, sign > 0 ? 1.0 : 0.0, 1e-15);
    }
}

TEST(Clip, BallsAreRefused) {
  const Region<2> disc = Sphere<2>{{0.0, 0.0}, 1.0};
  EXPECT_THROW((clip_box<2>(disc, {}, {0.0, 0.0}, {1.0, 1.0})), InputError);
}

}  // namespace
}  // namespace wisp
