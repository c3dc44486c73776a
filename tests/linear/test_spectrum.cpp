#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "linear/spectrum.h"

namespace wisp {
namespace {

/// A chain of n springs of stiffness 1 fixed at its left end, and its masses.
struct Chain {
  SystemMatrix stiffness, mass;
  std::vector<double> lumped;

  explicit Chain(int n, bool consistent = false) : lumped(static_cast<std::size_t>(n), 1.0) {
    BlockMatrix k(1), m(1);
    k.begin_pattern(n + 1);
    for (int e = 0; e < n; ++e) k.add_element(std::vector<int>{e, e + 1});
    k.end_pattern();
    m.share_pattern(k);
    const double spring[4] = {1, -1, -1, 1}, full[4] = {1.0 / 3, 1.0 / 6, 1.0 / 6, 1.0 / 3},
                 half[4] = {0.5, 0, 0, 0.5};
    for (int e = 0; e < n; ++e) {
      k.add(std::vector<int>{e, e + 1}, spring);
      m.add(std::vector<int>{e, e + 1}, consistent ? full : half);
    }
    lumped.back() = 0.5;
    std::vector<char> active(static_cast<std::size_t>(n + 1), 1);
    active[0] = 0;
    const DofMap dofs(Halo(n + 1), 1, active);
    stiffness.assign(k, dofs);
    mass.assign(m, dofs);
  }
};

/// Eigenvalues of the chain's stiffness: 2 - 2 cos((2 j - 1) pi / (2 n + 1)), j = 1..n.
double chain_eigenvalue(int n, int j) {
  return 2.0 - 2.0 * std::cos((2 * j - 1) * std::numbers::pi / (2 * n + 1));
}

TEST(Spectrum, extremes_of_a_chain_dense_and_iterated) {
  const int n = 60;
  const Chain chain(n);
  for (const int largest_dense : {1000, 0}) {
    const Extremes e = eigenvalue_extremes(chain.stiffness, largest_dense);
    EXPECT_NEAR(e.least, chain_eigenvalue(n, 1), 1e-8 * chain_eigenvalue(n, 1));
    EXPECT_NEAR(e.greatest, chain_eigenvalue(n, n), 1e-8);
    EXPECT_NEAR(e.condition() / (chain_eigenvalue(n, n) / chain_eigenvalue(n, 1)), 1.0, 1e-7);
  }
}

TEST(Spectrum, a_singular_matrix_has_no_least_eigenvalue) {
  BlockMatrix k(1);
  const int n = 30;
  k.begin_pattern(n);
  for (int e = 0; e + 1 < n; ++e) k.add_element(std::vector<int>{e, e + 1});
  k.end_pattern();
  const double spring[4] = {1, -1, -1, 1};
  for (int e = 0; e + 1 < n; ++e) k.add(std::vector<int>{e, e + 1}, spring);
  SystemMatrix a;
  a.assign(k, DofMap(Halo(n), 1, std::vector<char>(n, 1)));
  for (const int largest_dense : {1000, 0}) {
    const Extremes e = eigenvalue_extremes(a, largest_dense);
    EXPECT_LT(e.least, 1e-13);
    EXPECT_NEAR(e.greatest, 2.0 + 2.0 * std::cos(std::numbers::pi / n), 1e-8);
  }
  EXPECT_TRUE(
      std::isinf(eigenvalue_extremes(Eigen::MatrixXd(Eigen::Vector2d(0.0, 3.0).asDiagonal())).condition()));
}

TEST(Spectrum, greatest_frequency_of_a_chain) {
  // Free end with half a mass: the eigenvalues 2 - 2 cos(theta), theta = (2 j - 1) pi / (2 n) of the
  // fixed-free bar, and for the consistent mass 6 (1 - cos theta) / (2 + cos theta).
  const int n = 40;
  const double theta = (2 * n - 1) * std::numbers::pi / (2 * n);
  const double lumped = 2.0 - 2.0 * std::cos(theta);
  const double consistent = 6.0 * (1.0 - std::cos(theta)) / (2.0 + std::cos(theta));
  const Chain with_lumped(n), with_consistent(n, true);
  for (const int largest_dense : {1000, 0}) {
    EXPECT_NEAR(greatest_pencil_eigenvalue(with_lumped.stiffness, with_lumped.mass, largest_dense), lumped,
                1e-8);
    EXPECT_NEAR(greatest_pencil_eigenvalue(with_lumped.stiffness, with_lumped.lumped, largest_dense), lumped,
                1e-8);
    EXPECT_NEAR(greatest_pencil_eigenvalue(with_consistent.stiffness, with_consistent.mass, largest_dense),
                consistent, 1e-7);
  }
}

TEST(Spectrum, of_products_known_by_their_action) {
  // K B with K a chain's stiffness and B diagonal has the eigenvalues of B^1/2 K B^1/2; and a rotation by 90
  // degrees, doubled, has +-2i.
  const int n = 50;
  Eigen::MatrixXd k = 2.0 * Eigen::MatrixXd::Identity(n, n);
  for (int i = 0; i + 1 < n; ++i) k(i, i + 1) = k(i + 1, i) = -1.0;
  Eigen::VectorXd b(n);
  for (int i = 0; i < n; ++i) b[i] = i % 7 == 3 ? 0.0 : 1.0 + i;
  const auto dot = [](const std::vector<double>& x, const std::vector<double>& y) {
    double sum = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
    return sum;
  };
  const auto times = [](const Eigen::MatrixXd& a) {
    return [a](const std::vector<double>& x, std::vector<double>& y) {
      y.resize(x.size());
      Eigen::Map<Eigen::VectorXd>(y.data(), a.rows()) =
          a * Eigen::Map<const Eigen::VectorXd>(x.data(), a.rows());
    };
  };
  const Eigen::MatrixXd root = b.cwiseSqrt().asDiagonal(), diagonal = b.asDiagonal();
  const double exact = eigenvalue_extremes(Eigen::MatrixXd(root * k * root)).greatest;
  const std::vector<double> start(n, 1.0);
  EXPECT_NEAR(greatest_product_eigenvalue(times(k), times(diagonal), dot, start), exact, 1e-8 * exact);
  EXPECT_NEAR(greatest_magnitude(times(k * diagonal), dot, start), exact, 1e-7 * exact);
  Eigen::MatrixXd turn(2, 2);
  turn << 0.0, -2.0, 2.0, 0.0;
  EXPECT_NEAR(greatest_magnitude(times(turn), dot, {1.0, 0.3}), 2.0, 1e-12);
  EXPECT_EQ(greatest_product_eigenvalue(times(0.0 * k), times(diagonal), dot, start), 0.0);
}

TEST(Spectrum, a_mass_that_is_not_positive_is_an_error) {
  const Chain chain(10);
  std::vector<double> lumped = chain.lumped;
  lumped[3] = 0.0;
  EXPECT_THROW(greatest_pencil_eigenvalue(chain.stiffness, lumped), RunError);
  BlockMatrix nothing(1);
  nothing.begin_pattern(10);
  nothing.add_element(std::vector<int>{0, 1});
  nothing.end_pattern();
  SystemMatrix zero;
  zero.assign(nothing, DofMap(Halo(10), 1, std::vector<char>(10, 1)));
  EXPECT_THROW(greatest_pencil_eigenvalue(chain.stiffness, zero), RunError);
}

TEST(GradedSingularValues, two_columns_thirty_decades_apart) {
  // AᵀA = [3, 6 d; 6 d, 14 d²]: the values are sqrt(3) and sqrt(2) d up to a relative d².
  const double d = 1e-30;
  Eigen::MatrixXd a(3, 2);
  a << 1, d, 1, 2 * d, 1, 3 * d;
  const Eigen::VectorXd s = graded_singular_values(a);
  EXPECT_NEAR(s[0] / std::sqrt(3.0), 1.0, 1e-14);
  EXPECT_NEAR(s[1] / (std::sqrt(2.0) * d), 1.0, 1e-14);
  EXPECT_NEAR(factor_extremes(a).condition() * (2.0 / 3.0) * d * d, 1.0, 1e-13);
}

TEST(GradedSingularValues, rows_and_columns_graded_at_once) {
  // |det| of D1 B D2 is known to full relative accuracy; the product of the singular values must match it,
  // which a method of absolute accuracy misses by many decades.
  std::srand(5);
  const int n = 9;
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(n, n);
  Eigen::VectorXd rows(n), columns(n);
  for (int i = 0; i < n; ++i) {
    rows[i] = std::pow(10.0, -((i * 4) % n));
    columns[i] = std::pow(10.0, -3 * ((i * 5) % n));
  }
  const double expected =
      std::log(std::abs(b.determinant())) + rows.array().log().sum() + columns.array().log().sum();
  const Eigen::VectorXd s = graded_singular_values(rows.asDiagonal() * b * columns.asDiagonal());
  EXPECT_LT(s[n - 1], 1e-20 * s[0]);
  EXPECT_NEAR(s.array().log().sum(), expected, 1e-11);
}

TEST(GradedSingularValues, agree_with_the_plain_ones_where_nothing_is_graded) {
  std::srand(6);
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(50, 20);
  const Eigen::VectorXd s = graded_singular_values(a);
  const Eigen::VectorXd reference = a.jacobiSvd().singularValues();
  EXPECT_LT((s - reference).cwiseAbs().maxCoeff(), 1e-13 * reference[0]);
  EXPECT_NEAR(factor_extremes(a).condition(),
              eigenvalue_extremes(Eigen::MatrixXd(a.transpose() * a)).condition(),
              1e-9 * factor_extremes(a).condition());
}

TEST(GradedSingularValues, fewer_rows_than_columns_or_an_empty_column_give_zeros) {
  const Eigen::VectorXd wide = graded_singular_values(Eigen::MatrixXd::Random(3, 5));
  EXPECT_GT(wide[2], 1e-3);
  EXPECT_LT(wide[3], 1e-15);
  Eigen::MatrixXd a = Eigen::MatrixXd::Random(6, 3);
  a.col(1).setZero();
  EXPECT_EQ(graded_singular_values(a)[2], 0.0);
  EXPECT_TRUE(std::isinf(factor_extremes(a).condition()));
}

}  // namespace
}  // namespace wisp
