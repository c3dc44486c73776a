// Ghost on triangulations: which edges, and what the matrix does to polynomials.
#include "stabilise/triangle_ghost.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "grid/triangulate.h"

namespace wisp {
namespace {

std::shared_ptr<const Triangulation> irregular(double spacing = 0.4) {
  PolygonVertices vertices;
  vertices.spacing = spacing, vertices.irregularity = 0.3, vertices.seed = 3;
  return std::make_shared<const Triangulation>(
      triangulate_polygon(Outline({{{0, 0}, {1.3, 0}, {1.3, 1}, {0, 1}}}), vertices));
}

std::vector<Body<2>> one_body() {
  std::vector<Body<2>> bodies;
  bodies.push_back({"body", {}, make_material<2>(LinearElastic{900.0, 1e6, 0.3})});
  return bodies;
}

/// All triangles active, all edges penalised.
Eigen::MatrixXd ghost_matrix(const Space<2>& space, double gamma = 0.5,
                             GhostMatrix kind = GhostMatrix::mass) {
  ActiveCells active{std::vector<int>(static_cast<std::size_t>(space.n_cells()), 1)};
  const auto facets = triangle_ghost_facets(space, active, one_body(), {}, GhostElements::ring_all);
  BlockMatrix matrix(1);
  matrix.begin_pattern(space.n_functions());
  add_triangle_ghost_pattern(space, facets, matrix);
  matrix.end_pattern();
  GhostOptions options;
  options.mass = options.stiffness = gamma;
  add_triangle_ghost(space, facets, options, kind, matrix);
  const int n = space.n_functions();
  Eigen::MatrixXd dense(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) dense(i, j) = matrix.entry(i, 0, j, 0);
  return dense;
}

struct TriangleGhost : testing::TestWithParam<int> {
  AnyBasisOptions basis() const {
    const AnyBasisOptions all[] = {LinearOptions{}, LagrangeQuadraticOptions{}, PowellSabinOptions{},
                                   PowellSabinCubicOptions{}};
    return all[GetParam()];
  }
  int degree() const { return GetParam() == 0 ? 1 : GetParam() == 3 ? 3 : 2; }
};
INSTANTIATE_TEST_SUITE_P(Bases, TriangleGhost, testing::Range(0, 4));

TEST_P(TriangleGhost, IsSymmetricAndItsKernelAreThePolynomialsOfTheDegree) {
  const Space<2> space(irregular(), basis());
  for (const auto kind : {GhostMatrix::mass, GhostMatrix::stiffness}) {
    const Eigen::MatrixXd m = ghost_matrix(space, 0.5, kind);
    EXPECT_LT((m - m.transpose()).norm(), 1e-13 * m.norm());
    // Relative to the diagonal: the weights of segments spread over many powers of ten.
    Eigen::VectorXd scale = m.diagonal();
    ASSERT_GT(scale.minCoeff(), 0.0);
    scale = scale.cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * m * scale.asDiagonal());
    EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-12);
    const auto kernel = (solver.eigenvalues().array() < 1e-10).count();
    EXPECT_EQ(kernel, (degree() + 1) * (degree() + 2) / 2);
    // The coefficients of linear fields are known: sums with control points.
    for (int d = -1; d < 2; ++d) {
      Eigen::VectorXd field(space.n_functions());
      for (int i = 0; i < space.n_functions(); ++i) field[i] = d < 0 ? 1.0 : space.node_position(i)[d];
      EXPECT_LT((m * field).norm(), 1e-11 * m.norm());
    }
  }
}

TEST_P(TriangleGhost, ZeroParameterIsZeroMatrix) {
  const Space<2> space(irregular(), basis());
  EXPECT_EQ(ghost_matrix(space, 0.0).norm(), 0.0);
}

TEST(TriangleGhost, OneEdgeByHand) {
  // A roof over the edge x = 0 with slopes -1 and 2: the normal derivative jumps by 3 along a length of 2;
  // the heights are 1 and 3, so u^T M_G u = gamma rho h^3/3 9 * 2 with h = 2.
  const auto mesh =
      std::make_shared<const Triangulation>(std::vector<Vec<2>>{{0, -1}, {0, 1}, {-1, 0.2}, {3, -0.4}},
                                            std::vector<std::array<int, 3>>{{1, 0, 3}, {0, 1, 2}});
  const Space<2> space(mesh, LinearOptions{});
  const Eigen::MatrixXd m = ghost_matrix(space);
  const Eigen::Vector4d u(0.0, 0.0, 1.0, 6.0);
  EXPECT_NEAR(u.dot(m * u), 0.5 * 900.0 * 8.0 / 3.0 * 9.0 * 2.0, 1e-9);
}

TEST(TriangleGhostFacets, FollowTheirChoiceOfElements) {
  // 4 x 4 blocks of four triangles, the body in the lower left 2 x 2 blocks.
  const auto mesh = std::make_shared<const Triangulation>(triangulate_blocks(
      StructuredGrid<2>(Vec<2>(0, 0), Vec<2>(4, 4), MultiIndex<2>(4, 4)), BlockSplit::four));
  const Space<2> space(mesh, LinearOptions{});
  ActiveCells active{std::vector<int>(64, 0)};
  for (int t = 0; t < 64; ++t)
    active.bits[static_cast<std::size_t>(t)] = (mesh->centroid(t).array() < 2.0).all();
  const auto count = [&](GhostElements elements, const HeldEdges<2>& held) {
    return triangle_ghost_facets(space, active, one_body(), held, elements).size();
  };
  HeldEdges<2> held;
  held.edge.assign(static_cast<std::size_t>(mesh->n_edges()), 0);
  for (const char* side : {"left", "bottom"})
    for (const int e : mesh->part(side).edges) held.edge[static_cast<std::size_t>(e)] = 1;
  // Every block has two neighbouring triangles on free sides, with three of its four diagonals; the sides
  // between blocks are those of inner triangles. With left and bottom held the blocks have 0, 2, 2 and 3.
  EXPECT_EQ(count(GhostElements::boundary, {}), 12U);
  EXPECT_EQ(count(GhostElements::boundary, held), 7U);
  // The ring: one more layer of blocks above and on the right that touches the body's vertices.
  std::size_t ring_edges = 0;
  const ActiveCells ring = triangle_ghost_cells(space, active, GhostElements::ring_all);
  for (int e = 0; e < mesh->n_edges(); ++e) {
    const auto& [t, u] = mesh->edge(e).triangle;
    ring_edges += u >= 0 && ring.bits[static_cast<std::size_t>(t)] && ring.bits[static_cast<std::size_t>(u)];
  }
  EXPECT_EQ(count(GhostElements::ring_all, {}), ring_edges);
  EXPECT_LE(count(GhostElements::ring, held), ring_edges);
  EXPECT_GT(count(GhostElements::ring, held), count(GhostElements::boundary, held));
  for (int t = 0; t < 64; ++t) {
    bool near = false;
    for (const int v : mesh->triangle(t)) near |= (mesh->vertex(v).array() <= 2.0).all();
    EXPECT_EQ(ring.bits[static_cast<std::size_t>(t)], near ? 1 : 0);
  }
}

}  // namespace
}  // namespace wisp
