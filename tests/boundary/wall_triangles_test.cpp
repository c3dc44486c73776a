// Walls on triangulations: cutting at edges, hosts, tractions of fields that every basis has.
#include <gtest/gtest.h>

#include <numeric>

#include "boundary/wall.h"
#include "boundary/wall_host.h"
#include "grid/triangulate.h"
#include "particle/triangle_sampling.h"

namespace wisp {
namespace {

/// A body [1, 2] x [1, 2] in a grid [0, 4] x [0, 4] of blocks of four triangles, or an irregular one.
struct Scene {
  std::unique_ptr<Space<2>> space;
  std::vector<Body<2>> bodies;
  ActiveCells active;
};

std::shared_ptr<const Triangulation> mesh(bool irregular) {
  if (!irregular) {
    TriangleBlocksOptions o;
    o.lower = {0.0, 0.0}, o.upper = {4.0, 4.0}, o.cells = {8, 8};
    return std::make_shared<const Triangulation>(make_triangulation(AnyTriangulationOptions(o), {}));
  }
  PolygonVertices vertices;
  vertices.spacing = 0.5, vertices.irregularity = 0.3;
  return std::make_shared<const Triangulation>(
      triangulate_polygon(Outline({{{0, 0}, {4, 0}, {4, 4}, {0, 4}}}), vertices));
}

Scene scene(const AnyBasisOptions& basis, bool irregular) {
  Scene s;
  s.space = std::make_unique<Space<2>>(mesh(irregular), basis);
  BodyOptions body;
  body.label = "block", body.shape = Box{{1.0, 1.0}, {2.0, 2.0}}, body.material = Hencky{1000.0, 1e6, 0.3};
  s.bodies.push_back(sample(body, s.space->triangulation(), 0, {}));
  auto& points = s.bodies[0].points;
  points.cell.resize(points.position.size());
  for (std::size_t p = 0; p < points.cell.size(); ++p)
    points.cell[p] = s.space->triangulation().locate(points.position[p]);
  s.active = active_cells(*s.space, s.bodies);
  return s;
}

const std::vector<AnyBasisOptions>& bases() {
  static const std::vector<AnyBasisOptions> all{LinearOptions{}, LagrangeQuadraticOptions{},
                                                PowellSabinOptions{}, PowellSabinCubicOptions{}};
  return all;
}

WallOptions line(std::vector<std::vector<double>> vertices, WallKind kind) {
  WallOptions o;
  o.label = "wall", o.kind = kind;
  PolylineWall shape;
  shape.vertices = std::move(vertices);
  o.shape = shape;
  return o;
}

std::vector<double> linear_field(const Space<2>& space, const Mat<2>& gradient, const Vec<2>& a) {
  std::vector<double> u(static_cast<std::size_t>(space.n_functions()) * 2);
  for (int i = 0; i < space.n_functions(); ++i)
    Eigen::Map<Vec<2>>(u.data() + i * 2) = gradient * space.node_position(i) + a;
  return u;
}

TEST(WallsOnTriangles, PartsFillTheSegmentAndEachLiesInItsTriangle) {
  for (const bool irregular : {false, true}) {
    const Space<2> space(mesh(irregular), PowellSabinOptions{});
    const Triangulation& grid = space.triangulation();
    // Inside, along edges, through vertices (also at 45 degrees), along the boundary, out of the grid.
    for (const auto& [a, b] : {std::pair{Vec<2>(0.13, 0.21), Vec<2>(3.9, 3.17)},
                               {Vec<2>(1.0, 3.5), Vec<2>(1.0, 0.5)},
                               {Vec<2>(0.0, 0.0), Vec<2>(4.0, 4.0)},
                               {Vec<2>(0.0, 0.0), Vec<2>(4.0, 0.0)},
                               {Vec<2>(-0.5, 1.25), Vec<2>(4.5, 2.25)},
                               {Vec<2>(5.0, 0.0), Vec<2>(5.0, 4.0)}}) {
      const Vec<2> t = (b - a).normalized(), n(-t[1], t[0]);
      WallCut<2> cut;
      cut_piece<2>(space, {{a, b}, n}, cut);
      EXPECT_NEAR(std::accumulate(cut.weight.begin(), cut.weight.end(), 0.0), (b - a).norm(), 1e-13);
      for (const auto& part : cut.parts) {
        const int host = part.host[0];
        if (host < 0) {
          EXPECT_EQ(grid.locate(part.middle + 1e-5 * part.normal), -1);
          continue;
        }
        for (std::size_t q = part.first; q < part.first + part.count; ++q) {
          for (const double c : grid.barycentric(host, cut.position[q])) EXPECT_GT(c, -1e-9);
          // The sub-triangle's polynomial is the function itself there.
          const auto here = triangle_functions(space, host, part.host[1], cut.position[q]);
          visit_on_triangles(space, [&](const auto& basis) {
            basis.tabulate_in(host, cut.position[q]).for_each([&](int k, int i, double phi, const Vec<2>& g) {
              const auto at = static_cast<std::size_t>(k);
              EXPECT_EQ(here.function[at], i);
              EXPECT_NEAR(here.phi[at], phi, 1e-9);
              EXPECT_LT((here.dphi[at] - g).norm(), 1e-6);
            });
          });
        }
      }
    }
  }
}

TEST(WallsOnTriangles, AlongAnEdgeTheHostIsOnTheSolidSide) {
  const Space<2> space(mesh(false), LinearOptions{});
  for (const bool up : {true, false}) {
    WallCut<2> cut;
    const Vec<2> a(up ? 0.0 : 4.0, 1.0), b(up ? 4.0 : 0.0, 1.0);
    cut_piece<2>(space, {{a, b}, Vec<2>(0.0, up ? 1.0 : -1.0)}, cut);
    ASSERT_EQ(cut.parts.size(), 8U);
    for (const auto& part : cut.parts) EXPECT_EQ(space.triangulation().centroid(part.host[0])[1] > 1.0, up);
  }
}

TEST(WallsOnTriangles, GaussPointsAreExactForTheProductsOfFunctions) {
  for (const int points : {3, 4}) {
    WallCut<2> cut;
    add_part({0.0, 0.0}, {2.0, 0.0}, {0.0, 1.0}, {0, 0}, points, cut);
    double sum = 0.0;
    for (std::size_t q = 0; q < cut.weight.size(); ++q)
      sum += cut.weight[q] * std::pow(cut.position[q][0], 2 * points - 1);
    EXPECT_NEAR(sum, std::pow(2.0, 2 * points) / (2 * points), 1e-13 * sum);
  }
}

/// The consistent form answers a field that fits the wall by its exact traction, whatever the basis.
TEST(WallsOnTriangles, ALinearFieldThatFitsTheWallGivesItsTraction) {
  const Elasticity e = Elasticity::from(1e6, 0.3);
  for (const auto& basis : bases())
    for (const bool irregular : {false, true}) {
      auto s = scene(basis, irregular);
      for (const WallKind kind : {WallKind::fixed, WallKind::roller, WallKind::tangential}) {
        Wall<2> wall(line({{1.2, 1.0}, {1.9, 1.2}}, kind), {});
        const Vec<2> at(1.9, 1.2), t = Vec<2>(0.7, 0.2).normalized(), n(-t[1], t[0]);
        wall.begin_step(*s.space, s.active, s.bodies, 0.0, 1.0);
        const Mat<2> gradient = 1e-3 * Vec<2>(0.3, -0.8) * n.transpose();
        const auto u = linear_field(*s.space, gradient, -gradient * at);
        wall.finish(u, 0.0, 1.0);
        const Mat<2> strain = 0.5 * (gradient + gradient.transpose());
        const Vec<2> traction = e.lambda * strain.trace() * n + 2.0 * e.mu * strain * n;
        const Vec<2> held = kind == WallKind::fixed    ? traction
                            : kind == WallKind::roller ? Vec<2>(n.dot(traction) * n)
                                                       : Vec<2>(traction - n.dot(traction) * n);
        const double length = Vec<2>(0.7, 0.2).norm();
        EXPECT_LT((wall.reaction + length * held).norm(), 1e-8 * traction.norm()) << basis.index();
        EXPECT_NEAR(wall.coverage().held, length, 1e-12);
      }
    }
}

TEST(WallsOnTriangles, TheStiffnessIsSymmetricAndActionEqualsReaction) {
  for (const auto& basis : bases()) {
    auto s = scene(basis, true);
    const int n = s.space->n_functions();
    WallOptions o = line({{2.0, 1.3}, {1.1, 1.0}}, WallKind::fixed);
    o.motion = RigidMotionOptions{};
    o.motion->velocity = {Curve(1e-3), Curve(-2e-3)};
    Wall<2> wall(o, {});
    wall.begin_step(*s.space, s.active, s.bodies, 0.0, 1.0);
    BlockMatrix k(2);
    k.begin_pattern(n);
    wall.add_pattern(k);
    k.end_pattern();
    wall.add_stiffness(k);
    EXPECT_TRUE(k.symmetric());
    std::vector<double> force(static_cast<std::size_t>(2 * n), 0.0), ku(force);
    wall.add_force(force);
    const auto u = linear_field(*s.space, (Mat<2>() << 1e-3, 4e-4, -2e-4, 7e-4).finished(), {1e-3, 2e-3});
    k.multiply(u, ku);
    wall.finish(u, 0.0, 1.0);
    Vec<2> sum = wall.reaction;
    for (int i = 0; i < 2 * n; ++i)
      sum[i % 2] += ku[static_cast<std::size_t>(i)] + force[static_cast<std::size_t>(i)];
    EXPECT_LT(sum.norm(), 1e-10 * wall.reaction.norm()) << basis.index();
  }
}

/// The body starts at x = 1; the triangles before it are empty, up to half a metre away they find it.
TEST(WallsOnTriangles, InAnEmptyTriangleTheNextOneAlongTheNormalStandsIn) {
  for (const auto& basis : bases()) {
    auto s = scene(basis, false);
    Wall<2> wall(line({{0.9, 1.9}, {0.9, 1.1}}, WallKind::roller), {});
    wall.begin_step(*s.space, s.active, s.bodies, 0.0, 1.0);
    EXPECT_NEAR(wall.coverage().whole, 0.8, 1e-12);
    EXPECT_NEAR(wall.coverage().held, 0.8, 1e-12);
    EXPECT_NEAR(wall.coverage().extrapolated, 0.8, 1e-12);
    const Mat<2> gradient = (Mat<2>() << 1e-3, 0.0, 0.0, 0.0).finished();
    wall.finish(linear_field(*s.space, gradient, -gradient * Vec<2>(0.9, 0.0)), 0.0, 1.0);
    EXPECT_NEAR(wall.reaction[0], -0.8 * 1e-3 * Elasticity::from(1e6, 0.3).p_wave_modulus(), 1e-5);

    Wall<2> far(line({{0.2, 1.9}, {0.2, 1.1}}, WallKind::roller), {});  // more than a triangle away
    far.begin_step(*s.space, s.active, s.bodies, 0.0, 1.0);
    EXPECT_EQ(far.coverage().held, 0.0);
    EXPECT_NEAR(far.coverage().whole, 0.8, 1e-12);
  }
}

/// A wall outside of the grid beside a body at its edge finds the triangles there; one too far away does not.
TEST(WallsOnTriangles, AWallOutsideOfTheGridFindsTheBodyAtItsEdge) {
  Scene s;
  s.space = std::make_unique<Space<2>>(mesh(false), LinearOptions{});
  s.active.bits.assign(static_cast<std::size_t>(s.space->n_cells()), 1);
  WallPart<2> part;
  part.normal = {1.0, 0.0}, part.host = {-1, 0};
  part.middle = {-0.1, 1.25};
  const auto near = find_host(*s.space, s.active, part);
  ASSERT_TRUE(near.has_value());
  EXPECT_TRUE(near->extrapolated);
  EXPECT_EQ(near->cell[0], s.space->triangulation().locate({0.01, 1.25}));
  part.middle[0] = -0.6;
  EXPECT_FALSE(find_host(*s.space, s.active, part).has_value());
}

}  // namespace
}  // namespace wisp
