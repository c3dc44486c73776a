// Impulses of rows: what each row asks for holds, by both ways of solving.
#include "boundary/wall_system.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace wisp {
namespace {

/// Rows on a lattice, each the mean of the functions at its corners, whose masses vary from 0.1 to 1: rows
/// beside each other share functions, so A is nearly singular. `n` rows a direction.
template <int dim>
struct Lattice {
  static constexpr int flat = dim - 1;  // a wall
  int n;
  std::vector<double> inverse;
  std::vector<RowState<dim>> rows;
  WallSystem<dim> system;

  explicit Lattice(int n_) : n(n_) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const int nodes = flat == 1 ? n + 1 : (n + 1) * (n + 1), count = flat == 1 ? n : n * n;
    for (int k = 0; k < nodes; ++k) inverse.push_back(std::pow(10.0, 0.5 + 0.5 * unit(random)));
    for (int r = 0; r < count; ++r) {
      for (int s = 0; s < count; ++s) {
        double a = 0.0;
        for (const int i : corners(r))
          for (const int j : corners(s))
            if (i == j) a += inverse[static_cast<std::size_t>(i)] / std::pow(4.0, flat);
        if (a > 0.0) system.add(s, Vec<dim>::Constant(a));
      }
      system.end_row();
      RowState<dim> row;
      row.normal = Vec<dim>::Unit(dim - 1) + 0.1 * Vec<dim>::Unit(0) * std::sin(0.1 * r);
      row.normal.normalize();
      row.target = 0.1 * Vec<dim>::Unit(0);
      row.normal_held = row.tangent_held = true;
      row.pushes = r % 5 != 0, row.slips = r % 7 != 0;
      row.friction = 0.4, row.bias = r % 3 ? 0.0 : -0.1;
      rows.push_back(row);
      Vec<dim> v;
      for (int d = 0; d < dim; ++d) v[d] = unit(random);
      v[dim - 1] -= 0.5;
      system.velocity().push_back(v);
    }
  }
  std::vector<int> corners(int r) const {
    if (flat == 1) return {r, r + 1};
    const int k = r % n + r / n * (n + 1);
    return {k, k + 1, k + n + 1, k + n + 2};
  }
  Vec<dim> diagonal(int r) const {
    double a = 0.0;
    for (const int i : corners(r)) a += inverse[static_cast<std::size_t>(i)] / std::pow(4.0, flat);
    return Vec<dim>::Constant(a);
  }
};

template <int dim>
void check(int n, double tolerance) {
  Lattice<dim> lattice(n);
  auto& system = lattice.system;
  system.find(lattice.rows);
  int pushed = 0, open = 0, stuck = 0, slipping = 0;
  for (std::size_t r = 0; r < lattice.rows.size(); ++r) {
    const RowState<dim>& row = lattice.rows[r];
    const Vec<dim> u = system.velocity()[r] - row.target +
                       WallSystem<dim>::yield * lattice.diagonal(static_cast<int>(r))[0] * row.impulse();
    const double un = u.dot(row.normal) - row.bias;
    const Vec<dim> ut = u - u.dot(row.normal) * row.normal;
    if (row.pushes) {
      EXPECT_GE(row.lambda_n, 0.0);
      EXPECT_GE(un, -tolerance);
      EXPECT_LE(std::abs(un) * row.lambda_n, tolerance);
      ++(row.lambda_n > 0.0 ? pushed : open);
    } else {
      EXPECT_NEAR(un, 0.0, tolerance);
    }
    if (!row.slips && row.pushes && row.lambda_n == 0.0) {
      EXPECT_TRUE(row.lambda_t.isZero(0.0));
      continue;
    }
    const double most = row.slips ? row.friction * std::abs(row.lambda_n) : 1e300;
    EXPECT_LE(row.lambda_t.norm(), most * (1.0 + 1e-9) + tolerance);
    if (row.lambda_t.norm() < most * (1.0 - 1e-9)) {
      EXPECT_LE(ut.norm(), tolerance) << r;
      ++stuck;
    } else {  // against the motion
      EXPECT_NEAR(ut.dot(row.lambda_t), -ut.norm() * row.lambda_t.norm(), tolerance);
      ++slipping;
    }
  }
  for (const int count : {pushed, open, stuck, slipping}) EXPECT_GT(count, n / 20);
}

TEST(WallSystem, FindsImpulsesThatAreAdmissible) { check<2>(200, 1e-8); }
TEST(WallSystem, FindsThemOnSurfacesToo) { check<3>(8, 1e-8); }

template <int dim>
void check_projection(int n, double tolerance) {
  Lattice<dim> lattice(n);
  auto& system = lattice.system;
  for (std::size_t r = 0; r < lattice.rows.size(); ++r)
    lattice.rows[r].lambda_n = r % 4 ? 1.0 : 0.0, lattice.rows[r].sticks = r % 3 == 0;
  const auto before = system.velocity();
  std::vector<Vec<dim>> impulse(lattice.rows.size(), Vec<dim>::Zero());
  system.project(lattice.rows, impulse);
  for (std::size_t r = 0; r < lattice.rows.size(); ++r) {
    const RowState<dim>& row = lattice.rows[r];
    const Vec<dim> u = system.velocity()[r] - row.target +
                       WallSystem<dim>::yield * lattice.diagonal(static_cast<int>(r))[0] * impulse[r];
    if (!row.loaded()) {
      EXPECT_TRUE(impulse[r].isZero(0.0));
      continue;
    }
    EXPECT_NEAR(u.dot(row.normal), row.bias, tolerance);
    if (row.sticks)
      EXPECT_LE((u - u.dot(row.normal) * row.normal).norm(), tolerance);
    else
      EXPECT_LE((impulse[r] - impulse[r].dot(row.normal) * row.normal).norm(), 1e-12 * impulse[r].norm());
  }
}

TEST(WallSystem, ProjectsLoadedRowsAlone) { check_projection<2>(200, 1e-10); }
/// So many rows on a surface are solved by conjugate gradients.
TEST(WallSystem, ProjectsWideSurfaces) { check_projection<3>(40, 1e-6); }

TEST(WallSystem, RowsThatSayTheSameShareAnImpulse) {
  WallSystem<2> system;
  std::vector<RowState<2>> rows(2);
  for (int r = 0; r < 2; ++r) {
    for (int s = 0; s < 2; ++s) system.add(s, {2.0, 2.0});
    system.end_row();
    auto& row = rows[static_cast<std::size_t>(r)];
    row.normal = {0.0, 1.0}, row.target.setZero(), row.normal_held = row.pushes = true;
  }
  system.velocity().assign(2, Vec<2>(0.3, -1.0));
  system.find(rows);
  EXPECT_NEAR(rows[0].lambda_n, rows[1].lambda_n, 1e-9);
  EXPECT_NEAR(rows[0].lambda_n + rows[1].lambda_n, 0.5, 1e-4);
  EXPECT_NEAR(system.velocity()[0][1], 0.0, 1e-4);
}

}  // namespace
}  // namespace wisp
