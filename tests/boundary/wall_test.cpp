// Walls in implicit steps: cutting at grid lines, the integrals, and what a wall remembers.
#include "boundary/wall.h"

#include <gtest/gtest.h>

#include <numeric>

#include "boundary/samples.h"
#include "core/error.h"

namespace wisp {
namespace {
using boundary_test::scene;

WallOptions line(std::vector<std::vector<double>> vertices, WallKind kind,
                 WallMode mode = WallMode::consistent) {
  WallOptions o;
  o.label = "wall", o.kind = kind, o.mode = mode;
  PolylineWall shape;
  shape.vertices = std::move(vertices);
  o.shape = shape;
  return o;
}

/// Field u = G x + a at the functions.
template <int dim>
std::vector<double> linear_field(const Space<dim>& space, const Mat<dim>& gradient, const Vec<dim>& a) {
  std::vector<double> u(static_cast<std::size_t>(space.n_functions()) * dim);
  for (int i = 0; i < space.n_functions(); ++i)
    Eigen::Map<Vec<dim>>(u.data() + i * dim) = gradient * space.node_position(i) + a;
  return u;
}

BlockMatrix pattern_of(const Wall<2>& wall, int n_functions) {
  BlockMatrix k(2);
  k.begin_pattern(n_functions);
  wall.add_pattern(k);
  k.end_pattern();
  return k;
}

TEST(WallCut, PartsFillTheSegmentAndEachLiesInItsCell) {
  const StructuredGrid<2> grid(std::array<std::vector<double>, 2>{
      std::vector<double>{0.0, 0.4, 1.0, 1.5, 2.0}, std::vector<double>{0.0, 0.7, 1.0, 2.0}});
  for (const auto& [a, b] : {std::pair{Vec<2>(0.1, 0.2), Vec<2>(1.9, 1.7)},
                             {Vec<2>(0.0, 0.0), Vec<2>(1.0, 1.0)},
                             {Vec<2>(1.0, 0.1), Vec<2>(1.0, 1.9)},
                             {Vec<2>(2.0, 0.7), Vec<2>(0.0, 0.7)},
                             {Vec<2>(-0.5, 0.5), Vec<2>(2.5, 0.9)}}) {
    const Vec<2> t = (b - a).normalized(), n(-t[1], t[0]);
    WallCut<2> cut;
    cut_piece<2>(grid, {{a, b}, n}, cut);
    EXPECT_NEAR(std::accumulate(cut.weight.begin(), cut.weight.end(), 0.0), (b - a).norm(), 1e-14);
    for (const auto& part : cut.parts)
      for (std::size_t q = part.first; q < part.first + part.count; ++q)
        for (int d = 0; d < 2; ++d) {
          const int c = part.host[d];
          if (c < 0 || c >= grid.cells(d)) continue;  // beyond the grid, told by its host
          EXPECT_GE(cut.position[q][d], grid.line(d, c) - 1e-12);
          EXPECT_LE(cut.position[q][d], grid.line(d, c + 1) + 1e-12);
        }
  }
}

TEST(WallCut, AlongAGridLineTheHostIsOnTheSolidSide) {
  const StructuredGrid<2> grid({0.0, 0.0}, {2.0, 2.0}, {2, 2});
  for (const bool up : {true, false}) {
    WallCut<2> cut;
    const Vec<2> a(up ? 0.0 : 2.0, 1.0), b(up ? 2.0 : 0.0, 1.0);
    cut_piece<2>(grid, {{a, b}, Vec<2>(0.0, up ? 1.0 : -1.0)}, cut);
    ASSERT_EQ(cut.parts.size(), 2u);
    for (const auto& part : cut.parts) EXPECT_EQ(part.host[1], up ? 1 : 0);
  }
}

TEST(WallCut, TrianglesInSpaceKeepTheirAreaAlsoInGridPlanes) {
  const StructuredGrid<3> grid({0.0, 0.0, 0.0}, {2.0, 2.0, 2.0}, {4, 3, 5});
  for (const auto& v :
       {std::array<Vec<3>, 3>{Vec<3>(0.1, 0.2, 0.3), Vec<3>(1.9, 0.4, 1.1), Vec<3>(0.5, 1.8, 1.7)},
        std::array<Vec<3>, 3>{Vec<3>(0.5, 0.0, 0.0), Vec<3>(0.5, 2.0, 0.0), Vec<3>(0.5, 2.0, 2.0)},
        std::array<Vec<3>, 3>{Vec<3>(0.0, 0.0, 0.8), Vec<3>(2.0, 0.0, 0.8), Vec<3>(2.0, 2.0, 0.8)}}) {
    const Vec<3> e = v[1] - v[0], f = v[2] - v[0];
    const Vec<3> n(e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]);
    WallCut<3> cut;
    cut_piece<3>(grid, {v, n.normalized()}, cut);
    EXPECT_NEAR(std::accumulate(cut.weight.begin(), cut.weight.end(), 0.0), 0.5 * n.norm(), 1e-13);
    EXPECT_GT(cut.parts.size(), 3u);
  }
}

TEST(Wall, BandIntegralsAreExact) {
  const BandIntegrals b = band_integrals(0.3);
  EXPECT_NEAR(b.slope, 1.0, 1e-14);
  EXPECT_NEAR(b.value_slope, 0.5, 1e-14);
  EXPECT_NEAR(b.slope_squared, 4.0 / 0.9, 1e-13);
}

/// The consistent form answers a field that fits the wall by its exact traction, whatever the kind.
TEST(Wall, ALinearFieldThatFitsTheWallGivesItsTraction) {
  auto s = scene<2>(2);
  const ActiveCells active = active_cells(*s.space, s.bodies);
  const Elasticity e = Elasticity::from(1e6, 0.3);
  for (const WallKind kind : {WallKind::fixed, WallKind::roller, WallKind::tangential}) {
    Wall<2> wall(line({{1.9, 1.2}, {1.2, 1.0}}, kind), {});
    const Vec<2> at(1.9, 1.2), t = Vec<2>(-0.7, -0.2).normalized(), n(-t[1], t[0]);
    wall.begin_step(*s.space, active, s.bodies, 0.0, 1.0);
    // u = v (n . (x - at)) vanishes on the wall.
    const Mat<2> gradient = 1e-3 * Vec<2>(0.3, -0.8) * n.transpose();
    const auto u = linear_field<2>(*s.space, gradient, -gradient * at);
    wall.finish(u, 0.0, 1.0);
    const Mat<2> strain = 0.5 * (gradient + gradient.transpose());
    const Vec<2> traction = e.lambda * strain.trace() * n + 2.0 * e.mu * strain * n;
    const Vec<2> held = kind == WallKind::fixed    ? traction
                        : kind == WallKind::roller ? Vec<2>(n.dot(traction) * n)
                                                   : Vec<2>(traction - n.dot(traction) * n);
    const double length = Vec<2>(0.7, 0.2).norm();
    EXPECT_NEAR((wall.reaction + length * held).norm(), 0.0, 1e-9 * traction.norm());
    EXPECT_NEAR(wall.coverage().held, length, 1e-12);
  }
}

TEST(Wall, TheStiffnessIsTheDerivativeOfTheForceAndSymmetric) {
  auto s = scene<2>(2);
  const ActiveCells active = active_cells(*s.space, s.bodies);
  const int n = s.space->n_functions();
  for (const WallMode mode : {WallMode::consistent, WallMode::literal})
    for (const WallKind kind : {WallKind::fixed, WallKind::roller, WallKind::tangential}) {
      WallOptions o = line({{2.0, 1.3}, {1.1, 1.0}}, kind, mode);
      o.delta = 0.1;
      o.motion = RigidMotionOptions{};
      o.motion->velocity = {Curve(1e-3), Curve(-2e-3)};
      Wall<2> wall(o, {});
      wall.begin_step(*s.space, active, s.bodies, 0.0, 1.0);
      BlockMatrix k = pattern_of(wall, n);
      wall.add_stiffness(k);
      EXPECT_TRUE(k.symmetric());
      std::vector<double> force(static_cast<std::size_t>(2 * n), 0.0), ku(force);
      wall.add_force(force);
      const auto u =
          linear_field<2>(*s.space, (Mat<2>() << 1e-3, 4e-4, -2e-4, 7e-4).finished(), {1e-3, 2e-3});
      k.multiply(u, ku);
      wall.finish(u, 0.0, 1.0);
      // Action equals reaction: what the functions give up, the wall gives back.
      Vec<2> sum = wall.reaction;
      for (int i = 0; i < n; ++i)
        for (int d = 0; d < 2; ++d) {
          const auto at = static_cast<std::size_t>(2 * i + d);
          sum[d] += ku[at] + force[at];
        }
      EXPECT_LT(sum.norm(), 1e-10 * wall.reaction.norm());
      // What has gathered is the force at the start of the next step.
      Wall<2> still = wall;
      still.begin_step(*s.space, active, s.bodies, 0.0, 0.0);
      std::vector<double> again(force.size(), 0.0);
      still.add_force(again);
      for (std::size_t at = 0; at < again.size(); ++at)
        EXPECT_NEAR(again[at], ku[at] + force[at], 1e-9 * wall.reaction.norm());
    }
}

TEST(Wall, ARigidMotionWithTheWallCostsNothing) {
  auto s = scene<2>(2);
  const ActiveCells active = active_cells(*s.space, s.bodies);
  WallOptions o = line({{2.0, 1.3}, {1.1, 1.0}}, WallKind::fixed);
  o.motion = RigidMotionOptions{};
  o.motion->displacement = {Curve(), Curve()};
  o.motion->displacement[0].times = {0.0, 1.0}, o.motion->displacement[0].values = {0.0, 0.01};
  Wall<2> wall(o, {});
  wall.begin_step(*s.space, active, s.bodies, 0.0, 1.0);
  wall.finish(linear_field<2>(*s.space, Mat<2>::Zero(), {0.01, 0.0}), 0.0, 1.0);
  EXPECT_LT(wall.reaction.norm(), 1e-8);
}

/// The block starts at x = 1; the cell before it, from 0.4 to 1, is empty.
TEST(Wall, InAnEmptyCellTheNextOneAlongTheNormalStandsIn) {
  auto s = scene<2>(2);
  const ActiveCells active = active_cells(*s.space, s.bodies);
  Wall<2> wall(line({{0.9, 1.9}, {0.9, 1.1}}, WallKind::roller), {});
  wall.begin_step(*s.space, active, s.bodies, 0.0, 1.0);
  EXPECT_NEAR(wall.coverage().whole, 0.8, 1e-12);
  EXPECT_NEAR(wall.coverage().held, 0.8, 1e-12);
  EXPECT_NEAR(wall.coverage().extrapolated, 0.8, 1e-12);
  const Mat<2> gradient = (Mat<2>() << 1e-3, 0.0, 0.0, 0.0).finished();
  wall.finish(linear_field<2>(*s.space, gradient, -gradient * Vec<2>(0.9, 0.0)), 0.0, 1.0);
  EXPECT_NEAR(wall.reaction[0], -0.8 * 1e-3 * Elasticity::from(1e6, 0.3).p_wave_modulus(), 1e-6);

  Wall<2> far(line({{0.2, 1.9}, {0.2, 1.1}}, WallKind::roller), {});  // two cells away
  far.begin_step(*s.space, active, s.bodies, 0.0, 1.0);
  EXPECT_EQ(far.coverage().held, 0.0);
  EXPECT_NEAR(far.coverage().whole, 0.8, 1e-12);
}

TEST(Wall, TheMomentIsAboutTheCentreOfTheMotion) {
  auto s = scene<2>(2);
  const ActiveCells active = active_cells(*s.space, s.bodies);
  Wall<2> wall(line({{1.0, 2.0}, {1.0, 1.0}}, WallKind::roller), {});
  wall.begin_step(*s.space, active, s.bodies, 0.0, 1.0);
  const Mat<2> gradient = (Mat<2>() << 1e-3, 0.0, 0.0, 0.0).finished();
  wall.finish(linear_field<2>(*s.space, gradient, -gradient * Vec<2>(1.0, 0.0)), 0.0, 1.0);
  EXPECT_NEAR(wall.moment[0], -1.5 * wall.reaction[0], 1e-8 * std::abs(wall.reaction[0]));
}

}  // namespace
}  // namespace wisp
