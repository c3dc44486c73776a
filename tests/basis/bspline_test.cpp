// B-splines: the contract of a basis, and what de Koster 2018 shows of them.
#include "basis/bspline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "basis/samples.h"

namespace wisp {
namespace {

using namespace basis_test;

template <class Basis>
struct BSplineContract : testing::Test {
  static constexpr int dimension = Basis::dimension;
  /// Calls f(basis, x) for points of grids, simple knots and repeated ones.
  template <class F>
  void for_each_sample(F&& f) {
    constexpr int dim = dimension;
    for (const auto& grid : {equal_grid<dim>(), unequal_grid<dim>()})
      for (const bool repeated : {false, true}) {
        std::array<std::vector<int>, dim> multiplicity;
        if (repeated) multiplicity[0] = {1, 2, 1, Basis::degree + 1, 1, std::min(2, Basis::degree)};
        const Basis basis(grid, multiplicity);
        for (const auto& x : positions(grid, dim == 2 ? 60 : 20)) f(basis, x);
      }
  }
};

using Bases = testing::Types<BSpline<2, 1>, BSpline<2, 2>, BSpline<2, 3>, BSpline<2, 4>, BSpline<2, 6>,
                             BSpline<3, 2>, BSpline<3, 3>>;
TYPED_TEST_SUITE(BSplineContract, Bases);

TYPED_TEST(BSplineContract, SumsToOneAndReproducesLinearFields) {
  constexpr int dim = TypeParam::dimension;
  this->for_each_sample([](const auto& basis, const Vec<dim>& x) {
    double sum = 0.0;
    Vec<dim> sum_gradient = Vec<dim>::Zero(), position = Vec<dim>::Zero();
    Mat<dim> gradient = Mat<dim>::Zero();
    const auto stencil = basis.tabulate(x, Vec<dim>::Zero());
    ASSERT_GE(stencil.key(), 0);
    ASSERT_LT(stencil.key(), basis.n_functions());
    stencil.for_each([&](int, int i, double phi, const Vec<dim>& dphi) {
      ASSERT_GE(i, 0);
      ASSERT_LT(i, basis.n_functions());
      ASSERT_GE(phi, 0.0);
      sum += phi, sum_gradient += dphi;
      position += phi * basis.control_point(i);
      gradient += basis.control_point(i) * dphi.transpose();
    });
    ASSERT_NEAR(sum, 1.0, 4e-15);
    ASSERT_LT(sum_gradient.norm(), 2e-13);
    ASSERT_LT((position - x).norm(), 4e-15 * (1.0 + x.norm()));
    ASSERT_LT((gradient - Mat<dim>::Identity()).norm(), 2e-13);
  });
}

TYPED_TEST(BSplineContract, GradientsAreTheDerivativesOfTheValues) {
  constexpr int dim = TypeParam::dimension;
  this->for_each_sample([](const auto& basis, const Vec<dim>& x) {
    const double step = 1e-6;
    const auto here = basis.tabulate(x, Vec<dim>::Zero());
    for (int d = 0; d < dim; ++d) {
      Vec<dim> up = x, down = x;
      up[d] += step, down[d] -= step;
      const auto& grid = basis.grid();
      if (grid.locate_inside(d, up[d]) != grid.locate_inside(d, down[d])) return;
      const auto above = basis.tabulate(up, Vec<dim>::Zero()), below = basis.tabulate(down, Vec<dim>::Zero());
      std::vector<double> high, low;
      above.for_each([&](int, int, double phi, const Vec<dim>&) { high.push_back(phi); });
      below.for_each([&](int, int, double phi, const Vec<dim>&) { low.push_back(phi); });
      here.for_each([&](int k, int, double, const Vec<dim>& dphi) {
        const auto i = static_cast<std::size_t>(k);
        ASSERT_NEAR((high[i] - low[i]) / (2.0 * step), dphi[d], 1e-6);
      });
    }
  });
}

TYPED_TEST(BSplineContract, ReproducesPolynomialsToItsDegree) {
  // The coefficient of x^p is the product of the p knots inside the support (the blossom of x^p), of lower
  // powers the mean of their products.
  constexpr int dim = TypeParam::dimension, p = TypeParam::degree;
  this->for_each_sample([](const auto& basis, const Vec<dim>& x) {
    for (int power = 0; power <= p; ++power)
      for (int d = 0; d < dim; ++d) {
        const auto coefficient = [&](int i) {
          // Elementary symmetric polynomial of the knots i + 1 .. i + p over the number of its terms.
          std::array<double, p + 1> e{};
          e[0] = 1.0;
          for (int k = 1; k <= p; ++k)
            for (int j = k; j > 0; --j)
              e[static_cast<std::size_t>(j)] += e[static_cast<std::size_t>(j - 1)] *
                                                basis.knots(d).knots()[static_cast<std::size_t>(i + k)];
          double terms = 1.0;
          for (int k = 0; k < power; ++k) terms *= static_cast<double>(p - k) / (k + 1);
          return e[static_cast<std::size_t>(power)] / terms;
        };
        double sum = 0.0;
        basis.tabulate(x, Vec<dim>::Zero()).for_each([&](int, int i, double phi, const Vec<dim>&) {
          for (int e = 0; e < d; ++e) i /= basis.n_functions(e);
          sum += phi * coefficient(i % basis.n_functions(d));
        });
        ASSERT_NEAR(sum, std::pow(x[d], power), 1e-13 * std::max(1.0, std::pow(3.0, power)));
      }
  });
}

TEST(BSplineOfDegreeOne, IsTheLinearBasis) {
  for (const auto& grid : {equal_grid<2>(), unequal_grid<2>()}) {
    const Space<2> space(grid, BoxPartition<2>(grid.cells()), false);
    const NodeNumbering<2> numbering(space.window());
    const BSpline<2, 1> splines(grid, numbering);
    const Linear<2> linear(grid, numbering);
    for (const auto& x : positions(grid, 60)) {
      const auto a = splines.tabulate(x, Vec<2>::Zero()), b = linear.tabulate(x, Vec<2>::Zero());
      ASSERT_EQ(a.base, b.base);
      ASSERT_EQ(a.stride, b.stride);
      for (std::size_t d = 0; d < 2; ++d)
        for (std::size_t k = 0; k < 2; ++k) {
          ASSERT_NEAR(a.value[d][k], b.value[d][k], 4e-16);
          ASSERT_NEAR(a.derivative[d][k], b.derivative[d][k], 1e-14);
        }
    }
  }
}

/// Values of all functions just above and below a knot.
template <int degree>
double derivative_jump(const KnotVector& knots, int cell, double x) {
  std::vector<double> jump(static_cast<std::size_t>(knots.n_functions()), 0.0);
  std::array<double, degree + 1> value, derivative;
  for (int side = 0; side < 2; ++side) {
    knots.evaluate<degree>(cell + side, x, value, derivative);
    for (int i = 0; i <= degree; ++i)
      jump[static_cast<std::size_t>(knots.first_function(cell + side) + i)] +=
          (side == 0 ? -1.0 : 1.0) * derivative[static_cast<std::size_t>(i)];
  }
  double largest = 0.0;
  for (const double j : jump) largest = std::max(largest, std::abs(j));
  return largest;
}

TEST(KnotVector, RepeatedKnotsLowerTheSmoothness) {
  // Figures 3.12 and 3.13 of de Koster 2018: knots 0 0 0 1 2 3 4 (4) 5 5 5.
  const std::vector<double> lines{0, 1, 2, 3, 4, 5};
  const KnotVector simple(2, lines), kinked(2, lines, {1, 1, 1, 2});
  EXPECT_EQ(simple.knots(), (std::vector<double>{0, 0, 0, 1, 2, 3, 4, 5, 5, 5}));
  EXPECT_EQ(kinked.knots(), (std::vector<double>{0, 0, 0, 1, 2, 3, 4, 4, 5, 5, 5}));
  EXPECT_EQ(simple.n_functions(), 7);
  EXPECT_EQ(kinked.n_functions(), 8);
  for (int cell = 0; cell < 4; ++cell) EXPECT_LT(derivative_jump<2>(simple, cell, cell + 1.0), 1e-14);
  for (int cell = 0; cell < 3; ++cell) EXPECT_LT(derivative_jump<2>(kinked, cell, cell + 1.0), 1e-14);
  EXPECT_GT(derivative_jump<2>(kinked, 3, 4.0), 1.0);
}

TEST(KnotVector, EdgeFunctionsInterpolateAndInnerOnesAreTheCardinalSplines) {
  const std::vector<double> lines{0, 1, 2, 3, 4, 5, 6, 7};
  const KnotVector quadratic(2, lines), cubic(3, lines);
  std::array<double, 3> v2, d2;
  quadratic.evaluate<2>(0, 0.0, v2, d2);
  EXPECT_EQ(v2[0], 1.0);
  EXPECT_EQ(d2[0], -2.0);
  quadratic.evaluate<2>(3, 3.25, v2, d2);  // (1-r)^2/2, 1/2 + r(1-r), r^2/2
  EXPECT_NEAR(v2[0], 0.28125, 1e-15);
  EXPECT_NEAR(v2[1], 0.6875, 1e-15);
  EXPECT_NEAR(v2[2], 0.03125, 1e-15);
  std::array<double, 4> v3, d3;
  cubic.evaluate<3>(3, 3.0, v3, d3);  // 1/6, 4/6, 1/6 with slopes -1/2, 0, 1/2
  EXPECT_NEAR(v3[0], 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(v3[1], 4.0 / 6.0, 1e-15);
  EXPECT_NEAR(v3[2], 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(v3[3], 0.0, 1e-15);
  EXPECT_NEAR(d3[0], -0.5, 1e-14);
  EXPECT_NEAR(d3[1], 0.0, 1e-14);
  EXPECT_NEAR(d3[2], 0.5, 1e-14);
}

TEST(KnotVector, RefusesKnotsThatMakeNoSense) {
  EXPECT_THROW(KnotVector(0, {0, 1}), InputError);
  EXPECT_THROW(KnotVector(2, {0}), InputError);
  EXPECT_THROW(KnotVector(2, {0, 1, 1, 2}), InputError);
  EXPECT_THROW(KnotVector(2, {0, 1, 2}, {4}), InputError);
  EXPECT_THROW(KnotVector(2, {0, 1, 2}, {1, 1}), InputError);
}

}  // namespace
}  // namespace wisp
