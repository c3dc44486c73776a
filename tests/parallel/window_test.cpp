#include "parallel/window.h"

#include <gtest/gtest.h>

namespace wisp {
namespace {

TEST(Window, NumbersNodesAndCellsDenselyWithXFastest) {
  const Window<2> w(MultiIndex<2>(10, 8), IndexBox<2>{{4, 0}, {7, 8}});
  EXPECT_EQ(w.n_cells(), 7 * 12);
  EXPECT_EQ(w.n_nodes(), 8 * 13);
  EXPECT_EQ(w.cell_strides(), MultiIndex<2>(1, 7));
  EXPECT_EQ(w.node_strides(), MultiIndex<2>(1, 8));
  EXPECT_EQ(w.node_index({2, -2}), 0);
  EXPECT_EQ(w.node_index({3, -2}), 1);
  EXPECT_EQ(w.node_index({2, -1}), 8);
  int expected = 0;
  for_each_in(w.nodes(), [&](const MultiIndex<2>& node) {
    ASSERT_EQ(w.node_index(node), expected);
    ASSERT_EQ(w.node_multi_index(expected), node);
    ++expected;
  });
  EXPECT_EQ(expected, w.n_nodes());
  expected = 0;
  for_each_in(w.cells(), [&](const MultiIndex<2>& cell) {
    ASSERT_EQ(w.cell_index(cell), expected);
    ASSERT_EQ(w.cell_multi_index(expected), cell);
    ASSERT_EQ(w.first_node_of_cell(expected), w.node_index(cell));
    ++expected;
  });
  EXPECT_EQ(expected, w.n_cells());
}

TEST(Window, NumbersThreeDirections) {
  const Window<3> w(MultiIndex<3>(5, 6, 7), IndexBox<3>{{1, 2, 3}, {3, 4, 5}});
  EXPECT_EQ(w.node_strides(), MultiIndex<3>(1, 7, 49));
  EXPECT_EQ(w.cell_strides(), MultiIndex<3>(1, 6, 36));
  for (int node = 0; node < w.n_nodes(); ++node) ASSERT_EQ(w.node_index(w.node_multi_index(node)), node);
}

TEST(Window, TellsOwnGhostAndPhantomApart) {
  const MultiIndex<2> n(10, 8);
  const Window<2> left(n, IndexBox<2>{{0, 0}, {4, 8}});
  const Window<2> right(n, IndexBox<2>{{4, 0}, {10, 8}});
  EXPECT_TRUE(left.owns_cell({3, 7}));
  EXPECT_FALSE(left.owns_cell({4, 7}));
  EXPECT_TRUE(left.contains_cell({5, 7}));
  EXPECT_FALSE(left.contains_cell({6, 7}));
  EXPECT_TRUE(left.contains_cell({-2, -2}));
  EXPECT_FALSE(left.cell_in_grid({-1, 0}));
  // Nodes between two boxes belong to the upper one, nodes of the grid's upper edges to the last.
  EXPECT_FALSE(left.owns_node({4, 3}));
  EXPECT_TRUE(right.owns_node({4, 3}));
  EXPECT_TRUE(left.owns_node({0, 8}));
  EXPECT_TRUE(right.owns_node({10, 8}));
  EXPECT_TRUE(right.node_in_grid({10, 8}));
  EXPECT_FALSE(right.node_in_grid({11, 8}));
  EXPECT_FALSE(right.owns_node({11, 8}));
}

TEST(Window, IsTheWholeGridForOnePart) {
  const BoxPartition<3> partition(MultiIndex<3>(3, 4, 5));
  const Window<3> w(partition, 0);
  EXPECT_EQ(w.owned_cells(), w.grid_cells());
  EXPECT_EQ(w.owned_nodes(), w.grid_nodes());
  EXPECT_EQ(w.n_nodes(), 8 * 9 * 10);
}

}  // namespace
}  // namespace wisp
