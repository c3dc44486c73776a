// GIMP against its closed form and its limits.
#include <gtest/gtest.h>

#include "basis/samples.h"

namespace wisp {
namespace {

using namespace basis_test;

/// Antiderivative of the hat of node i, zero at its lower foot; nodes on an edge of the grid continue beyond
/// it as the constant 1.
long double antiderivative(const StructuredGrid<2>& grid, int d, int i, double at) {
  const long double x = at, xi = grid.line(d, i), n = grid.cells(d);
  const long double below = xi - grid.line(d, i - 1), above = grid.line(d, i + 1) - xi;
  if (x <= xi) {
    if (i == 0) return x - xi;
    const long double r = std::max(0.0L, (x - xi + below) / below);
    return below * r * r / 2;
  }
  const long double start = i == 0 ? 0.0L : below / 2;
  if (i == n) return start + x - xi;
  const long double r = std::min(1.0L, (x - xi) / above);
  return start + above * (r - r * r / 2);
}

/// The hat itself, continued likewise.
double hat(const StructuredGrid<2>& grid, int d, int i, double x) {
  const double xi = grid.line(d, i);
  if (x <= xi) return i == 0 ? 1.0 : std::max(0.0, 1.0 - (xi - x) / grid.spacing(d, i - 1));
  return i == grid.cells(d) ? 1.0 : std::max(0.0, 1.0 - (x - xi) / grid.spacing(d, i));
}

template <class Basis>
struct GimpForm : testing::Test {};
using Widths = testing::Types<Gimp<2, 3>, Gimp<2, 5>>;
TYPED_TEST_SUITE(GimpForm, Widths);

TYPED_TEST(GimpForm, IsTheClosedForm) {
  for (const auto& grid : {equal_grid<2>(), unequal_grid<2>()}) {
    const Space<2> space(grid, BoxPartition<2>(grid.cells()), true);
    const TypeParam basis(space.grid(), NodeNumbering<2>(space.window()));
    for (const auto& x : positions(grid, 200))
      for (const double length : half_lengths(TypeParam::width, grid.shortest_side())) {
        if (length < 1e-3 * grid.shortest_side()) continue;  // the closed form cancels there
        const Vec<2> l(length, 0.9 * length);
        const auto e = evaluate<2>(space, basis, x, l);
        for (int i = 0; i < space.n_functions(); ++i) {
          const MultiIndex<2> node = space.window().node_multi_index(i);
          if (!space.window().node_in_grid(node)) continue;
          double value[2], derivative[2];
          for (int d = 0; d < 2; ++d) {
            const double a = x[d] - l[d], b = x[d] + l[d];
            value[d] = static_cast<double>(antiderivative(grid, d, node[d], b) -
                                           antiderivative(grid, d, node[d], a)) /
                       (2 * l[d]);
            derivative[d] = (hat(grid, d, node[d], b) - hat(grid, d, node[d], a)) / (2 * l[d]);
          }
          const auto k = static_cast<std::size_t>(i);
          ASSERT_NEAR(e.phi[k], value[0] * value[1], 1e-12) << x.transpose() << " l " << l.transpose();
          const double h = grid.shortest_side();
          ASSERT_NEAR(e.dphi[k][0] * h, derivative[0] * value[1] * h, 1e-11);
          ASSERT_NEAR(e.dphi[k][1] * h, value[0] * derivative[1] * h, 1e-11);
        }
      }
  }
}

TYPED_TEST(GimpForm, IsTheAverageOfTheHatsOverTheDomain) {
  const auto grid = unequal_grid<2>();
  const Space<2> space(grid, BoxPartition<2>(grid.cells()), true);
  const TypeParam basis(space.grid(), NodeNumbering<2>(space.window()));
  const Linear<2> linear(space.grid(), NodeNumbering<2>(space.window()));
  const double l = (TypeParam::width == 3 ? 0.5 : 1.5) * grid.shortest_side();
  constexpr int n = 400;
  for (const Vec<2>& x : {Vec<2>(0.71, 0.93), Vec<2>(1.35, 1.2), Vec<2>(0.8, 1.6)}) {
    const auto e = evaluate<2>(space, basis, x, Vec<2>(l, l));
    std::vector<double> mean(e.phi.size(), 0.0);
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        linear.tabulate(x + l * Vec<2>((2.0 * a + 1) / n - 1, (2.0 * b + 1) / n - 1), Vec<2>::Zero())
            .for_each([&](int, int i, double phi, const Vec<2>&) {
              mean[static_cast<std::size_t>(i)] += phi / (static_cast<double>(n) * n);
            });
    for (std::size_t i = 0; i < mean.size(); ++i) EXPECT_NEAR(e.phi[i], mean[i], 1e-5);
  }
}

TYPED_TEST(GimpForm, SmallDomainsAreLinearFunctions) {
  const auto grid = unequal_grid<2>();
  const Space<2> space(grid, BoxPartition<2>(grid.cells()), true);
  const TypeParam basis(space.grid(), NodeNumbering<2>(space.window()));
  const Linear<2> linear(space.grid(), NodeNumbering<2>(space.window()));
  std::vector<Vec<2>> points = positions(grid, 200);
  points.resize(200);  // the random ones: not on a grid line
  for (const auto& x : points)
    for (const double l : {0.0, 1e-300, 1e-14, 1e-10, 1e-6}) {
      const auto small = evaluate<2>(space, basis, x, Vec<2>(l, l)),
                 none = evaluate<2>(space, linear, x, Vec<2>(l, l));
      for (std::size_t i = 0; i < small.phi.size(); ++i) {
        ASSERT_NEAR(small.phi[i], none.phi[i], 1e-14) << "l " << l;
        ASSERT_LT((small.dphi[i] - none.dphi[i]).norm(), 1e-13) << "l " << l;
      }
    }
}

TYPED_TEST(GimpForm, DomainsThatTouchACellByRoundingDoNotReachIt) {
  const auto grid = equal_grid<2>();
  const Space<2> space(grid, BoxPartition<2>(grid.cells()), true);
  const TypeParam basis(space.grid(), NodeNumbering<2>(space.window()));
  const double h = grid.spacing(0, 3), tiny = 4e-16;
  const Vec<2> middle(0.5 * (grid.line(0, 3) + grid.line(0, 4)), 0.5 * (grid.line(1, 3) + grid.line(1, 4)));
  for (const double shift : {-tiny, 0.0, tiny}) {
    const auto e = evaluate<2>(space, basis, middle + Vec<2>(shift, -shift), Vec<2>::Constant(0.5 * h));
    for (int i = 0; i < space.n_functions(); ++i) {
      const MultiIndex<2> node = space.window().node_multi_index(i);
      const bool of_cell = (node.array() >= 3).all() && (node.array() <= 4).all();
      EXPECT_NEAR(e.phi[static_cast<std::size_t>(i)], of_cell ? 0.25 : 0.0, of_cell ? 1e-14 : 0.0);
    }
  }
}

}  // namespace
}  // namespace wisp
