// Jumps of the highest derivative of B-splines across facets.
#include "basis/bspline_jumps.h"

#include <gtest/gtest.h>

#include "basis/samples.h"

namespace wisp {
namespace {

using namespace basis_test;

template <class Basis>
struct BSplineJumpsTest : testing::Test {};
using Bases = testing::Types<BSpline<2, 1>, BSpline<2, 2>, BSpline<2, 3>, BSpline<2, 4>, BSpline<3, 2>>;
TYPED_TEST_SUITE(BSplineJumpsTest, Bases);

template <class Basis>
auto space_of(const StructuredGrid<Basis::dimension>& grid) {
  BSplineOptions options;
  options.degree = Basis::degree;
  return std::make_unique<Space<Basis::dimension>>(grid, BoxPartition<Basis::dimension>(grid.cells()),
                                                   AnyBasisOptions(options));
}

/// Calls f(space, basis, facet, cell) for every inner facet of both sample grids.
template <class Basis, class F>
void for_each_facet(F&& f) {
  constexpr int dim = Basis::dimension;
  for (const auto& grid : {equal_grid<dim>(), unequal_grid<dim>()}) {
    const auto space = space_of<Basis>(grid);
    const Basis basis(space->grid(), NodeNumbering<dim>(space->window()));
    for_each_in(space->window().grid_cells(), [&](const MultiIndex<dim>& cell) {
      for (int n = 0; n < dim; ++n)
        if (cell[n] + 1 < grid.cells(n) && (dim == 2 || cell.sum() % 3 == 0))
          f(*space, basis, Facet{space->window().cell_index(cell), n}, cell);
    });
  }
}

/// The derivative of order `degree` in direction n of a field in a cell, at a place along the facet: the
/// first derivative is a polynomial of one degree less there, whose highest divided difference is exact.
template <class Basis>
double highest_derivative(const Basis& basis, const std::vector<double>& u,
                          const MultiIndex<Basis::dimension>& cell, int n, Vec<Basis::dimension> x) {
  constexpr int degree = Basis::degree;
  const auto& grid = basis.grid();
  std::vector<double> at, value;
  for (int k = 0; k < degree; ++k) {
    at.push_back(grid.line(n, cell[n]) + (k + 0.5) / degree * grid.spacing(n, cell[n]));
    x[n] = at.back();
    double sum = 0.0;
    basis.tabulate(x, Vec<Basis::dimension>::Zero())
        .for_each([&](int, int i, double, const Vec<Basis::dimension>& dphi) {
          sum += dphi[n] * u[static_cast<std::size_t>(i)];
        });
    value.push_back(sum);
  }
  double factorial = 1.0;
  for (int k = 1; k < degree; ++k) {
    factorial *= k;
    for (int j = degree - 1; j >= k; --j) {
      const auto i = static_cast<std::size_t>(j);
      value[i] = (value[i] - value[i - 1]) / (at[i] - at[i - static_cast<std::size_t>(k)]);
    }
  }
  return factorial * value.back();
}

TYPED_TEST(BSplineJumpsTest, AreTheDifferencesOfTheHighestDerivatives) {
  constexpr int dim = TypeParam::dimension;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const IntervalRule rule = gauss_legendre(6);
  for_each_facet<TypeParam>([&](const auto& space, const auto& basis, const Facet& facet, const auto& cell) {
    std::vector<double> u(static_cast<std::size_t>(space.n_functions()));
    for (auto& v : u) v = unit(random);
    const int n = facet.direction;
    MultiIndex<dim> next = cell;
    ++next[n];
    double exact = 0.0;
    for (int q = 0; q < (dim == 2 ? 6 : 36); ++q) {
      Vec<dim> x = Vec<dim>::Zero();
      double weight = 1.0;
      for (int d = 0, k = q; d < dim; ++d) {
        if (d == n) continue;
        const auto i = static_cast<std::size_t>(k % 6);
        const double h = space.grid().spacing(d, cell[d]);
        x[d] = space.grid().line(d, cell[d]) + rule.place[i] * h;
        weight *= rule.weight[i] * h;
        k /= 6;
      }
      const double jump = highest_derivative(basis, u, next, n, x) - highest_derivative(basis, u, cell, n, x);
      exact += weight * jump * jump;
    }
    const auto jumps = bspline_jumps(space, basis, facet);
    double ours = 0.0;
    for (std::size_t q = 0; q < jumps.weight.size(); ++q) {
      double jump = 0.0;
      for (std::size_t k = 0; k < jumps.function.size(); ++k)
        jump += jumps.jump[q][k] * u[static_cast<std::size_t>(jumps.function[k])];
      ours += jumps.weight[q] * jump * jump;
    }
    ASSERT_NEAR(ours, exact, 1e-8 * exact);
  });
}

TEST(BSplineJumps, OfDegreeOneAreThoseOfTheLinearFunctions) {
  for_each_facet<BSpline<2, 1>>([](const auto& space, const auto& basis, const Facet& facet, const auto&) {
    const auto ours = bspline_jumps(space, basis, facet);
    const auto linear = facet_jumps<2>(space, facet);
    EXPECT_EQ(ours.function, linear.function);
    EXPECT_EQ(ours.normal_extent, linear.normal_extent);
    for (std::size_t q = 0; q < 2; ++q) {
      EXPECT_NEAR(ours.weight[q], linear.weight[q], 1e-15);
      for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(ours.jump[q][k], linear.jump[q][k], 1e-13);
    }
  });
}

TEST(BSplineJumps, MomentIsTheMassOfOneJumpOverALength) {
  // 1/(p!)^2 times the integral of x^(2 p) from 0 to h.
  EXPECT_NEAR(jump_moment(1, 0.5), 0.125 / 3.0, 1e-16);
  EXPECT_NEAR(jump_moment(2, 0.5), 0.03125 / 20.0, 1e-17);
  EXPECT_NEAR(jump_moment(3, 2.0), 128.0 / 252.0, 1e-15);
}

}  // namespace
}  // namespace wisp
