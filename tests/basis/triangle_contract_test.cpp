// What every basis on triangles promises: sums, signs, smoothness, polynomials, derivatives.
#include <gtest/gtest.h>

#include <map>

#include "basis/polynomials.h"
#include "grid/triangulations.h"

namespace wisp {
namespace {

using basis_test::coefficient;
using basis_test::Monomial;
using grid_test::meshes;

struct Evaluation {
  double value = 0.0;
  Vec<2> gradient = Vec<2>::Zero();
};

template <class Stencil>
std::map<int, Evaluation> by_function(const Stencil& stencil) {
  std::map<int, Evaluation> all;
  stencil.for_each([&](int, int i, double phi, const Vec<2>& dphi) { all[i] = {phi, dphi}; });
  return all;
}

/// Largest differences of values and gradients (times the size of a triangle).
std::pair<double, double> difference(const std::map<int, Evaluation>& a, const std::map<int, Evaluation>& b,
                                     double size) {
  double value = 0.0, gradient = 0.0;
  const auto compare = [&](const auto& one, const auto& other) {
    for (const auto& [i, e] : one) {
      const auto found = other.find(i);
      const Evaluation f = found == other.end() ? Evaluation{} : found->second;
      value = std::max(value, std::abs(e.value - f.value));
      gradient = std::max(gradient, size * (e.gradient - f.gradient).norm());
    }
  };
  compare(a, b), compare(b, a);
  return {value, gradient};
}

/// Points of triangle t: its corners, on its edges and split lines, inside.
std::vector<Vec<2>> points_in(const Triangulation& mesh, const PowellSabinSplit& split, int t,
                              std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Vec<2>> points{split.centre(t)};
  for (int k = 0; k < 3; ++k) {
    const Vec<2>&v = mesh.corner(t, k), &w = mesh.corner(t, (k + 1) % 3);
    const Vec<2> r = split.edge_point(mesh.edge(t, k));
    const double s = unit(random);
    points.insert(points.end(), {v, r, s * v + (1.0 - s) * w, s * v + (1.0 - s) * split.centre(t),
                                 s * r + (1.0 - s) * split.centre(t)});
  }
  for (int n = 0; n < 20; ++n) {
    double a = unit(random), b = unit(random);
    if (a + b > 1.0) a = 1.0 - a, b = 1.0 - b;
    points.push_back(mesh.point(t, {a, b, 1.0 - a - b}));
  }
  return points;
}

template <class Basis>
struct TriangleContract : testing::Test {
  /// Calls f(basis, t, x, size of the triangle).
  template <class F>
  void for_each_sample(F&& f) {
    std::mt19937 random(17);
    for (const auto& mesh : meshes()) {
      const Basis basis(mesh);
      const PowellSabinSplit split(mesh);
      for (int t = 0; t < mesh.n_triangles(); ++t)
        for (const auto& x : points_in(mesh, split, t, random)) {
          f(basis, t, x, std::sqrt(mesh.area(t)));
          if (testing::Test::HasFailure()) return;
        }
    }
  }
};

using Bases = testing::Types<LinearTriangle, LagrangeQuadratic, PowellSabinQuadratic, PowellSabinCubic>;
TYPED_TEST_SUITE(TriangleContract, Bases);

TYPED_TEST(TriangleContract, SumsToOneWithoutNegativeParts) {
  double least = 0.0;
  this->for_each_sample([&](const auto& basis, int t, const Vec<2>& x, double size) {
    double sum = 0.0;
    Vec<2> gradient = Vec<2>::Zero();
    basis.tabulate_in(t, x).for_each([&](int, int i, double phi, const Vec<2>& dphi) {
      ASSERT_GE(i, 0);
      ASSERT_LT(i, basis.n_functions());
      sum += phi, gradient += dphi, least = std::min(least, phi);
    });
    ASSERT_NEAR(sum, 1.0, 2e-12);
    ASSERT_LT(gradient.norm() * size, 1e-11);
  });
  if (TypeParam::non_negative) {
    EXPECT_EQ(least, 0.0);  // not even by rounding: lumped masses stay positive
  } else {
    EXPECT_LT(least, -0.1);
  }
}

TYPED_TEST(TriangleContract, ReproducesLinearFieldsWithItsControlPoints) {
  this->for_each_sample([](const auto& basis, int t, const Vec<2>& x, double size) {
    Vec<2> position = Vec<2>::Zero();
    Mat<2> gradient = Mat<2>::Zero();
    basis.tabulate_in(t, x).for_each([&](int, int i, double phi, const Vec<2>& dphi) {
      position += phi * basis.control_point(i);
      gradient += basis.control_point(i) * dphi.transpose();
    });
    ASSERT_LT((position - x).norm(), 1e-12 * std::max(1.0, size));
    ASSERT_LT((gradient - Mat<2>::Identity()).norm(), 1e-11);
  });
}

TYPED_TEST(TriangleContract, IsAsSmoothAcrossEdgesAsItSays) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double kink = 0.0;
  for (const auto& mesh : meshes()) {
    const TypeParam basis(mesh);
    for (int e = 0; e < mesh.n_edges(); ++e) {
      const auto& edge = mesh.edge(e);
      if (edge.boundary()) continue;
      for (const double s : {0.0, 1.0, unit(random), unit(random), unit(random)}) {
        const Vec<2> x = s * mesh.vertex(edge.vertex[0]) + (1.0 - s) * mesh.vertex(edge.vertex[1]);
        const auto [value, gradient] =
            difference(by_function(basis.tabulate_in(edge.triangle[0], x)),
                       by_function(basis.tabulate_in(edge.triangle[1], x)), mesh.edge_length(e));
        ASSERT_LT(value, 2e-12);
        if (TypeParam::continuity > 0) {
          ASSERT_LT(gradient, 2e-11);
        }
        kink = std::max(kink, gradient);
      }
    }
  }
  if (TypeParam::continuity == 0) {
    EXPECT_GT(kink, 0.1);
  }
}

TYPED_TEST(TriangleContract, GradientsAreTheDerivativesOfTheValues) {
  this->for_each_sample([](const auto& basis, int t, const Vec<2>& x, double size) {
    const auto& mesh = basis.triangulation();
    const double step = 1e-6 * size;
    const auto here = by_function(basis.tabulate_in(t, x));
    for (int d = 0; d < 2; ++d) {
      Vec<2> up = x, down = x;
      up[d] += step, down[d] -= step;
      for (const auto& y : {up, down})
        for (const double b : mesh.barycentric(t, y))
          if (b < 0.0) return;  // the step leaves the triangle
      const auto above = by_function(basis.tabulate_in(t, up)),
                 below = by_function(basis.tabulate_in(t, down));
      // Across a split line a function's second derivative jumps: first order there, second elsewhere.
      for (const auto& [i, e] : here)
        ASSERT_NEAR(size * (above.at(i).value - below.at(i).value) / (up[d] - down[d]), size * e.gradient[d],
                    2e-4);
    }
  });
}

TYPED_TEST(TriangleContract, FindsTheTriangleByItself) {
  this->for_each_sample([](const auto& basis, int t, const Vec<2>& x, double) {
    const int holder = basis.triangulation().locate(x, t);
    for (const int hint : {-1, 0, t}) {
      const auto stencil = basis.tabulate(x, hint);
      ASSERT_EQ(stencil.key(), holder);
      const auto [value, gradient] =
          difference(by_function(stencil), by_function(basis.tabulate_in(t, x)), 1.0);
      ASSERT_LT(value, 1e-10);
    }
  });
}

TYPED_TEST(TriangleContract, ReproducesPolynomialsToItsDegree) {
  std::mt19937 random(29);
  for (const auto& mesh : meshes()) {
    const TypeParam basis(mesh);
    const PowellSabinSplit split(mesh);
    for (int a = 0; a <= TypeParam::degree; ++a)
      for (int b = 0; a + b <= TypeParam::degree; ++b) {
        const Monomial f{a, b};
        std::vector<double> c(static_cast<std::size_t>(basis.n_functions()));
        for (int i = 0; i < basis.n_functions(); ++i)
          c[static_cast<std::size_t>(i)] = coefficient(basis, f, i);
        for (int t = 0; t < mesh.n_triangles(); ++t)
          for (const auto& x : points_in(mesh, split, t, random)) {
            double value = 0.0;
            Vec<2> gradient = Vec<2>::Zero();
            basis.tabulate_in(t, x).for_each([&](int, int i, double phi, const Vec<2>& dphi) {
              value += phi * c[static_cast<std::size_t>(i)],
                  gradient += dphi * c[static_cast<std::size_t>(i)];
            });
            const double scale = std::max(1.0, std::pow(x.norm(), a + b));
            ASSERT_NEAR(value, f(x), 2e-12 * scale);
            ASSERT_LT((gradient - f.gradient(x)).norm(), 2e-10 * scale);
          }
      }
  }
}

template <class Basis>
struct PowellSabinContract : TriangleContract<Basis> {};
using Splines = testing::Types<PowellSabinQuadratic, PowellSabinCubic>;
TYPED_TEST_SUITE(PowellSabinContract, Splines);

TYPED_TEST(PowellSabinContract, IsSmoothAcrossSplitEdges) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const auto& mesh : meshes()) {
    const TypeParam basis(mesh);
    for (int t = 0; t < mesh.n_triangles(); ++t)
      for (int k = 0; k < 3; ++k)
        for (const double s : {0.0, 1.0, unit(random)}) {
          // Edge R_k Z from both its sides, edge V_k Z from the third of edge k and that of the edge before.
          const std::array<double, 3> on_r{0.0, s, 1.0 - s}, on_v{s, 0.0, 1.0 - s};
          for (const auto& [p, q] : {std::pair{SplitPoint{k, 0, on_r}, SplitPoint{k, 1, on_r}},
                                     std::pair{SplitPoint{k, 0, on_v}, SplitPoint{(k + 2) % 3, 1, on_v}}}) {
            const auto [value, gradient] =
                difference(by_function(basis.tabulate_at(t, p)), by_function(basis.tabulate_at(t, q)),
                           std::sqrt(mesh.area(t)));
            ASSERT_LT(value, 2e-12);
            ASSERT_LT(gradient, 2e-11);
          }
        }
  }
}

TYPED_TEST(PowellSabinContract, OnlyItsOwnThreeFunctionsLiveAtAVertex) {
  for (const auto& mesh : meshes()) {
    const TypeParam basis(mesh);
    for (int v = 0; v < mesh.n_vertices(); ++v)
      for (const int t : mesh.triangles_of_vertex(v))
        basis.tabulate_in(t, mesh.vertex(v)).for_each([&](int, int i, double phi, const Vec<2>& dphi) {
          const double size = std::sqrt(mesh.area(t));
          if (i / 3 == v && i < 3 * mesh.n_vertices()) {
            const auto expected = basis.triplet(v, i % 3);
            EXPECT_NEAR(phi, expected.value, 1e-13);
            EXPECT_LT(size * (dphi - Vec<2>(expected.x, expected.y)).norm(), 1e-11);
          } else {
            EXPECT_NEAR(phi, 0.0, 1e-13);
            EXPECT_LT(size * dphi.norm(), 1e-11);
          }
        });
  }
}

TYPED_TEST(PowellSabinContract, HigherDerivativesAreThoseOfTheLower) {
  std::mt19937 random(61);
  std::uniform_real_distribution<double> unit(0.1, 0.3);
  for (const auto& mesh : meshes()) {
    const TypeParam basis(mesh);
    for (int t = 0; t < mesh.n_triangles(); ++t)
      for (int k = 0; k < 3; ++k)
        for (int side = 0; side < 2; ++side) {
          const double a = unit(random), b = unit(random), size = std::sqrt(mesh.area(t)), step = 1e-5 * size;
          const Vec<2> x = a * mesh.corner(t, (k + side) % 3) +
                           b * basis.split().edge_point(mesh.edge(t, k)) +
                           (1.0 - a - b) * basis.split().centre(t);
          const auto at = [&](const Vec<2>& y) { return basis.split().locate(t, mesh.barycentric(t, y)); };
          const auto hessian = basis.hessians(t, at(x));
          for (int d = 0; d < 2; ++d) {
            const Vec<2> along = Vec<2>::Unit(d);
            const Vec<2> up = x + step * along, down = x - step * along;
            const auto high = basis.tabulate_in(t, up), low = basis.tabulate_in(t, down);
            const auto third = basis.template derivatives<3>(t, at(x), along);
            const auto second_up = basis.template derivatives<2>(t, at(up), along);
            const auto second_down = basis.template derivatives<2>(t, at(down), along);
            for (std::size_t i = 0; i < TypeParam::max_functions; ++i) {
              for (std::size_t c = 0; c < 2; ++c)
                ASSERT_NEAR((high.derivative[c][i] - low.derivative[c][i]) / (2.0 * step) * size * size,
                            hessian[i](d, static_cast<int>(c)) * size * size, 1e-6);
              ASSERT_NEAR((second_up[i] - second_down[i]) / (2.0 * step) * size * size * size,
                          third[i] * size * size * size, 1e-4);
            }
          }
        }
  }
}

TEST(PowellSabinQuadratic, HasThreeFunctionsAVertexAndCubicsTheirWholeSpace) {
  for (const auto& mesh : meshes()) {
    int n_boundary = 0;
    for (int e = 0; e < mesh.n_edges(); ++e) n_boundary += mesh.edge(e).boundary();
    EXPECT_EQ(PowellSabinQuadratic(mesh).n_functions(), 3 * mesh.n_vertices());
    EXPECT_EQ(PowellSabinCubic(mesh).n_functions(),
              3 * mesh.n_vertices() + 6 * mesh.n_triangles() + 2 * n_boundary);
  }
}

}  // namespace
}  // namespace wisp
