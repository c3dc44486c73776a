#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "linear/system_matrix.h"

namespace wisp {
namespace {

/// Random element matrices over short random lists, and the same sum in a dense matrix.
struct Sample {
  BlockMatrix sparse;
  Eigen::MatrixXd dense;
  std::vector<std::vector<int>> elements;

  Sample(int n, int b, bool scalar) : sparse(b), dense(Eigen::MatrixXd::Zero(n * b, n * b)) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    for (int e = 0; e + 4 < n; ++e) elements.push_back({e + 4, e, e + 2, e + 1});  // unsorted on purpose
    sparse.begin_pattern(n);
    for (const auto& element : elements) sparse.add_element(element);
    sparse.end_pattern();
    for (const auto& element : elements) {
      const int m = 4 * (scalar ? 1 : b);
      const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> a =
          Eigen::MatrixXd::NullaryExpr(m, m, [&]() { return value(random); });
      scalar ? sparse.add_scalar(element, a.data()) : sparse.add(element, a.data());
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
          for (int c = 0; c < b; ++c)
            for (int d = 0; d < b; ++d) {
              const int ii = static_cast<int>(i), jj = static_cast<int>(j);
              const double v = scalar ? (c == d ? a(ii, jj) : 0.0) : a(ii * b + c, jj * b + d);
              dense(element[i] * b + c, element[j] * b + d) += v;
            }
    }
  }
};

Eigen::MatrixXd dense_of(::Mat mat) {
  PetscInt n = 0;
  petsc(MatGetSize(mat, &n, nullptr));
  Eigen::MatrixXd dense(n, n);
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j) petsc(MatGetValue(mat, i, j, &dense(i, j)));
  return dense;
}

class Blocks : public testing::TestWithParam<std::tuple<int, bool>> {};
INSTANTIATE_TEST_SUITE_P(All, Blocks, testing::Combine(testing::Values(1, 2, 3), testing::Bool()));

TEST_P(Blocks, assemble_and_multiply_like_the_dense_matrix) {
  const auto [b, scalar] = GetParam();
  const Sample s(13, b, scalar);
  const auto n = static_cast<Eigen::Index>(13 * b);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n, -1.0, 2.0).array().sin();
  Eigen::VectorXd y(n), sums(n), diagonal(n);
  const auto size = static_cast<std::size_t>(n);
  s.sparse.multiply({x.data(), size}, {y.data(), size});
  EXPECT_LT((y - s.dense * x).norm(), 1e-14 * s.dense.norm());
  s.sparse.row_sums({sums.data(), size});
  EXPECT_LT((sums - s.dense.rowwise().sum()).norm(), 1e-14 * s.dense.norm());
  s.sparse.diagonal({diagonal.data(), size});
  EXPECT_EQ(diagonal, s.dense.diagonal());
}

TEST_P(Blocks, become_a_petsc_matrix_without_the_inactive_and_fixed_unknowns) {
  const auto [b, scalar] = GetParam();
  const Sample s(13, b, scalar);
  std::vector<char> active(13, 1), fixed(static_cast<std::size_t>(13 * b), 0);
  active[3] = active[12] = 0;
  fixed[0] = fixed[static_cast<std::size_t>(5 * b + b - 1)] = 1;
  const Halo halo(13);
  for (const auto mode : {FixedUnknowns::removed, FixedUnknowns::unit_rows}) {
    const DofMap dofs(halo, b, active, fixed, mode);
    EXPECT_EQ(dofs.n_global(), 11 * b - (mode == FixedUnknowns::removed ? 2 : 0));
    SystemMatrix system;
    system.assign(s.sparse, dofs);
    const Eigen::MatrixXd a = dense_of(system.mat());
    ASSERT_EQ(a.rows(), dofs.n_global());
    for (int i = 0; i < a.rows(); ++i)
      for (int j = 0; j < a.cols(); ++j) {
        const int p = dofs.owned()[static_cast<std::size_t>(i)],
                  q = dofs.owned()[static_cast<std::size_t>(j)];
        const bool both_free = dofs.is_free(p / b, p % b) && dofs.is_free(q / b, q % b);
        if (both_free) {
          EXPECT_EQ(a(i, j), s.dense(p, q));
        } else {
          EXPECT_EQ(a(i, j) != 0.0, i == j);
        }
      }
  }
}

TEST(BlockMatrix, scalar_matrix_serves_several_columns) {
  const Sample s(20, 1, false);
  for (int m = 1; m <= 4; ++m) {
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> x =
        Eigen::MatrixXd::Random(20, m);
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> y(20, m);
    const auto size = static_cast<std::size_t>(20 * m);
    s.sparse.multiply_columns({x.data(), size}, {y.data(), size}, m);
    EXPECT_LT((y - s.dense * x).norm(), 1e-14 * s.dense.norm());
  }
}

TEST(BlockMatrix, adds_a_scalar_matrix_of_the_same_pattern) {
  Sample a(9, 2, false);
  BlockMatrix g(1);
  g.share_pattern(a.sparse);
  const double element[16] = {2, -1, 0, -1, -1, 2, -1, 0, 0, -1, 2, -1, -1, 0, -1, 2};
  for (const auto& e : a.elements) g.add(e, element);
  const double before = a.sparse.entry(4, 1, 4, 1), off = a.sparse.entry(4, 0, 4, 1);
  a.sparse.add_matrix(0.5, g);
  EXPECT_DOUBLE_EQ(a.sparse.entry(4, 1, 4, 1), before + 0.5 * g.entry(4, 0, 4, 0));
  EXPECT_EQ(a.sparse.entry(4, 0, 4, 1), off);
}

TEST(BlockMatrix, keeps_an_unchanged_pattern_and_the_petsc_matrix_over_it) {
  Sample s(9, 2, false);
  const auto id = s.sparse.pattern_id();
  const DofMap dofs(Halo(9), 2, std::vector<char>(9, 1));
  SystemMatrix system;
  system.assign(s.sparse, dofs);
  const auto structure = system.structure();
  s.sparse.begin_pattern(9);
  for (const auto& e : s.elements) s.sparse.add_element(e);
  s.sparse.end_pattern();
  EXPECT_EQ(s.sparse.pattern_id(), id);
  EXPECT_EQ(s.sparse.entry(4, 1, 4, 1), 0.0);
  std::vector<double> element(64, 0.25);
  s.sparse.add(s.elements[0], element.data());
  system.assign(s.sparse, dofs);
  EXPECT_EQ(system.structure(), structure);
  double value = 0.0;
  petsc(MatGetValue(system.mat(), 0, 3, &value));
  EXPECT_EQ(value, 0.25);
  s.sparse.begin_pattern(9);
  s.sparse.add_element(s.elements[0]);
  s.sparse.end_pattern();
  EXPECT_NE(s.sparse.pattern_id(), id);
}

TEST(BlockMatrix, tells_symmetry_from_a_rounding_error) {
  Sample s(12, 2, false);
  EXPECT_FALSE(s.sparse.symmetric());
  BlockMatrix a(2);
  a.share_pattern(s.sparse);
  std::vector<double> element(64);
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = 0; j < 8; ++j)
      element[i * 8 + j] = i == j ? 20.0 : 1.0 / static_cast<double>(i + j + 1);
  for (const auto& e : s.elements) a.add(e, element.data());
  EXPECT_TRUE(a.symmetric());
  const auto entry = static_cast<std::size_t>(a.pattern().find(4, 5)) * 4 + 1;
  const double value = a.values()[entry];
  a.values()[entry] = value + 1e-15;
  EXPECT_TRUE(a.symmetric());
  a.values()[entry] = value + 1e-9;
  EXPECT_FALSE(a.symmetric());
}

TEST(BlockMatrix, says_which_entry_a_pattern_lacks) {
  Sample s(9, 1, false);
  const double element[4] = {1, 2, 3, 4};
  const std::vector<int> strangers{0, 8};
  EXPECT_THROW(s.sparse.add(strangers, element), RunError);
}

TEST(DofMap, gathers_and_scatters_free_unknowns_only) {
  const Halo halo(4);
  const std::vector<char> active{1, 0, 1, 1}, fixed{0, 1, 0, 0, 0, 0, 1, 0};
  const DofMap dofs(halo, 2, active, fixed);
  ASSERT_EQ(dofs.n_owned(), 4);
  EXPECT_EQ(dofs.number(0, 0), 0);
  EXPECT_EQ(dofs.number(0, 1), -1);
  EXPECT_EQ(dofs.number(1, 0), -1);
  EXPECT_EQ(dofs.number(2, 1), 2);
  EXPECT_EQ(dofs.number(3, 1), 3);
  std::vector<double> local{1, 2, 3, 4, 5, 6, 7, 8}, owned(4);
  dofs.gather(local, owned);
  EXPECT_EQ(owned, (std::vector<double>{1, 5, 6, 8}));
  dofs.scatter(owned, local, halo);
  EXPECT_EQ(local, (std::vector<double>{1, 0, 0, 0, 5, 6, 0, 8}));
}

}  // namespace
}  // namespace wisp
