// Best approximations: exact where the space holds the function, at the right rate elsewhere, with prescribed
// boundaries of every kind.
#include "analysis/projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "basis/bspline.h"
#include "basis/lagrange_quadratic.h"
#include "grid/triangulations.h"

namespace wisp {
namespace {

using grid_test::block;
using grid_test::l_shape;

double cubic(const Vec<2>& x) { return 1.0 + x[0] - 2.0 * x[0] * x[0] * x[1] + 0.7 * std::pow(x[1], 3); }
double quadratic(const Vec<2>& x) { return 0.3 + x[0] - 2.0 * x[0] * x[1] + 0.7 * x[1] * x[1]; }
double wave(const Vec<2>& x) { return std::sin(3.0 * x[0] + 0.4) * std::cos(2.0 * x[1]); }
ValueAndGradient wave_and_gradient(const Vec<2>& x) {
  const double a = 3.0 * x[0] + 0.4, b = 2.0 * x[1];
  return {std::sin(a) * std::cos(b), 3.0 * std::cos(a) * std::cos(b), -2.0 * std::sin(a) * std::sin(b)};
}

TEST(Projection, IsExactOnTheSpaceItself) {
  const auto mesh = block(4, 4, 0.3, 2);
  EXPECT_LT(field_error(LagrangeQuadratic(mesh), solve_field(LagrangeQuadratic(mesh), quadratic), quadratic)
                .largest,
            1e-12);
  const PowellSabinQuadratic two(mesh);
  EXPECT_LT(field_error(two, solve_field(two, quadratic), quadratic).largest, 1e-11);
  EXPECT_GT(field_error(two, solve_field(two, cubic), cubic).largest, 1e-5);
  const PowellSabinCubic three(mesh);
  EXPECT_LT(field_error(three, solve_field(three, cubic), cubic).largest, 1e-11);
  const StructuredGrid<2> grid({-0.2, 0.1}, {0.8, 0.9}, {5, 4});
  const BSpline<2, 3> tensor(grid);
  EXPECT_LT(field_error(tensor, solve_field(tensor, cubic), cubic).largest, 1e-11);
  const StructuredGrid<3> box({0, 0, 0}, {1, 1, 1}, {2, 3, 2});
  const BSpline<3, 2> space(box);
  const auto f = [](const Vec<3>& x) { return x[0] * x[1] * x[2] + x[2] * x[2] - 0.3 * x[0]; };
  EXPECT_LT(field_error(space, solve_field<BSpline<3, 2>>(space, f, {1, 0, 3, {}}), f, 3).largest, 1e-11);
}

/// log2 of the errors' ratio from one mesh to that with half the size.
template <class Make>
double rate(Make&& error_of, int n) {
  return std::log2(error_of(n) / error_of(2 * n));
}

TEST(Projection, ConvergesAtTheRateOfEachBasis) {
  const auto on_mesh = [](auto make) {
    return rate(
        [&](int n) {
          const auto mesh = block(n, n, 0.2, 4);
          const auto basis = make(mesh);
          return field_error(basis, solve_field(basis, wave), wave).l2;
        },
        6);
  };
  EXPECT_NEAR(on_mesh([](const auto& m) { return LagrangeQuadratic(m); }), 3.0, 0.15);
  EXPECT_NEAR(on_mesh([](const auto& m) { return PowellSabinQuadratic(m); }), 3.0, 0.15);
  EXPECT_NEAR(on_mesh([](const auto& m) { return PowellSabinCubic(m); }), 4.0, 0.2);
  const auto on_grid = [](auto degree) {
    return rate(
        [&](int n) {
          const StructuredGrid<2> grid({-0.2, 0.1}, {0.8, 0.9}, {n, n});
          const BSpline<2, decltype(degree)::value> basis(grid);
          return field_error(basis, solve_field(basis, wave), wave).l2;
        },
        8);
  };
  EXPECT_NEAR(on_grid(std::integral_constant<int, 1>()), 2.0, 0.1);
  EXPECT_NEAR(on_grid(std::integral_constant<int, 2>()), 3.0, 0.15);
  EXPECT_NEAR(on_grid(std::integral_constant<int, 3>()), 4.0, 0.25);
  EXPECT_NEAR(on_grid(std::integral_constant<int, 4>()), 5.0, 0.3);
}

std::vector<int> boundary_edges(const Triangulation& mesh, bool all) {
  std::vector<int> edges;
  for (int e = 0; e < mesh.n_edges(); ++e)
    if (mesh.edge(e).boundary()) {
      const Vec<2> middle = 0.5 * (mesh.vertex(mesh.edge(e).vertex[0]) + mesh.vertex(mesh.edge(e).vertex[1]));
      if (all || middle[0] < mesh.lower()[0] + 1e-9 || (middle[0] > -1e-9 && middle[1] > -1e-9))
        edges.push_back(e);
    }
  return edges;
}

/// Largest difference between a field and what was prescribed, over the edges.
template <class Basis>
double largest_on(const Basis& basis, const std::vector<double>& c, const std::vector<int>& edges,
                  const ScalarField<2>& f) {
  const auto& mesh = basis.triangulation();
  double largest = 0.0;
  for (const int e : edges)
    for (int k = 0; k <= 10; ++k) {
      const Vec<2> x = 0.1 * k * mesh.vertex(mesh.edge(e).vertex[0]) +
                       (1.0 - 0.1 * k) * mesh.vertex(mesh.edge(e).vertex[1]);
      double value = -f(x);
      basis.tabulate_in(mesh.edge(e).triangle[0], x).for_each([&](int, int i, double phi, const Vec<2>&) {
        value += phi * c[static_cast<std::size_t>(i)];
      });
      largest = std::max(largest, std::abs(value));
    }
  return largest;
}

template <class Basis>
struct SplineConditionsTest : testing::Test {};
using Splines = testing::Types<PowellSabinQuadratic, PowellSabinCubic>;
TYPED_TEST_SUITE(SplineConditionsTest, Splines);

/// -div grad u = source with u prescribed on all of an L's boundary or on parts of it, the rest natural.
template <class Basis>
double poisson_error(int n, bool everywhere, bool by_control_points, bool aligned) {
  const auto mesh = l_shape(n, 0.2, 9);
  const Basis basis(mesh, {ControlTriangleRule::hull_edges, aligned});
  const auto edges = boundary_edges(mesh, everywhere);
  FieldProblem problem;
  problem.mass = everywhere ? 0.0 : 1.0, problem.stiffness = everywhere ? 1.0 : 0.0;
  problem.conditions = spline_conditions(
      basis, edges, [](int, const Vec<2>& x) { return wave_and_gradient(x); }, by_control_points);
  if (by_control_points && aligned && everywhere) {
    EXPECT_TRUE(problem.conditions.vertices.empty());
  }
  if (!by_control_points) {
    EXPECT_FALSE(problem.conditions.vertices.empty());
  }
  const ScalarField<2> source = [&](const Vec<2>& x) { return (everywhere ? 13.0 : 1.0) * wave(x); };
  return field_error(basis, solve_field(basis, source, problem), wave).l2;
}

TYPED_TEST(SplineConditionsTest, PoissonAndProjectionsWithPrescribedBoundariesConvergeAtTheFullRate) {
  for (const bool everywhere : {true, false})
    for (const bool by_control_points : {true, false}) {
      const double coarse = poisson_error<TypeParam>(3, everywhere, by_control_points, true);
      const double fine = poisson_error<TypeParam>(6, everywhere, by_control_points, true);
      EXPECT_GT(std::log2(coarse / fine), TypeParam::degree + 1 - 0.25) << everywhere << by_control_points;
      EXPECT_LT(fine, TypeParam::degree == 2 ? 2e-3 : 2e-4);
      // The space and the condition do not depend on the control triangles.
      EXPECT_NEAR(poisson_error<TypeParam>(3, everywhere, false, false), coarse, 1e-9 * coarse);
    }
}

TYPED_TEST(SplineConditionsTest, ZeroIsTakenExactlyAndPolynomialsToo) {
  for (const auto& mesh : {l_shape(2, 0.25, 3), grid_test::fan(9, 2), block(3, 3, 0.25, 6)})
    for (const bool by_control_points : {true, false})
      for (const bool all : {true, false}) {
        const TypeParam basis(mesh);
        const auto edges = boundary_edges(mesh, all);
        if (edges.empty()) continue;
        FieldProblem problem;
        problem.conditions = spline_conditions(
            basis, edges, [](int, const Vec<2>&) { return ValueAndGradient{}; }, by_control_points);
        EXPECT_LT(
            largest_on(basis, solve_field(basis, wave, problem), edges, [](const Vec<2>&) { return 0.0; }),
            1e-13);
        problem.conditions = spline_conditions(
            basis, edges,
            [](int, const Vec<2>& x) {
              return ValueAndGradient(quadratic(x), 1.0 - 2.0 * x[1], -2.0 * x[0] + 1.4 * x[1]);
            },
            by_control_points);
        const auto c = solve_field(basis, wave, problem);
        EXPECT_LT(largest_on(basis, c, edges, quadratic), 1e-12);
        // ... and the rest is still free to fit.
        EXPECT_GT(largest_on(basis, c, edges, wave), 0.1);
      }
}

TYPED_TEST(SplineConditionsTest, RefuseEdgesThatAreNotOnTheBoundary) {
  const auto mesh = block(3, 3, 0.25, 6);
  const TypeParam basis(mesh);
  for (int e = 0; e < mesh.n_edges(); ++e)
    if (!mesh.edge(e).boundary()) {
      const int edges[] = {e};
      EXPECT_THROW(spline_conditions(basis, edges, [](int, const Vec<2>&) { return ValueAndGradient{}; }),
                   InputError);
      break;
    }
}

}  // namespace
}  // namespace wisp
