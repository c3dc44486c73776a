// Jumps of normal derivatives across facets.
#include "basis/facet.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "basis/samples.h"

namespace wisp {
namespace {

using namespace basis_test;

template <class Dim>
struct FacetJumpsTest : testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(FacetJumpsTest, Dimensions);

/// Calls f(space, facet, jumps, cell) for every inner facet of both sample grids.
template <int dim, class F>
void for_each_facet(F&& f) {
  for (const auto& grid : {equal_grid<dim>(), unequal_grid<dim>()}) {
    const Space<dim> space(grid, BoxPartition<dim>(grid.cells()), false);
    for_each_in(space.window().grid_cells(), [&](const MultiIndex<dim>& cell) {
      for (int n = 0; n < dim; ++n)
        if (cell[n] + 1 < grid.cells(n)) {
          const Facet facet{space.window().cell_index(cell), n};
          f(space, facet, facet_jumps<dim>(space, facet), cell);
        }
    });
  }
}

TYPED_TEST(FacetJumpsTest, WeightsSumToTheFacetsSize) {
  constexpr int dim = TypeParam::value;
  for_each_facet<dim>([](const auto& space, const Facet& facet, const auto& jumps, const auto& cell) {
    double size = 1.0, sum = 0.0;
    for (int d = 0; d < dim; ++d)
      if (d != facet.direction) size *= space.grid().spacing(d, cell[d]);
    for (const double w : jumps.weight) sum += w;
    ASSERT_NEAR(sum, size, 1e-15);
    const int n = facet.direction;
    ASSERT_DOUBLE_EQ(jumps.normal_extent,
                     0.5 * (space.grid().spacing(n, cell[n]) + space.grid().spacing(n, cell[n] + 1)));
  });
}

TYPED_TEST(FacetJumpsTest, LinearFieldsHaveNone) {
  constexpr int dim = TypeParam::value;
  for_each_facet<dim>([](const auto& space, const Facet&, const auto& jumps, const auto&) {
    for (const auto& at : jumps.jump) {
      double constant = 0.0;
      Vec<dim> linear = Vec<dim>::Zero();
      for (std::size_t k = 0; k < at.size(); ++k)
        constant += at[k], linear += at[k] * space.node_position(jumps.function[k]);
      ASSERT_NEAR(constant, 0.0, 1e-14);
      ASSERT_LT(linear.norm(), 1e-14);
    }
  });
}

TYPED_TEST(FacetJumpsTest, IsTheDifferenceOfTheNormalDerivativesOfTheLinearBasis) {
  constexpr int dim = TypeParam::value;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for_each_facet<dim>([&](const auto& space, const Facet& facet, const auto& jumps, const auto& cell) {
    std::vector<double> u(static_cast<std::size_t>(space.n_functions()));
    for (auto& v : u) v = unit(random);
    const Linear<dim> linear(space.grid(), NodeNumbering<dim>(space.window()));
    const int n = facet.direction;
    // Integral of the square of the jump over the facet, with three Gauss points a direction.
    const double r[3] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)},
                 w[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double exact = 0.0;
    for (int q = 0; q < (dim == 2 ? 3 : 9); ++q) {
      Vec<dim> x;
      double weight = 1.0;
      int k = q;
      for (int d = 0; d < dim; ++d) {
        if (d == n) {
          x[d] = space.grid().line(d, cell[d] + 1);
          continue;
        }
        const double h = space.grid().spacing(d, cell[d]);
        x[d] = space.grid().line(d, cell[d]) + r[k % 3] * h;
        weight *= w[k % 3] * h;
        k /= 3;
      }
      double jump = 0.0;
      for (const double side : {1.0, -1.0}) {
        Vec<dim> beside = x;
        beside[n] += side * 1e-3;
        linear.tabulate(beside, Vec<dim>::Zero()).for_each([&](int, int i, double, const Vec<dim>& dphi) {
          jump += side * dphi[n] * u[static_cast<std::size_t>(i)];
        });
      }
      exact += weight * jump * jump;
    }
    double ours = 0.0;
    for (std::size_t q = 0; q < jumps.weight.size(); ++q) {
      double jump = 0.0;
      for (std::size_t k = 0; k < jumps.function.size(); ++k)
        jump += jumps.jump[q][k] * u[static_cast<std::size_t>(jumps.function[k])];
      ours += jumps.weight[q] * jump * jump;
    }
    ASSERT_NEAR(ours, exact, 1e-11 * exact);
  });
}

TYPED_TEST(FacetJumpsTest, KernelHasItsDimension) {
  // The jump is a linear (2D) or bilinear (3D) function on the facet: 2 or 4 numbers; all else is free.
  constexpr int dim = TypeParam::value;
  constexpr int n = FacetJumps<dim>::n_functions;
  for_each_facet<dim>([](const auto&, const Facet&, const auto& jumps, const auto&) {
    Eigen::Matrix<double, n, n> matrix = Eigen::Matrix<double, n, n>::Zero();
    for (std::size_t q = 0; q < jumps.weight.size(); ++q) {
      const Eigen::Map<const Eigen::Matrix<double, n, 1>> g(jumps.jump[q].data());
      matrix += jumps.weight[q] * g * g.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, n, n>> solver(matrix);
    const double largest = solver.eigenvalues().maxCoeff();
    int zero = 0;
    for (int k = 0; k < n; ++k) {
      ASSERT_GT(solver.eigenvalues()[k], -1e-14 * largest);
      zero += solver.eigenvalues()[k] < 1e-12 * largest;
    }
    ASSERT_EQ(zero, n - (dim == 2 ? 2 : 4));
  });
}

}  // namespace
}  // namespace wisp
