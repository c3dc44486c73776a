// Which facets are penalised, on patterns drawn by hand, and what the penalty's matrix does.
#include "stabilise/ghost.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <memory>
#include <set>

namespace wisp {
namespace {

template <int dim>
std::unique_ptr<Space<dim>> make_space(const MultiIndex<dim>& cells, double stretch = 1.0) {
  std::array<std::vector<double>, dim> lines;
  for (int d = 0; d < dim; ++d) {
    double x = 0.0, h = 0.5;
    for (int i = 0; i <= cells[d]; ++i) lines[static_cast<std::size_t>(d)].push_back(x), x += h, h *= stretch;
  }
  const StructuredGrid<dim> grid(lines);
  return std::make_unique<Space<dim>>(grid, BoxPartition<dim>(grid.cells()), false);
}

/// Sets the bits of a body in all cells of a box.
template <int dim>
void fill(ActiveCells& active, const Space<dim>& space, const IndexBox<dim>& box, int body) {
  active.bits.resize(static_cast<std::size_t>(space.window().n_cells()), 0);
  for_each_in(box, [&](const MultiIndex<dim>& c) {
    active.bits[static_cast<std::size_t>(space.window().cell_index(c))] |= 1 << body;
  });
}

template <int dim>
std::vector<Body<dim>> bodies(std::vector<Hencky> laws = {{1000.0, 1e6, 0.25}}) {
  std::vector<Body<dim>> list;
  for (const auto& law : laws) list.push_back({"body", {}, make_material<dim>(law)});
  return list;
}

constexpr std::array<bool, 4> no_edges{};

using Place = std::array<int, 3>;  // x, y of the lower cell, direction
std::set<Place> places(const Space<2>& space, const std::vector<GhostFacet>& facets) {
  std::set<Place> set;
  for (const auto& f : facets) {
    const MultiIndex<2> c = space.window().cell_multi_index(f.lower);
    set.insert({c[0], c[1], f.direction});
  }
  EXPECT_EQ(set.size(), facets.size()) << "a facet is listed twice";
  return set;
}

TEST(GhostFacets, OfABlockAreAllButThoseBetweenInnerCells) {
  const auto space = make_space<2>({7, 7});
  ActiveCells active;
  fill<2>(active, *space, {{1, 1}, {6, 6}}, 0);
  const auto set = places(*space, ghost_facets<2>(*space, active, bodies<2>(), no_edges));
  EXPECT_EQ(set.size(), 28U);  // 40 facets in the block, 12 of them between two inner cells
  for (int i = 1; i < 6; ++i)
    for (int j = 1; j < 6; ++j)
      for (int d = 0; d < 2; ++d) {
        const int ni = i + (d == 0), nj = j + (d == 1);
        if (ni > 5 || nj > 5) continue;
        const auto inner = [](int a, int b) { return a > 1 && a < 5 && b > 1 && b < 5; };
        EXPECT_EQ(set.count({i, j, d}), inner(i, j) && inner(ni, nj) ? 0U : 1U);
      }
}

TEST(GhostFacets, OfABlockIn3D) {
  const auto space = make_space<3>({6, 6, 6});
  ActiveCells active;
  fill<3>(active, *space, {{1, 1, 1}, {5, 5, 5}}, 0);
  const auto facets = ghost_facets<3>(*space, active, bodies<3>(), {});
  EXPECT_EQ(facets.size(), 144U - 12U);
}

TEST(GhostFacets, OfAnLShape) {
  // xx.
  // xx.      cells (1,1), (2,1), (3,1), (1,2), (2,2), (1,3), (2,3); only an edge neighbour counts, so all
  // xxx      seven are boundary cells and all eight facets between them are penalised
  const auto space = make_space<2>({5, 5});
  ActiveCells active;
  fill<2>(active, *space, {{1, 1}, {4, 2}}, 0);
  fill<2>(active, *space, {{1, 2}, {3, 4}}, 0);
  EXPECT_EQ(places(*space, ghost_facets<2>(*space, active, bodies<2>(), no_edges)),
            (std::set<Place>{
                {1, 1, 0}, {2, 1, 0}, {1, 1, 1}, {2, 1, 1}, {1, 2, 0}, {1, 2, 1}, {2, 2, 1}, {1, 3, 0}}));
}

TEST(GhostFacets, ACellThatTouchesNothingHasNone) {
  const auto space = make_space<2>({5, 5});
  ActiveCells active;
  fill<2>(active, *space, {{1, 1}, {2, 2}}, 0);
  fill<2>(active, *space, {{2, 2}, {3, 3}}, 0);  // a corner in common only
  EXPECT_TRUE(ghost_facets<2>(*space, active, bodies<2>(), no_edges).empty());
}

TEST(GhostFacets, OfTwoBodiesAreUnitedAndTakeTheStifferAndDenser) {
  const auto space = make_space<2>({8, 7});
  ActiveCells one, two, both;
  fill<2>(one, *space, {{1, 1}, {6, 6}}, 0);
  fill<2>(two, *space, {{1, 1}, {1, 1}}, 0);
  fill<2>(two, *space, {{4, 1}, {7, 6}}, 1);
  both = one;
  fill<2>(both, *space, {{4, 1}, {7, 6}}, 1);
  const auto list = bodies<2>({{1000.0, 1e6, 0.25}, {500.0, 3e6, 0.25}});
  const auto facets = ghost_facets<2>(*space, both, list, no_edges);
  auto expected = places(*space, ghost_facets<2>(*space, one, list, no_edges));
  const auto first = expected, second = places(*space, ghost_facets<2>(*space, two, list, no_edges));
  expected.insert(second.begin(), second.end());
  EXPECT_EQ(places(*space, facets), expected);
  for (const auto& f : facets) {
    const MultiIndex<2> c = space->window().cell_multi_index(f.lower);
    const Place place{c[0], c[1], f.direction};
    const bool a = first.count(place) > 0, b = second.count(place) > 0;
    EXPECT_EQ(f.density, a ? 1000.0 : 500.0);
    EXPECT_DOUBLE_EQ(f.p_wave_modulus, b ? 3.6e6 : 1.2e6);
  }
}

TEST(GhostFacets, BodiesSideBySideDoNotCloseEachOthersEdges) {
  // Two bodies of two columns each share a line: across it no body has both cells, and each has its own edge.
  const auto space = make_space<2>({6, 6});
  ActiveCells active;
  fill<2>(active, *space, {{1, 1}, {3, 5}}, 0);
  fill<2>(active, *space, {{3, 1}, {5, 5}}, 1);
  const auto set = places(*space, ghost_facets<2>(*space, active, bodies<2>({{}, {}}), no_edges));
  EXPECT_EQ(set.size(), 2U * (4 + 2 * 3));
  for (int j = 1; j < 5; ++j) EXPECT_EQ(set.count({2, j, 0}), 0U);
}

TEST(GhostFacets, AnEdgeOfTheGridWithoutAConditionIsAnEmptyNeighbour) {
  const auto space = make_space<2>({3, 3});
  ActiveCells active;
  fill<2>(active, *space, {{0, 0}, {3, 3}}, 0);
  const auto list = bodies<2>();
  EXPECT_EQ(ghost_facets<2>(*space, active, list, no_edges).size(), 12U);
  EXPECT_EQ(ghost_facets<2>(*space, active, list, std::array<bool, 4>{true, true, true, true}).size(), 0U);
  // Lower y edge held: cells (1, 0) and (1, 1) are inner ones, so only the facet between them is not
  // penalised.
  const auto set =
      places(*space, ghost_facets<2>(*space, active, list, std::array<bool, 4>{false, false, true, false}));
  EXPECT_EQ(set.size(), 11U);
  EXPECT_EQ(set.count({1, 0, 1}), 0U);
}

template <int dim>
struct Assembled {
  std::unique_ptr<Space<dim>> space;
  std::vector<GhostFacet> facets;
  BlockMatrix matrix{1};
};

/// The mass penalty of a block of 2^dim cells in the middle of an unequal grid.
template <int dim>
Assembled<dim> assemble(const GhostOptions& options, GhostMatrix kind) {
  Assembled<dim> a{make_space<dim>(MultiIndex<dim>::Constant(4), 1.3), {}, BlockMatrix(1)};
  ActiveCells active;
  fill<dim>(active, *a.space, {MultiIndex<dim>::Constant(1), MultiIndex<dim>::Constant(3)}, 0);
  a.facets = ghost_facets<dim>(*a.space, active, bodies<dim>(), {});
  a.matrix.begin_pattern(a.space->n_functions());
  add_ghost_pattern(*a.space, a.facets, a.matrix);
  a.matrix.end_pattern();
  add_ghost(*a.space, a.facets, options, kind, a.matrix);
  return a;
}

template <class Dim>
struct GhostMatrixTest : testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(GhostMatrixTest, Dimensions);

TYPED_TEST(GhostMatrixTest, IsSymmetricSemiDefiniteAndItsKernelIsTheGlobalPolynomials) {
  constexpr int dim = TypeParam::value;
  for (const auto kind : {GhostMatrix::mass, GhostMatrix::stiffness}) {
    const auto a = assemble<dim>(GhostOptions{}, kind);
    const int n = a.space->n_functions();
    Eigen::MatrixXd dense(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) dense(i, j) = a.matrix.entry(i, 0, j, 0);
    EXPECT_LT((dense - dense.transpose()).norm(), 1e-14 * dense.norm());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(dense);
    const double largest = solver.eigenvalues().maxCoeff();
    ASSERT_GT(largest, 0.0);
    EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-14 * largest);
    // Without jumps the 2^dim cells carry one multilinear function: 2^dim numbers of 3^dim stay free.
    const auto positive = (solver.eigenvalues().array() > 1e-10 * largest).count();
    EXPECT_EQ(positive, dim == 2 ? 9 - 4 : 27 - 8);
    // Linear fields: no force, so neither momentum nor angular momentum changes.
    for (int d = -1; d < dim; ++d) {
      Eigen::VectorXd field(n);
      for (int i = 0; i < n; ++i) field[i] = d < 0 ? 1.0 : a.space->node_position(i)[d];
      EXPECT_LT((dense * field).norm(), 1e-13 * dense.norm());
    }
  }
}

TYPED_TEST(GhostMatrixTest, ZeroParameterIsZeroMatrix) {
  constexpr int dim = TypeParam::value;
  GhostOptions none;
  none.mass = none.stiffness = 0.0;
  for (const auto kind : {GhostMatrix::mass, GhostMatrix::stiffness}) {
    const auto a = assemble<dim>(none, kind);
    for (const double v : a.matrix.values()) ASSERT_EQ(v, 0.0);
  }
}

TEST(GhostFactor, FollowsItsUnits) {
  const GhostFacet facet{{0, 0}, 900.0, 5e6};
  GhostOptions o;
  o.mass = 0.5, o.stiffness = 0.02;
  EXPECT_DOUBLE_EQ(ghost_factor(o, GhostMatrix::mass, facet, 0.1), 450.0);
  EXPECT_DOUBLE_EQ(ghost_factor(o, GhostMatrix::stiffness, facet, 0.1), 0.02 * 5e6 / 0.01);
  o.units = GhostUnits::paper;
  EXPECT_DOUBLE_EQ(ghost_factor(o, GhostMatrix::mass, facet, 0.1), 0.5);
  EXPECT_DOUBLE_EQ(ghost_factor(o, GhostMatrix::stiffness, facet, 0.1), 0.02);
  o.scale = GhostScale::figures;
  EXPECT_DOUBLE_EQ(ghost_factor(o, GhostMatrix::stiffness, facet, 0.1), 0.02 * 0.0025);
}

TEST(GhostMatrix, OneFacetByHand) {
  // Two unit-free cells of side h: u = |x - x_f| jumps by 2 across the facet, so u^T M_G u = factor h^3/3 * 4
  // * h.
  const auto space = make_space<2>({2, 1});
  const std::vector<GhostFacet> facets{{{space->window().cell_index({0, 0}), 0}, 900.0, 5e6}};
  BlockMatrix matrix(1);
  matrix.begin_pattern(space->n_functions());
  add_ghost_pattern(*space, facets, matrix);
  matrix.end_pattern();
  GhostOptions options;
  options.mass = 0.5;
  add_ghost(*space, facets, options, GhostMatrix::mass, matrix);
  const double h = 0.5;
  std::vector<double> u(static_cast<std::size_t>(space->n_functions())), mu(u.size());
  for (int i = 0; i < space->n_functions(); ++i)
    u[static_cast<std::size_t>(i)] = std::abs(space->node_position(i)[0] - h);
  matrix.multiply(u, mu);
  double form = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) form += u[i] * mu[i];
  EXPECT_NEAR(form, 450.0 * h * h * h / 3.0 * 4.0 * h, 1e-12);
}

}  // namespace
}  // namespace wisp
