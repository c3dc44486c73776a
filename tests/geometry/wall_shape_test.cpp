#include "geometry/wall_shape.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <numbers>
#include <set>

#include "geometry/rigid_motion.h"
#include "geometry/stl.h"
#include "scratch.h"

namespace wisp {
namespace {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;

double uniform(double low, double high) {
  return low + (high - low) * *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 1000001)) / 1e6;
}

Block<2> square(double half) { return {Vector2(-half, -half), Vector2(half, half)}; }

/// Sum over the pieces of length (area) times normal: zero for a closed wall; and by the divergence theorem
/// the measure of what it encloses.
template <int dim>
struct Closed {
  Eigen::Matrix<double, dim, 1> sum = Eigen::Matrix<double, dim, 1>::Zero();
  double measure = 0.0, size = 0.0;
};
template <int dim>
Closed<dim> closed(const std::vector<WallPiece<dim>>& pieces) {
  Closed<dim> result;
  for (const auto& piece : pieces) {
    Eigen::Matrix<double, dim, 1> area;
    if constexpr (dim == 2) {
      const Vector2 t = piece.vertex[1] - piece.vertex[0];
      area = Vector2(-t.y(), t.x());
    } else {
      area = 0.5 * (piece.vertex[1] - piece.vertex[0]).cross(piece.vertex[2] - piece.vertex[0]);
    }
    result.sum += area;
    result.size += area.norm();
    result.measure -= area.dot(piece.vertex[0]) / dim;  // inward normals
  }
  return result;
}

/// A closed polygon around the origin with vertices at random radii.
std::vector<std::vector<double>> star(int n) {
  std::vector<std::vector<double>> vertices;
  for (int k = 0; k < n; ++k) {
    const double a = 2.0 * std::numbers::pi * k / n, r = uniform(0.5, 1.5);
    vertices.push_back({r * std::cos(a), r * std::sin(a)});
  }
  return vertices;
}

TEST(WallShape, SegmentHasTheSolidOnItsLeft) {
  const WallShape<2> wall(PolylineWall{{{0, 0}, {2, 0}}});
  const auto pieces = wall.pieces(0.1, square(5));
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0].normal, Vector2(0, 1));
  const auto above = wall.signed_distance({1.0, 0.5});
  EXPECT_DOUBLE_EQ(above.distance, 0.5);
  EXPECT_EQ(above.closest, Vector2(1, 0));
  EXPECT_FALSE(above.beyond);
  EXPECT_DOUBLE_EQ(wall.signed_distance({1.0, -0.5}).distance, -0.5);
  EXPECT_TRUE(wall.signed_distance({-1.0, 0.5}).beyond);
  EXPECT_DOUBLE_EQ(wall.signed_distance({-3.0, 4.0}).distance, 5.0);
  const WallShape<2> right(PolylineWall{{{0, 0}, {2, 0}}, LineSide::right});
  EXPECT_EQ(right.pieces(0.1, square(5))[0].normal, Vector2(0, -1));
  EXPECT_DOUBLE_EQ(right.signed_distance({1.0, -0.5}).distance, 0.5);
}

RC_GTEST_PROP(WallShape, PolygonKnowsItsInside, ()) {
  const Polygon polygon{.vertices = star(*rc::gen::inRange(3, 12))};
  const Outline rings = outline(polygon);
  const WallShape<2> inside(PolygonWall{.vertices = polygon.vertices}),
      outside(PolygonWall{.vertices = polygon.vertices, .solid = SolidSide::outside});
  const auto in = closed<2>(inside.pieces(1.0, square(9))), out = closed<2>(outside.pieces(1.0, square(9)));
  RC_ASSERT(in.sum.norm() < 1e-14 * in.size);
  RC_ASSERT(std::abs(in.measure - rings.area()) < 1e-13);
  RC_ASSERT(std::abs(out.measure + rings.area()) < 1e-13);
  for (int k = 0; k < 20; ++k) {
    const Vector2 x(uniform(-2, 2), uniform(-2, 2));
    const auto d = inside.signed_distance(x);
    RC_ASSERT((d.distance > 0.0) == rings.contains(x));
    RC_ASSERT(std::abs(std::abs(d.distance) - (x - d.closest).norm()) < 1e-14);
    RC_ASSERT((x - d.closest - d.distance * d.normal).norm() < 1e-13);
    RC_ASSERT(std::abs(outside.signed_distance(x).distance + d.distance) < 1e-14);
  }
}

RC_GTEST_PROP(WallShape, DistanceIsTheLeastOverAllPieces, ()) {
  const WallShape<2> wall(PolygonWall{.vertices = star(*rc::gen::inRange(3, 40))});
  const Vector2 x(uniform(-2, 2), uniform(-2, 2));
  double least = 1e9;
  for (const auto& p : wall.pieces(1.0, square(9))) {
    const Vector2 t = p.vertex[1] - p.vertex[0];
    const double s = std::clamp((x - p.vertex[0]).dot(t) / t.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (x - p.vertex[0] - s * t).norm());
  }
  RC_ASSERT(std::abs(std::abs(wall.signed_distance(x).distance) - least) < 1e-14);
}

RC_GTEST_PROP(WallShape, CirclePiecesApproachTheCircleAndDistancesAreExact, ()) {
  const Vector2 c(uniform(-1, 1), uniform(-1, 1));
  const double r = uniform(0.3, 2.0), length = uniform(0.01, 0.5);
  const bool inside = *rc::gen::arbitrary<bool>();
  const WallShape<2> wall(CircleWall{{c.x(), c.y()}, r, inside ? SolidSide::inside : SolidSide::outside});
  const auto pieces = wall.pieces(length, square(9));
  const auto sum = closed<2>(pieces);
  RC_ASSERT(sum.sum.norm() < 1e-13);
  RC_ASSERT(std::abs(std::abs(sum.size) - 2.0 * std::numbers::pi * r) < r * std::pow(length / r, 2.0));
  RC_ASSERT((sum.measure > 0.0) == inside);
  for (const auto& p : pieces) {
    RC_ASSERT((p.vertex[1] - p.vertex[0]).norm() <= length * (1.0 + 1e-12));
    const Vector2 middle = 0.5 * (p.vertex[0] + p.vertex[1]);
    RC_ASSERT((p.normal - wall.signed_distance(middle).normal).norm() < 1e-12);
  }
  const Vector2 x(uniform(-3, 3), uniform(-3, 3));
  RC_ASSERT(std::abs(wall.signed_distance(x).distance - (inside ? 1 : -1) * (r - (x - c).norm())) < 1e-14);
}

RC_GTEST_PROP(WallShape, ArcsThatMakeACircleAgreeWithIt, ()) {
  const double cut = uniform(-180, 180), sweep = uniform(20, 340);
  const WallShape<2> circle(CircleWall{{0.2, 0.1}, 1.0}), one(ArcWall{{0.2, 0.1}, 1.0, cut, cut + sweep}),
      two(ArcWall{{0.2, 0.1}, 1.0, cut + sweep, cut + 360.0});
  const Vector2 x(uniform(-2, 2), uniform(-2, 2));
  const auto d1 = one.signed_distance(x), d2 = two.signed_distance(x), d = circle.signed_distance(x);
  const auto& nearer = std::abs(d1.distance) < std::abs(d2.distance) ? d1 : d2;
  RC_ASSERT(std::abs(nearer.distance - d.distance) < 1e-13);
  RC_ASSERT(d1.beyond != d2.beyond);
  const auto box = one.bounds();
  for (const auto& piece : one.pieces(0.05, square(9)))
    RC_ASSERT((piece.vertex[0].array() >= box.lower.array() - 1e-12).all() &&
              (piece.vertex[0].array() <= box.upper.array() + 1e-12).all());
}

TEST(WallShape, LevelSetOfADiscIsACircleAndOfABoxHasRoundCorners) {
  const WallShape<2> ring(LevelSetWall{{Ball{{0.1, 0.2}, 0.5}}, 0.25});
  const auto pieces = ring.pieces(0.05, square(9));
  const auto sum = closed<2>(pieces);
  EXPECT_LT(sum.sum.norm(), 1e-12);
  EXPECT_NEAR(sum.measure, std::numbers::pi * 0.75 * 0.75, 2e-3);  // chords: (length/r)^2/6 at most
  for (const auto& p : pieces) EXPECT_NEAR((p.vertex[0] - Vector2(0.1, 0.2)).norm(), 0.75, 1e-13);
  const WallShape<2> rounded(LevelSetWall{{Box{{-1, -1}, {1, 1}}}, 0.5, SolidSide::outside});
  EXPECT_NEAR(rounded.signed_distance({1.0 + 3.0, 1.0 + 4.0}).distance, 4.5, 1e-14);
  EXPECT_NEAR(rounded.signed_distance({0.0, 1.2}).distance, -0.3, 1e-14);
  EXPECT_NEAR(-closed<2>(rounded.pieces(0.02, square(9))).measure, 4.0 + 4.0 + std::numbers::pi * 0.25, 1e-3);
}

RC_GTEST_PROP(WallShape, LevelSetOfJoinedDiscsIsClosed, ()) {
  LevelSetWall options;
  for (int k = 0; k < 3; ++k)
    options.shapes.push_back(Ball{{uniform(-1, 1), uniform(-1, 1)}, uniform(0.3, 0.9)});
  const WallShape<2> wall(options);
  const auto sum = closed<2>(wall.pieces(0.1, square(9)));
  RC_ASSERT(sum.sum.norm() < 1e-12);
  RC_ASSERT(sum.measure > 0.0);
}

RC_GTEST_PROP(WallShape, PlanesCutTheBlockInBothDimensions, ()) {
  const double a = uniform(0, 6.28), b = uniform(0.1, 3.0), offset = uniform(-0.9, 0.9);
  const Vector2 n(std::cos(a), std::sin(a));
  const WallShape<2> line(PlaneWall{{offset * n.x(), offset * n.y()}, {3 * n.x(), 3 * n.y()}});
  const auto segments = line.pieces(1.0, square(1));
  RC_ASSERT(segments.size() == 1u);
  for (const auto& v : segments[0].vertex) {
    RC_ASSERT(std::abs(v.dot(n) - offset) < 1e-13);
    RC_ASSERT(std::abs(v.cwiseAbs().maxCoeff() - 1.0) < 1e-13);  // ends on the block's sides
  }
  const Vector3 m(std::cos(a) * std::sin(b), std::sin(a) * std::sin(b), std::cos(b));
  const WallShape<3> plane(
      PlaneWall{{offset * m.x(), offset * m.y(), offset * m.z()}, {m.x(), m.y(), m.z()}});
  const Block<3> cube{-Vector3::Ones(), Vector3::Ones()};
  double area = 0.0;
  for (const auto& p : plane.pieces(1.0, cube)) {
    const Vector3 twice = (p.vertex[1] - p.vertex[0]).cross(p.vertex[2] - p.vertex[0]);
    RC_ASSERT(twice.dot(m) > 0.0);
    area += 0.5 * twice.norm();
    for (const auto& v : p.vertex) RC_ASSERT(std::abs(v.dot(m) - offset) < 1e-13);
  }
  // The area is the derivative of the volume below, counted on a fine lattice only roughly: bounds instead.
  RC_ASSERT(area > 0.0 && area <= 4.0 * std::sqrt(3.0) + 1e-12);
  RC_ASSERT(std::abs(plane.signed_distance(Vector3(0, 0, 0)).distance + offset) < 1e-13);
}

TEST(WallShape, ParallelogramIsTwoTrianglesThatEnd) {
  const WallShape<3> wall(PlaneWall{{0, 0, 0}, {0, 0, 2}, {{0, 1, 0}, {2, 0, 0}}});
  const auto pieces = wall.pieces(1.0, {});
  ASSERT_EQ(pieces.size(), 2u);
  for (const auto& p : pieces) EXPECT_EQ(p.normal, Vector3(0, 0, 1));
  EXPECT_DOUBLE_EQ(wall.signed_distance({1.5, 0.5, -0.3}).distance, -0.3);
  EXPECT_FALSE(wall.signed_distance({1.0, 0.5, -0.3}).beyond);  // on the diagonal
  EXPECT_TRUE(wall.signed_distance({1.0, 1.5, 0.3}).beyond);
  EXPECT_TRUE(wall.signed_distance({2.4, 1.3, 0.3}).beyond);
}

/// A box as STL text, `scale` times the unit cube, without its last `missing` triangles.
std::string cube_text(double scale, int missing = 0, int flipped = -1, bool inside_out = false) {
  static const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  std::string text = "solid cube\n";
  int number = 0;
  for (const auto& q : quads)
    for (const auto& t : {std::array{q[0], q[1], q[2]}, std::array{q[0], q[2], q[3]}}) {
      if (number >= 12 - missing) break;
      text += " facet normal 0 0 0\n  outer loop\n";
      const bool turned = (number++ == flipped) != inside_out;
      for (int k = 0; k < 3; ++k) {
        const int v = t[static_cast<std::size_t>(turned ? 2 - k : k)];
        text +=
            fmt::format("   vertex {} {} {}\n", scale * (v & 1), scale * ((v >> 1) & 1), scale * (v >> 2));
      }
      text += "  endloop\n endfacet\n";
    }
  return text + "endsolid cube\n";
}

std::string binary_of(const Triangles& mesh) {
  std::string bytes(80, 's');
  const auto put = [&](const auto& v) { bytes.append(reinterpret_cast<const char*>(&v), sizeof v); };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) put(0.0f);
    for (const int v : t)
      for (int k = 0; k < 3; ++k) put(static_cast<float>(mesh.vertices[static_cast<std::size_t>(v)][k]));
    put(std::uint16_t{0});
  }
  return bytes;
}

TEST(Stl, TextBinaryAndInsideOutGiveTheSameSurface) {
  const Scratch scratch;
  const auto text = read_stl(scratch.write("cube.stl", cube_text(2.0)));
  EXPECT_EQ(text.vertices.size(), 8u);
  EXPECT_EQ(text.triangles.size(), 12u);
  const auto binary = read_stl(scratch.write("binary.stl", binary_of(text)));
  EXPECT_EQ(binary.triangles, text.triangles);
  EXPECT_EQ(binary.vertices, text.vertices);
  scratch.write("turned.stl", cube_text(2.0, 0, -1, true));
  for (const char* file : {"cube.stl", "binary.stl", "turned.stl"}) {
    const WallShape<3> wall(StlWall{file}, scratch.folder());
    const auto sum = closed<3>(wall.pieces(1.0, {}));
    EXPECT_LT(sum.sum.norm(), 1e-14);
    EXPECT_DOUBLE_EQ(sum.measure, 8.0) << file;
    EXPECT_DOUBLE_EQ(wall.signed_distance({1.0, 1.0, 0.25}).distance, 0.25);
    EXPECT_DOUBLE_EQ(wall.signed_distance({5.0, 6.0, 1.0}).distance, -5.0);
    EXPECT_DOUBLE_EQ(wall.signed_distance({3.0, 3.0, 3.0}).distance, -std::sqrt(3.0));
  }
}

RC_GTEST_PROP(Stl, DistanceToACubeIsThatOfABox, ()) {
  static const Scratch scratch;
  static const WallShape<3> wall = [] {
    scratch.write("cube.stl", cube_text(1.0));
    return WallShape<3>(StlWall{"cube.stl", 2.0, {-1, -1, -1}}, scratch.folder());
  }();
  const Vector3 x(uniform(-2, 2), uniform(-2, 2), uniform(-2, 2));
  const Vector3 q = x.cwiseAbs() - Vector3::Ones();
  const double exact = q.maxCoeff() <= 0.0 ? -q.maxCoeff() : -q.cwiseMax(0.0).norm();
  RC_ASSERT(std::abs(wall.signed_distance(x).distance - exact) < 1e-14);
  RC_ASSERT(!wall.signed_distance(x).beyond);
}

TEST(Stl, EachFaultIsNamed) {
  const Scratch scratch;
  const auto message = [&](const std::string& text) {
    scratch.write("bad.stl", text);
    return message_of([&] { read_stl(scratch.folder() / "bad.stl"); });
  };
  EXPECT_TRUE(says(message_of([&] { read_stl(scratch.folder() / "none.stl"); }), "no such file"));
  EXPECT_TRUE(says(message_of([&] { read_stl(scratch.folder()); }), "found a folder"));
  EXPECT_TRUE(says(message(""), "is empty"));
  EXPECT_TRUE(says(message("hello"), "no STL file"));
  EXPECT_TRUE(says(message("solid nothing\nendsolid\n"), "no triangles"));
  EXPECT_TRUE(says(message(cube_text(1.0, 1)), "has a hole: only triangle"));
  EXPECT_TRUE(says(message(cube_text(1.0, 0, 3)), "flipped against each other"));
  const std::string whole = cube_text(1.0);
  EXPECT_TRUE(says(message(whole.substr(0, whole.size() / 2)), "cut short"));
  EXPECT_TRUE(says(message(whole.substr(0, whole.size() - 15)), "cut short"));
  std::string number = whole;
  number.replace(number.find("vertex 0 0 0"), 12, "vertex 0 x 0");
  EXPECT_TRUE(says(message(number), "bad.stl:4: expected a finite number, found \"x\""));
  scratch.write("cube.stl", whole);
  const std::string binary = binary_of(read_stl(scratch.folder() / "cube.stl"));
  EXPECT_TRUE(says(message(binary.substr(0, binary.size() - 7)),
                   "12 triangles take 684 bytes, but the file has 677"));
  std::string flat = whole;
  flat.replace(flat.find("vertex 1 1 0"), 12, "vertex 0 2 0");
  EXPECT_TRUE(says(message(flat), "has no area"));
}

RC_GTEST_PROP(Stl, AnyTextEitherReadsOrGivesOneLine, ()) {
  const auto pieces = *rc::gen::container<std::vector<std::string>>(rc::gen::element<std::string>(
      "solid x\n", "facet normal 0 0 1 ", "outer loop ", "vertex 0 0 0 ", "vertex 1 0 ", "endloop ",
      "endfacet\n", "endsolid", std::string(90, 'a'), std::string(4, '\0')));
  std::string text;
  for (const auto& piece : pieces) text += piece;
  const Scratch scratch;
  scratch.write("any.stl", text);
  RC_ASSERT(says(message_of([&] { read_stl(scratch.folder() / "any.stl"); }), "any.stl:"));
}

TEST(WallShape, EachFaultIsNamed) {
  const auto flat = [](const AnyWallShape& shape) { return message_of([&] { WallShape<2>{shape}; }); };
  const auto solid = [](const AnyWallShape& shape) { return message_of([&] { WallShape<3>{shape}; }); };
  EXPECT_TRUE(says(flat(PolylineWall{{{0, 0}}}), "1 vertices, expected at least 2"));
  EXPECT_TRUE(says(flat(PolylineWall{{{0, 0}, {1}}}), "vertex 2 has 1 number, expected [x, y]"));
  EXPECT_TRUE(says(flat(PolylineWall{{{0, 0}, {1, 0}, {1, 0}}}), "vertices 2 and 3 are both (1, 0)"));
  EXPECT_TRUE(says(flat(PolylineWall{{{0, 0}, {2, 0}, {2, 1}, {1, -1}}}), "segments 1 and 3 cross or touch"));
  EXPECT_TRUE(says(flat(PolylineWall{{{0, 0}, {2, 0}, {1, 0}}}), "segments 1 and 2 overlap"));
  EXPECT_TRUE(says(flat(PolylineWall{{{0, 0}, {1, 0}, {1, 1}}, LineSide::inside}), "needs a closed line"));
  EXPECT_TRUE(says(flat(PolylineWall{{{0, 0}, {NAN, 0}}}), "expected finite numbers"));
  EXPECT_TRUE(says(flat(CircleWall{{0, 0}, -1.0}), "circle: 'radius' is -1"));
  EXPECT_TRUE(says(flat(ArcWall{{0, 0}, 1.0, 10.0, 5.0}), "expected from < to"));
  EXPECT_TRUE(says(flat(PolygonWall{.vertices = {{0, 0}, {1, 1}, {1, 0}, {0, 1}}}), "polygon"));
  EXPECT_TRUE(says(flat(LevelSetWall{}), "'shapes' is empty"));
  EXPECT_TRUE(says(flat(LevelSetWall{{Ball{{0, 0}, 1.0}}, -2.0}), "nothing is left"));
  EXPECT_TRUE(says(flat(PlaneWall{{0, 0}, {0, 0}}), "'normal' has no length"));
  EXPECT_TRUE(says(flat(PlaneWall{{0, 0}, {0, 1}, {{1, 0}}}), "bound a line in 2D by a polyline"));
  EXPECT_TRUE(says(flat(StlWall{"x.stl"}), "a wall for 3D, but the case is 2D"));
  EXPECT_TRUE(
      says(solid(CircleWall{{0, 0, 0}, 1.0}), "a wall for 2D, but the case is 3D; expected plane or stl"));
  EXPECT_TRUE(says(solid(PlaneWall{{0, 0, 0}, {0, 0, 1}, {{1, 0, 0}}}), "'edges' has 1 vectors"));
  EXPECT_TRUE(says(solid(PlaneWall{{0, 0, 0}, {0, 0, 1}, {{1, 0, 0}, {2, 0, 0}}}), "span no area"));
  EXPECT_TRUE(says(solid(PlaneWall{{0, 0, 0}, {0, 1, 1}, {{1, 0, 0}, {0, 1, 0}}}), "not perpendicular"));
}

TEST(RigidMotion, IntegralsOfCurvesAreExact) {
  Curve c;
  c.times = {1.0, 2.0, 4.0}, c.values = {3.0, 5.0, -1.0};
  EXPECT_DOUBLE_EQ(integral(c, 0.0, 1.0), 3.0);
  EXPECT_DOUBLE_EQ(integral(c, 0.0, 1.5), 3.0 + 0.5 * 3.5);
  EXPECT_DOUBLE_EQ(integral(c, 1.0, 4.0), 4.0 + 4.0);
  EXPECT_DOUBLE_EQ(integral(c, 3.0, 6.0), 0.5 - 2.0);
  EXPECT_DOUBLE_EQ(slope(c, 1.0), 2.0);
  EXPECT_DOUBLE_EQ(slope(c, 3.0), -3.0);
  EXPECT_DOUBLE_EQ(slope(c, 4.0), 0.0);
}

template <int dim>
RigidMotion<dim> random_motion(bool rates) {
  RigidMotionOptions options;
  const auto curve = [] {
    Curve c;
    c.times = {0.0, 0.7, 2.0}, c.values = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    return c;
  };
  auto& translation = rates ? options.velocity : options.displacement;
  for (int d = 0; d < dim; ++d) translation.push_back(curve());
  (rates ? options.angular_velocity : options.rotation) = curve();
  for (int d = 0; d < dim; ++d) options.centre.push_back(uniform(-1, 1));
  if (dim == 3) options.axis = {uniform(-1, 1), uniform(-1, 1), uniform(0.1, 1)};
  return RigidMotion<dim>(options);
}

template <int dim>
void check_motion() {
  const auto motion = random_motion<dim>(*rc::gen::arbitrary<bool>());
  using Vector = Eigen::Matrix<double, dim, 1>;
  Vector a, b;
  for (int d = 0; d < dim; ++d) a[d] = uniform(-2, 2), b[d] = uniform(-2, 2);
  const double t = uniform(0.1, 0.6), dt = 0.05;  // away from the curves' corners
  const Vector xa = motion.position(a, t), xb = motion.position(b, t);
  RC_ASSERT(std::abs((xa - xb).norm() - (a - b).norm()) < 1e-13);
  RC_ASSERT((motion.rest(xa, t) - a).norm() < 1e-13);
  RC_ASSERT((xa + motion.increment(xa, t, dt) - motion.position(a, t + dt)).norm() < 1e-13);
  const double step = 1e-5;
  const Vector difference = (motion.position(a, t + step) - motion.position(a, t - step)) / (2.0 * step);
  RC_ASSERT((motion.velocity(xa, t) - difference).norm() < 1e-8);
}
RC_GTEST_PROP(RigidMotion, IsRigidAndItsVelocityIsTheDerivative2D, ()) { check_motion<2>(); }
RC_GTEST_PROP(RigidMotion, IsRigidAndItsVelocityIsTheDerivative3D, ()) { check_motion<3>(); }

TEST(RigidMotion, EachFaultIsNamed) {
  const auto flat = [](const RigidMotionOptions& o) { return message_of([&] { RigidMotion<2>{o}; }); };
  const auto solid = [](const RigidMotionOptions& o) { return message_of([&] { RigidMotion<3>{o}; }); };
  RigidMotionOptions both;
  both.displacement = both.velocity = {Curve(0.0), Curve(0.0)};
  EXPECT_TRUE(says(flat(both), "either 'displacement' or 'velocity'"));
  EXPECT_TRUE(says(solid({.velocity = {Curve(0.0), Curve(0.0)}}), "'velocity' has 2 entries, expected 3"));
  EXPECT_TRUE(says(flat({.centre = {0, 0}}), "'centre' without 'rotation'"));
  EXPECT_TRUE(says(flat({.rotation = Curve(1.0), .axis = {0, 0, 1}}), "'axis' is for 3D"));
  EXPECT_TRUE(says(solid({.rotation = Curve(1.0)}), "needs 'axis'"));
  EXPECT_TRUE(says(solid({.rotation = Curve(1.0), .axis = {0, 0, 0}}), "'axis' has no length"));
}

TEST(WallOptions, NamesAndKeysAreUniqueAndExplained) {
  std::set<std::string_view> names;
  const auto check = [&]<class Shape>(const Shape&) {
    static_assert(Described<Shape>);
    EXPECT_TRUE(names.insert(Shape::name).second) << Shape::name;
    EXPECT_FALSE(Shape::summary.empty());
    for_each_key<Shape>([&](const auto& k) { EXPECT_FALSE(k.meaning.empty()) << k.name; });
  };
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (check(std::variant_alternative_t<i, AnyWallShape>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<AnyWallShape>>{});
}

}  // namespace
}  // namespace wisp
