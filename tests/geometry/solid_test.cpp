// Solids from triangulated surfaces: inside, volume, and boxes cut at them, against convex polyhedra cut by
// planes.
#include "geometry/solid.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>

#include "geometry/clip.h"
#include "scratch.h"

namespace wisp {
namespace {

using Vector = Eigen::Vector3d;

double uniform(double low, double high) {
  return low + (high - low) * *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 1000001)) / 1e6;
}

/// A tetrahedron of four random points, normals outwards.
Triangles tetrahedron() {
  Triangles mesh;
  for (int k = 0; k < 4; ++k) mesh.vertices.emplace_back(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
  const auto& v = mesh.vertices;
  const double volume = (v[1] - v[0]).dot((v[2] - v[0]).cross(v[3] - v[0])) / 6.0;
  RC_PRE(std::abs(volume) > 1e-2);
  if (volume > 0.0)
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  else
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 3}};
  return mesh;
}

RC_GTEST_PROP(Solid, ATetrahedronIsCutAsByItsPlanes, ()) {
  const Solid solid(tetrahedron());
  std::vector<HalfSpace<3>> planes;
  for (int f = 0; f < 4; ++f) {
    const auto piece = solid.surface().piece(f);
    planes.push_back({piece.vertex[0], -piece.normal});
  }
  const Vector lower(uniform(-1, 0), uniform(-1, 0), uniform(-1, 0)),
      upper = lower + Vector(uniform(0.1, 1.5), uniform(0.1, 1.5), uniform(0.1, 1.5));
  const auto ours = clip_box<3>(solid, {}, lower, upper),
             planar = clip_box<3>(Block<3>{lower, upper}, planes, lower, upper);
  const double whole = (upper - lower).prod();
  RC_ASSERT(std::abs(ours.volume - planar.volume) < 1e-12 * whole);
  if (planar.volume > 1e-6 * whole) RC_ASSERT((ours.centroid - planar.centroid).norm() < 1e-8);
  for (int k = 0; k < 10; ++k) {
    const Vector x(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    bool inside = true;
    for (const auto& plane : planes) inside &= (x - plane.point).dot(plane.normal) >= 0.0;
    RC_ASSERT(solid.contains(x) == inside);
  }
}

RC_GTEST_PROP(Solid, PartsInBoxesThatTileSumToTheWhole, ()) {
  // Not convex: two tetrahedra side by side.
  Triangles mesh = tetrahedron(), other = tetrahedron();
  for (auto& x : other.vertices) mesh.vertices.push_back(x + Vector(2.5, 0, 0));
  for (auto t : other.triangles) mesh.triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
  const Solid solid(mesh);
  const double h = uniform(0.3, 0.9);
  double sum = 0.0;
  Vector first = Vector::Zero();
  for (double x = -1.2; x < 3.7; x += h)
    for (double y = -1.2; y < 1.2; y += h)
      for (double z = -1.2; z < 1.2; z += h) {
        const auto part = clip_box<3>(solid, {}, {x, y, z}, {x + h, y + h, z + h});
        sum += part.volume, first += part.volume * part.centroid;
      }
  RC_ASSERT(std::abs(sum - solid.volume()) < 1e-12);
  Vector exact = Vector::Zero();
  for (std::size_t k = 0; k < 2; ++k) {
    Vector mean = Vector::Zero();
    for (std::size_t v = 0; v < 4; ++v) mean += 0.25 * solid.surface().vertices()[4 * k + v];
    const auto& v = solid.surface().vertices();
    exact +=
        mean *
        std::abs((v[4 * k + 1] - v[4 * k]).dot((v[4 * k + 2] - v[4 * k]).cross(v[4 * k + 3] - v[4 * k]))) /
        6.0;
  }
  RC_ASSERT((first - exact).norm() < 1e-11);
}

/// A prism over an L: not convex, faces along the grid.
Triangles angle_iron() {
  Triangles mesh;
  const std::array<Eigen::Vector2d, 6> l{{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}}};
  for (const double z : {0.0, 2.0})
    for (const auto& x : l) mesh.vertices.emplace_back(x.x(), x.y(), z);
  for (const auto& [a, b, c] : {std::array{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}}) {
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({a + 6, b + 6, c + 6});
  }
  for (int k = 0; k < 6; ++k) {
    const int n = (k + 1) % 6;
    mesh.triangles.push_back({k, n, n + 6});
    mesh.triangles.push_back({k, n + 6, k + 6});
  }
  return mesh;
}

RC_GTEST_PROP(Solid, TwoSidesOfAPlaneMakeTheWhole, ()) {
  const Solid solid(angle_iron());
  RC_ASSERT(std::abs(solid.volume() - 8.0) < 1e-14);
  const Vector lower(uniform(-0.5, 2.5), uniform(-0.5, 1.5), uniform(-0.5, 1.5)),
      upper = lower + Vector(uniform(0.1, 3.0), uniform(0.1, 2.0), uniform(0.1, 2.0));
  // The box around the L by the two boxes that it consists of.
  const auto in = [&](const Vector& a, const Vector& b) {
    return (upper.cwiseMin(b) - lower.cwiseMax(a)).cwiseMax(0.0).prod();
  };
  const double exact = in({0, 0, 0}, {3, 1, 2}) + in({0, 1, 0}, {1, 2, 2}), whole = (upper - lower).prod();
  const auto all = clip_box<3>(solid, {}, lower, upper);
  RC_ASSERT(std::abs(all.volume - exact) < 1e-12 * whole);
  Vector normal(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
  RC_PRE(normal.norm() > 0.1);
  const Vector point =
      lower + Vector(uniform(0, 1), uniform(0, 1), uniform(0, 1)).cwiseProduct(upper - lower);
  const auto front = clip_box<3>(solid, {{point, normal}}, lower, upper),
             back = clip_box<3>(solid, {{point, -normal}}, lower, upper);
  RC_ASSERT(std::abs(front.volume + back.volume - exact) < 1e-11 * whole);
  RC_ASSERT((front.volume * front.centroid + back.volume * back.centroid - all.volume * all.centroid).norm() <
            1e-11 * whole * (1.0 + upper.norm()));
  if (front.volume > 1e-3 * whole) RC_ASSERT((front.centroid - point).dot(normal) > -1e-9);
}

TEST(Solid, IsRefusedIn2DAndWhereTheFileIsFaulty) {
  EXPECT_TRUE(says(message_of([] { region<2>(AnyShape(StlSolid{"x.stl"})); }), "a shape for 3D"));
  EXPECT_TRUE(says(message_of([] { region<3>(AnyShape(StlSolid{"none.stl"})); }), "no such file"));
}

}  // namespace
}  // namespace wisp
