// Points on triangulations: where they lie, how large they are, what is refused.
#include "particle/triangle_sampling.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <numbers>
#include <numeric>

#include "core/error.h"
#include "geometry/ball.h"
#include "grid/powell_sabin_split.h"
#include "grid/triangulate.h"

namespace wisp {
namespace {

Triangulation mesh() {
  PolygonVertices vertices;
  vertices.spacing = 0.5, vertices.irregularity = 0.3;
  return triangulate_polygon(Outline({{{0, 0}, {3, 0}, {3, 2}, {0, 2}}}), vertices);
}

BodyOptions box_body() {
  BodyOptions o;
  o.label = "body", o.shape = Box{{0, 0}, {3, 2}}, o.material = LinearElastic{2.0, 1e3, 0.3};
  return o;
}

double total(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

TEST(TriangleSampling, EvenPointsIntegrateLinearFunctionsExactly) {
  const auto grid = mesh();
  for (const int n : {1, 2, 3, 7}) {
    const auto points = even_points(grid, 4, n);
    ASSERT_EQ(points.size(), static_cast<std::size_t>(n * n));
    Vec<2> mean = Vec<2>::Zero();
    for (const auto& x : points) {
      mean += x / (n * n);
      EXPECT_EQ(grid.locate(x), 4);
    }
    EXPECT_LT((mean - grid.centroid(4)).norm(), 1e-14);
  }
}

TEST(TriangleSampling, EveryMethodFillsTheBody) {
  const auto grid = mesh();
  for (const auto method : {SamplingMethod::cells, SamplingMethod::random, SamplingMethod::divisions})
    for (const auto volumes : {PointVolumes::share, PointVolumes::voronoi}) {
      auto o = box_body();
      o.sampling.method = method, o.sampling.volumes = volumes, o.sampling.points_per_cell = 3;
      if (method == SamplingMethod::divisions) o.sampling.divisions = {12, 9};
      o.velocity = {1.0, 0.0}, o.velocity_gradient = {{0.0, -2.0}, {2.0, 0.0}};
      const auto body = sample(o, grid, 100, {});
      EXPECT_NEAR(total(body.points.volume), 6.0, 1e-11);
      EXPECT_NEAR(total(body.points.mass), 12.0, 1e-11);
      EXPECT_EQ(body.points.size(), method == SamplingMethod::divisions ? 108 : 9 * grid.n_triangles());
      EXPECT_EQ(body.points.id.front(), 100);
      const Vec<2>& x = body.points.position[5];
      EXPECT_LT((body.points.velocity[5] - Vec<2>(1.0 - 2.0 * x[1], 2.0 * x[0])).norm(), 1e-14);
    }
}

/// Volume, first and second moments of a body's points.
std::array<double, 6> moments(const Body<2>& body) {
  std::array<double, 6> m{};
  for (std::size_t p = 0; p < body.points.volume.size(); ++p) {
    const double v = body.points.volume[p], x = body.points.position[p][0], y = body.points.position[p][1];
    const double terms[6] = {1.0, x, y, x * x, x * y, y * y};
    for (std::size_t k = 0; k < 6; ++k) m[k] += v * terms[k];
  }
  return m;
}

TEST(TriangleSampling, GaussPointsIntegrateQuadraticFunctionsOverACutShape) {
  const auto grid = mesh();
  // A square of side 1.2 turned about (1.5, 1): moments about its centre are those of any orientation.
  const double a = 1.2, c = std::cos(0.4), s = std::sin(0.4);
  Polygon square;
  for (const auto& [x, y] : {std::pair{-0.6, -0.6}, {0.6, -0.6}, {0.6, 0.6}, {-0.6, 0.6}})
    square.vertices.push_back({1.5 + c * x - s * y, 1.0 + s * x + c * y});
  auto o = box_body();
  o.shape = square, o.sampling.clip = true;
  const double area = a * a, own = area * a * a / 12.0;
  const double exact[6] = {area, 1.5 * area, area, own + 2.25 * area, 1.5 * area, own + area};
  for (const auto method : {SamplingMethod::cells, SamplingMethod::gauss})
    for (const int n : {1, 2}) {
      o.sampling.method = method, o.sampling.points_per_cell = n;
      const auto found = moments(sample(o, grid, 0, {}));
      for (std::size_t k = 0; k < (method == SamplingMethod::gauss ? 6U : 3U); ++k)
        EXPECT_NEAR(found[k], exact[k], 1e-13) << k;
    }
}

TEST(TriangleSampling, CutsLeaveTheExactArea) {
  const auto grid = mesh();
  auto o = box_body();
  o.sampling.method = SamplingMethod::gauss, o.sampling.points_per_cell = 1;
  o.sampling.cuts = {{0.0, 0.5, 0.0, 1.0}, {1.0, 0.0, 1.0, 0.5}};  // y >= 0.5, x + y/2 >= 1
  // x from 1 - y/2 to 3, y from 0.5 to 2
  EXPECT_NEAR(total(sample(o, grid, 0, {}).points.volume), 2.0 * 1.5 + 0.25 * (4.0 - 0.25), 1e-13);
  o.sampling.cuts = {{0.0, 0.5, 1.0}};
  EXPECT_THROW(sample(o, grid, 0, {}), InputError);
}

TEST(TriangleSampling, GaussPointsOfWholeTrianglesAreInTheirSplit) {
  const auto grid = mesh();
  auto o = box_body();
  o.sampling.method = SamplingMethod::gauss, o.sampling.points_per_cell = 1;
  const auto body = sample(o, grid, 0, {});
  ASSERT_EQ(body.points.size(), 18 * grid.n_triangles());
  const auto found = moments(body);
  const double exact[6] = {6.0, 9.0, 6.0, 18.0, 9.0, 8.0};
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(found[k], exact[k], 1e-12);
  const PowellSabinSplit split(grid);
  for (std::size_t p = 0; p < body.points.position.size(); ++p) {
    const int t = grid.locate(body.points.position[p]);
    EXPECT_EQ(t, static_cast<int>(p) / 18);
    const SplitPoint at = split.locate(t, grid.barycentric(t, body.points.position[p]));
    EXPECT_EQ(2 * at.edge + at.side, static_cast<int>(p) % 18 / 3);
    for (const double share : at.share) EXPECT_NEAR(share, share < 0.4 ? 1.0 / 6.0 : 2.0 / 3.0, 1e-12);
  }
}

TEST(TriangleSampling, RandomPointsDependOnTheSeedAlone) {
  const auto grid = mesh();
  auto o = box_body();
  o.sampling.method = SamplingMethod::random, o.sampling.seed = 4;
  const auto a = sample(o, grid, 0, {}), b = sample(o, grid, 0, {});
  o.sampling.seed = 5;
  const auto c = sample(o, grid, 0, {});
  EXPECT_EQ(a.points.position, b.points.position);
  EXPECT_NE(a.points.position, c.points.position);
  for (std::size_t p = 0; p < a.points.position.size(); ++p)
    EXPECT_EQ(grid.locate(a.points.position[p]), static_cast<int>(p) / 4);
}

TEST(TriangleSampling, VoronoiVolumesOfADiscSumToItsArea) {
  auto o = box_body();
  o.shape = Ball{{1.5, 1.0}, 0.8};
  o.sampling.points_per_cell = 3;
  const double exact = std::numbers::pi * 0.64;
  const auto shares = sample(o, mesh(), 0, {});
  o.sampling.volumes = PointVolumes::voronoi;
  const auto cells = sample(o, mesh(), 0, {});
  EXPECT_NEAR(total(cells.points.volume), exact, 1e-10);
  EXPECT_GT(std::abs(total(shares.points.volume) - exact), 1e-3);  // points count or do not
}

TEST(TriangleSampling, ABodyCanBeASurfaceOfAGmshFile) {
  const auto path = std::filesystem::temp_directory_path() / fmt::format("wisp-body-{}.msh", ::getpid());
  std::ofstream(path)
      << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"left\"\n2 2 \"right\"\n"
         "$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
         "$Elements\n2\n1 2 2 2 1 1 2 3\n2 2 2 1 1 1 3 4\n$EndElements\n";
  auto o = box_body();
  o.shape = MeshShape{path.string(), "left", 2.0};
  const auto body = sample(o, mesh(), 0, {});
  EXPECT_EQ(body.points.size(), 4);
  EXPECT_NEAR(total(body.points.volume), 2.0, 1e-14);
  for (const auto& x : body.points.position) EXPECT_GT(x[1], x[0]);
  o.shape = MeshShape{path.string(), "lfet", 1.0};
  EXPECT_THROW(sample(o, mesh(), 0, {}), InputError);
  o.shape = MeshShape{path.string(), "", 1.0};
  EXPECT_EQ(sample(o, mesh(), 0, {}).points.size(), 8);
  o.sampling.volumes = PointVolumes::voronoi;
  const auto whole = sample(o, mesh(), 0, {});
  EXPECT_NEAR(total(whole.points.volume), 1.0, 1e-13);
  o.shape = MeshShape{path.string(), "left", 2.0};
  const auto cells = sample(o, mesh(), 0, {});
  EXPECT_NEAR(total(cells.points.volume), 2.0, 1e-13);
  // Shares would be equal; the middle one of four even points is nearest to less than the others.
  EXPECT_GT(*std::max_element(cells.points.volume.begin(), cells.points.volume.end()),
            1.05 * *std::min_element(cells.points.volume.begin(), cells.points.volume.end()));
  // Two pieces: the ends of a strip of four triangles, which touch in a vertex or not at all.
  std::ofstream(path)
      << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n5 0 2 0\n"
         "6 1 2 0\n$EndNodes\n$Elements\n4\n1 2 2 1 1 1 2 3\n2 2 2 2 1 2 4 3\n3 2 2 2 1 3 4 5\n"
         "4 2 2 1 1 4 6 5\n$EndElements\n";
  o.shape = MeshShape{path.string(), "physical 1", 1.0};
  EXPECT_THROW(sample(o, mesh(), 0, {}), InputError);
  std::filesystem::remove(path);
}

TEST(TriangleSampling, WhatDoesNotFitIsAnInputError) {
  const auto grid = mesh();
  auto o = box_body();
  o.sampling.method = SamplingMethod::random, o.sampling.clip = true;
  EXPECT_THROW(sample(o, grid, 0, {}), InputError);
  o.sampling.method = SamplingMethod::cells, o.sampling.volumes = PointVolumes::voronoi;
  EXPECT_THROW(sample(o, grid, 0, {}), InputError);
  o = box_body();
  o.shape = Box{{2.5, 1.5}, {4.0, 3.0}};
  o.sampling.method = SamplingMethod::divisions, o.sampling.divisions = {3, 3};
  EXPECT_THROW(sample(o, grid, 0, {}), InputError);
  o = box_body();
  o.shape = Box{{5, 5}, {6, 6}};
  EXPECT_THROW(sample(o, grid, 0, {}), InputError);
}

}  // namespace
}  // namespace wisp
