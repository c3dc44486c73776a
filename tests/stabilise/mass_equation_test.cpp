// The ways to solve M x = b against dense algebra, for a body whose edge cells hold next to no mass.
#include "stabilise/mass_equation.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <memory>
#include <random>

#include "transfer/mass.h"

namespace wisp {
namespace {

using Matrix = Eigen::MatrixXd;

/// A body over 3 x 3 of 5 x 5 cells whose points fill the last column of cells by a small share.
struct Fixture {
  std::unique_ptr<Space<2>> space;
  std::vector<Body<2>> bodies;
  BlockMatrix mass{1};
  ActiveCells cells;
  std::vector<char> active;
  std::vector<double> lumped;
  Matrix dense;
  std::vector<double> b;

  Fixture() {
    std::array<std::vector<double>, 2> lines;
    for (int i = 0; i <= 5; ++i) lines[0].push_back(0.5 * i), lines[1].push_back(0.4 * i);
    const StructuredGrid<2> grid(lines);
    space = std::make_unique<Space<2>>(grid, BoxPartition<2>(grid.cells()), false);
    Body<2> body{"body", {}, make_material<2>(AnyLaw(Hencky{}))};
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int k = 0; k < 200; ++k) {
      body.points.position.push_back({0.5 + 1.1 * share(random), 0.4 + 1.2 * share(random)});
      body.points.mass.push_back(1.0 + share(random));
    }
    bodies.push_back(body);
    cells = active_cells(*space, bodies);
    active = active_functions(*space, cells);
    mass.begin_pattern(space->n_functions());
    add_point_pattern(*space, bodies, mass);
    mass.end_pattern();
    add_consistent_mass(*space, bodies, mass);
    const auto n = static_cast<std::size_t>(space->n_functions());
    lumped.resize(n);
    mass.row_sums(lumped);
    dense = Matrix::Zero(space->n_functions(), space->n_functions());
    for (int i = 0; i < dense.rows(); ++i)
      for (int j = 0; j < dense.rows(); ++j) dense(i, j) = mass.entry(i, 0, j, 0);
    b.resize(2 * n);
    for (std::size_t k = 0; k < b.size(); ++k) b[k] = active[k / 2] ? share(random) * lumped[k / 2] : 0.0;
  }

  std::vector<int> active_list() const {
    std::vector<int> list;
    for (std::size_t i = 0; i < active.size(); ++i)
      if (active[i]) list.push_back(static_cast<int>(i));
    return list;
  }
  /// Dense matrix and right-hand side of some functions.
  Matrix block(const std::vector<int>& rows, const std::vector<int>& columns) const {
    return dense(rows, columns);
  }
  Matrix load(const std::vector<int>& rows) const {
    Matrix m(static_cast<Eigen::Index>(rows.size()), 2);
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (int c = 0; c < 2; ++c)
        m(static_cast<Eigen::Index>(r), c) = b[static_cast<std::size_t>(2 * rows[r] + c)];
    return m;
  }
  std::vector<double> solve(const MassTreatment& treatment, std::span<const char> fixed = {},
                            std::vector<double> start = {}) {
    MassEquation equation(treatment);
    std::vector<char> boundary;
    if (treatment.mass == Mass::partial) boundary = boundary_functions(*space, cells);
    equation.set_matrix(mass, space->nodes(), 2, active, fixed, lumped, boundary);
    if (start.empty()) start.assign(b.size(), 0.0);
    EXPECT_TRUE(equation.solve(b, start).solved);
    return start;
  }
};

double difference(const std::vector<double>& x, const std::vector<int>& rows, const Matrix& expected) {
  double worst = 0.0;
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (int c = 0; c < 2; ++c)
      worst = std::max(worst, std::abs(x[static_cast<std::size_t>(2 * rows[r] + c)] -
                                       expected(static_cast<Eigen::Index>(r), c)));
  return worst;
}

TEST(Fmpm, OfOrderOneIsLumpingAndOfHighOrderTheConsistentMass) {
  Fixture f;
  const auto one = f.solve({Mass::fmpm, 1});
  for (std::size_t k = 0; k < one.size(); ++k)
    EXPECT_NEAR(one[k], f.active[k / 2] ? f.b[k] / f.lumped[k / 2] : 0.0, 1e-14);
  const auto rows = f.active_list();
  const Matrix exact = f.block(rows, rows).ldlt().solve(f.load(rows));
  double before = 1e300;
  for (const int k : {4, 64, 1024, 32768}) {
    // In the norm of M the error of the series falls with every term.
    const auto x = f.solve({Mass::fmpm, k});
    Matrix e = exact;
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (int c = 0; c < 2; ++c)
        e(static_cast<Eigen::Index>(r), c) -= x[static_cast<std::size_t>(2 * rows[r] + c)];
    const double error = (e.transpose() * f.block(rows, rows) * e).trace();
    EXPECT_LT(error, 0.5 * before) << k;
    before = error;
  }
  EXPECT_LT(before, 1e-6 * (exact.transpose() * f.block(rows, rows) * exact).trace());
}

TEST(Fmpm, KeepsTheMomentumAtEveryOrder) {
  Fixture f;
  double sum[2] = {};
  for (std::size_t k = 0; k < f.b.size(); ++k) sum[k % 2] += f.b[k];
  for (const int k : {1, 2, 3, 8}) {
    const auto x = f.solve({Mass::fmpm, k});
    double momentum[2] = {};
    for (std::size_t i = 0; i < x.size(); ++i) momentum[i % 2] += f.lumped[i / 2] * x[i];
    EXPECT_NEAR(momentum[0], sum[0], 1e-12 * sum[0]) << k;
    EXPECT_NEAR(momentum[1], sum[1], 1e-12 * sum[1]) << k;
  }
}

TEST(Fmpm, SolvesForTheRestWhereValuesAreGiven) {
  Fixture f;
  const auto rows = f.active_list();
  std::vector<char> fixed(f.b.size(), 0);
  std::vector<double> x(f.b.size(), 0.0);
  std::vector<int> free(rows.begin() + 3, rows.end());  // three functions are held, x and y alike
  Matrix given = Matrix::Zero(3, 2);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 2; ++c) {
      const auto k = static_cast<std::size_t>(2 * rows[static_cast<std::size_t>(r)] + c);
      fixed[k] = 1, x[k] = given(r, c) = 0.3 + r - 0.2 * c;
    }
  const std::vector<int> held(rows.begin(), rows.begin() + 3);
  const Matrix rest = f.load(free) - f.block(free, held) * given;
  Matrix expected(static_cast<Eigen::Index>(free.size()), 2);
  for (std::size_t r = 0; r < free.size(); ++r)
    expected.row(static_cast<Eigen::Index>(r)) =
        rest.row(static_cast<Eigen::Index>(r)) / f.lumped[static_cast<std::size_t>(free[r])];
  const auto solved = f.solve({Mass::fmpm, 1}, fixed, x);
  EXPECT_LT(difference(solved, free, expected), 1e-13);
  EXPECT_LT(difference(solved, held, given), 1e-15);
}

TEST(PartialLumping, LumpsTheRowsOfBoundaryFunctionsOnly) {
  Fixture f;
  const auto boundary = boundary_functions(*f.space, f.cells);
  std::vector<int> lumped, free;
  for (const int i : f.active_list()) (boundary[static_cast<std::size_t>(i)] ? lumped : free).push_back(i);
  EXPECT_EQ(lumped.size(), 12U);  // the rim of 3 x 3 cells
  EXPECT_EQ(free.size(), 4U);
  Matrix at_rim = f.load(lumped);
  for (std::size_t r = 0; r < lumped.size(); ++r)
    at_rim.row(static_cast<Eigen::Index>(r)) /= f.lumped[static_cast<std::size_t>(lumped[r])];
  const Matrix inside = f.block(free, free).ldlt().solve(f.load(free) - f.block(free, lumped) * at_rim);
  const auto x = f.solve({Mass::partial});
  EXPECT_LT(difference(x, lumped, at_rim), 1e-14);
  EXPECT_LT(difference(x, free, inside), 1e-9);
}

TEST(Deactivation, TakesOutWhatLiesBelowTheThreshold) {
  Fixture f;
  std::vector<int> kept, out;
  const double threshold = 0.5;  // kg; above it are the functions that the tips of the body reach well
  for (const int i : f.active_list()) (f.dense(i, i) < threshold ? out : kept).push_back(i);
  ASSERT_GE(out.size(), 1U);
  ASSERT_GE(kept.size(), 8U);
  const auto x = f.solve({Mass::consistent, 1, threshold});
  EXPECT_LT(difference(x, kept, f.block(kept, kept).ldlt().solve(f.load(kept))), 1e-9);
  EXPECT_LT(difference(x, out, Matrix::Zero(static_cast<Eigen::Index>(out.size()), 2)), 1e-15);
}

}  // namespace
}  // namespace wisp
