#include "particle/mean_motion.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace wisp {
namespace {

template <int dim>
struct Cloud {
  std::vector<double> mass;
  std::vector<Vec<dim>> position, velocity;

  explicit Cloud(int n) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int p = 0; p < n; ++p) {
      mass.push_back(1.5 + any(random));
      Vec<dim> x, v;
      for (int d = 0; d < dim; ++d) x[d] = 0.3 + any(random), v[d] = 2.0 + any(random);
      position.push_back(x), velocity.push_back(v);
    }
  }
  MeanMotion<dim> motion() const {
    std::vector<double> sums(MotionSums<dim>::count, 0.0);
    for (std::size_t p = 0; p < mass.size(); ++p)
      MotionSums<dim>::add(mass[p], position[p], velocity[p], sums.data());
    return MotionSums<dim>::motion(sums.data());
  }
  Vec<dim> momentum() const {
    Vec<dim> sum = Vec<dim>::Zero();
    for (std::size_t p = 0; p < mass.size(); ++p) sum += mass[p] * velocity[p];
    return sum;
  }
  /// sum m (v r^T - r v^T): angular momentum as an antisymmetric matrix.
  Mat<dim> angular_momentum() const {
    Mat<dim> sum = Mat<dim>::Zero();
    for (std::size_t p = 0; p < mass.size(); ++p)
      sum += mass[p] * (velocity[p] * position[p].transpose() - position[p] * velocity[p].transpose());
    return sum;
  }
};

template <int dim>
Mat<dim> some_spin() {
  Mat<dim> w = Mat<dim>::Zero();
  for (int a = 0; a < dim; ++a)
    for (int b = a + 1; b < dim; ++b) w(a, b) = 0.7 + a - 0.4 * b, w(b, a) = -w(a, b);
  return w;
}

template <class Dim>
class MeanMotionOf : public testing::Test {};
using Dims = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(MeanMotionOf, Dims);

TYPED_TEST(MeanMotionOf, RigidPointsIsTheirOwn) {
  constexpr int dim = TypeParam::value;
  Cloud<dim> cloud(9);
  const Mat<dim> w = some_spin<dim>();
  for (std::size_t p = 0; p < 9; ++p) cloud.velocity[p] = Vec<dim>::Ones() + w * cloud.position[p];
  const MeanMotion<dim> motion = cloud.motion();
  EXPECT_LT((motion.spin - w).norm(), 1e-13);
  for (std::size_t p = 0; p < 9; ++p)
    EXPECT_LT((motion.velocity(cloud.position[p]) - cloud.velocity[p]).norm(), 1e-13);
}

TYPED_TEST(MeanMotionOf, AnyPointsKeepsMomentumAndAngularMomentum) {
  constexpr int dim = TypeParam::value;
  Cloud<dim> cloud(7);
  const Vec<dim> momentum = cloud.momentum();
  const Mat<dim> angular = cloud.angular_momentum();
  const MeanMotion<dim> motion = cloud.motion();
  double change = 0.0;
  for (std::size_t p = 0; p < 7; ++p) {
    const Vec<dim> v = motion.velocity(cloud.position[p]);
    change += (v - cloud.velocity[p]).norm();
    cloud.velocity[p] = v;
  }
  EXPECT_GT(change, 1.0);
  EXPECT_LT((cloud.momentum() - momentum).norm(), 1e-13 * momentum.norm());
  EXPECT_LT((cloud.angular_momentum() - angular).norm(), 1e-13 * angular.norm());
}

TYPED_TEST(MeanMotionOf, PointsOnALineOrInOnePlaceIsFiniteAndKeepsBoth) {
  constexpr int dim = TypeParam::value;
  for (const double spread : {1.0, 0.0}) {
    Cloud<dim> cloud(5);
    const Vec<dim> along = Vec<dim>::Ones().normalized();
    for (auto& x : cloud.position) x = Vec<dim>::Constant(0.2) + spread * x[0] * along;
    const Vec<dim> momentum = cloud.momentum();
    const Mat<dim> angular = cloud.angular_momentum();
    const MeanMotion<dim> motion = cloud.motion();
    ASSERT_TRUE(motion.spin.allFinite());
    for (std::size_t p = 0; p < 5; ++p) cloud.velocity[p] = motion.velocity(cloud.position[p]);
    EXPECT_LT((cloud.momentum() - momentum).norm(), 1e-13 * momentum.norm());
    EXPECT_LT((cloud.angular_momentum() - angular).norm(), 1e-12 * momentum.norm());
  }
}

TEST(MeanMotion, OfNothingIsZero) {
  const std::vector<double> sums(MotionSums<2>::count, 0.0);
  EXPECT_EQ(MotionSums<2>::motion(sums.data()).velocity(Vec<2>(1.0, 2.0)).norm(), 0.0);
}

}  // namespace
}  // namespace wisp
