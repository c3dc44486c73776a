#include "parallel/box_partition.h"

#include <gtest/gtest.h>

#include <random>

#include "core/error.h"

namespace wisp {
namespace {

/// A random cloud of some lumps; every rank makes the same one and keeps each size()-th point.
template <int dim>
std::vector<MultiIndex<dim>> random_cloud(unsigned seed, const MultiIndex<dim>& n_cells, int n_points,
                                          bool all) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal(0.0, 0.1);
  std::vector<Eigen::Matrix<double, dim, 1>> centres(3);
  for (auto& centre : centres)
    for (int d = 0; d < dim; ++d) centre[d] = uniform(random);
  std::vector<MultiIndex<dim>> result;
  for (int p = 0; p < n_points; ++p) {
    MultiIndex<dim> cell;
    for (int d = 0; d < dim; ++d) {
      const double x = centres[static_cast<std::size_t>(p % 3)][d] + normal(random);
      cell[d] = std::clamp(static_cast<int>(x * n_cells[d]), 0, n_cells[d] - 1);
    }
    if (all || p % Session::size() == Session::rank()) result.push_back(cell);
  }
  return result;
}

template <int dim>
void expect_each_cell_owned_once(const BoxPartition<dim>& partition) {
  const MultiIndex<dim> n = partition.n_cells();
  const IndexBox<dim> grid{MultiIndex<dim>::Zero(), n};
  std::int64_t cells = 0;
  for (int part = 0; part < partition.n_parts(); ++part) {
    EXPECT_GT(partition.box(part).count(), 0);
    cells += partition.box(part).count();
  }
  EXPECT_EQ(cells, grid.count());
  for_each_in(grid, [&](const MultiIndex<dim>& cell) {
    int owners = 0;
    for (int part = 0; part < partition.n_parts(); ++part)
      owners += partition.box(part).contains(cell) ? 1 : 0;
    ASSERT_EQ(owners, 1) << cell.transpose();
    ASSERT_TRUE(partition.box(partition.owner_of_cell(cell)).contains(cell)) << cell.transpose();
    ASSERT_EQ(partition.owner_of_node(cell), partition.owner_of_cell(cell));
  });
  EXPECT_EQ(partition.owner_of_node(n), partition.owner_of_cell(n - MultiIndex<dim>::Ones()));
}

template <int dim>
double greatest_over_mean(const BoxPartition<dim>& partition, const std::vector<MultiIndex<dim>>& points) {
  std::vector<int> count(static_cast<std::size_t>(partition.n_parts()), 0);
  for (const auto& cell : points) ++count[static_cast<std::size_t>(partition.owner_of_cell(cell))];
  return *std::max_element(count.begin(), count.end()) * static_cast<double>(partition.n_parts()) /
         static_cast<double>(points.size());
}

/// Sanitizers make a cloud fifty times as dear.
#ifdef __SANITIZE_ADDRESS__
constexpr unsigned seeds = 1;
#else
constexpr unsigned seeds = 5;
#endif

TEST(BoxPartition, BalancesRandomCloudsForAnyNumberOfParts) {
  for (const int parts : {1, 2, 3, 4, 5, 7, 8, 12})
    for (unsigned seed = 1; seed <= seeds; ++seed) {
      const MultiIndex<2> n2(200, 150);
      const BoxPartition<2> p2(n2, random_cloud<2>(seed, n2, 20000, false), parts);
      expect_each_cell_owned_once(p2);
      EXPECT_LT(greatest_over_mean(p2, random_cloud<2>(seed, n2, 20000, true)), 1.1)
          << parts << " parts, seed " << seed;
      const MultiIndex<3> n3(40, 30, 35);
      const BoxPartition<3> p3(n3, random_cloud<3>(seed, n3, 20000, false), parts);
      expect_each_cell_owned_once(p3);
      EXPECT_LT(greatest_over_mean(p3, random_cloud<3>(seed, n3, 20000, true)), 1.25)
          << parts << " parts, seed " << seed;
    }
}

TEST(BoxPartition, IsTheSameHoweverThePointsAreSpread) {
  const MultiIndex<2> n(50, 40);
  const auto all = random_cloud<2>(3, n, 2000, true);
  const BoxPartition<2> spread(n, random_cloud<2>(3, n, 2000, false), 6);
  const BoxPartition<2> on_one(n, Session::rank() == 0 ? all : std::vector<MultiIndex<2>>(), 6);
  EXPECT_EQ(spread, on_one);
}

TEST(BoxPartition, SplitsAColumnAcrossItsLength) {
  // One column of points: cuts across it only, each part a stretch of it.
  const MultiIndex<2> n(5, 100);
  std::vector<MultiIndex<2>> points;
  if (Session::rank() == 0)
    for (int j = 10; j < 90; ++j) points.emplace_back(2, j);
  const BoxPartition<2> partition(n, points, 4);
  std::vector<int> count(4, 0);
  for (int j = 10; j < 90; ++j) ++count[static_cast<std::size_t>(partition.owner_of_cell({2, j}))];
  EXPECT_EQ(count, std::vector<int>(4, 20));
}

TEST(BoxPartition, BalancesCellsWhereThereAreNoPoints) {
  const BoxPartition<2> partition(MultiIndex<2>(8, 4), {}, 4);
  expect_each_cell_owned_once(partition);
  for (int part = 0; part < 4; ++part) EXPECT_EQ(partition.box(part).count(), 8);
}

TEST(BoxPartition, GivesEveryPartACellEvenIfAllPointsShareOne) {
  std::vector<MultiIndex<2>> points(100, MultiIndex<2>(0, 0));
  for (const int parts : {2, 3, 5, 6})
    expect_each_cell_owned_once(BoxPartition<2>(MultiIndex<2>(2, 3), points, parts));
}

TEST(BoxPartition, RefusesMorePartsThanCellsAndPointsOutside) {
  EXPECT_THROW(BoxPartition<1>(MultiIndex<1>(3), {}, 4), InputError);
  std::vector<MultiIndex<2>> outside;
  if (Session::rank() == Session::size() - 1)
    outside.emplace_back(4, 0);  // on one rank only: all must hear of it
  EXPECT_THROW(BoxPartition<2>(MultiIndex<2>(4, 4), outside), RunError);
}

}  // namespace
}  // namespace wisp
