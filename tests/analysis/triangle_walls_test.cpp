// Walls on triangulations in quasi-static and dynamic steps: exact states, Newton's rate and tangent,
// reactions.
#include <random>

#include "analysis/triangle_samples.h"
#include "analysis/turned_square.h"
#include "transfer/mass.h"

namespace wisp {
namespace {
using namespace analysis_test;

LinearElastic elastic() {
  LinearElastic law;
  law.young_modulus = 1e6, law.poisson_ratio = 0.3, law.density = 1000.0;
  return law;
}

/// A unit square turned so that its base runs along (0.8, 0.6), points cut at its outline, on an irregular
/// triangulation or on blocks.
ModelOptions square(const AnyLaw& law, const AnyBasisOptions& basis, bool irregular, double h = 0.3) {
  ModelOptions o = irregular ? on_triangles({-1.0, -0.5}, {1.4, 1.9}, h, basis)
                             : on_blocks({-1.0, -0.5}, {1.4, 1.9}, 6, 6, basis);
  BodyOptions body = turned_square(law);
  const bool linear = std::holds_alternative<LinearOptions>(basis);
  body.sampling.method = linear ? SamplingMethod::cells : SamplingMethod::gauss;
  body.sampling.points_per_cell = 1;
  o.bodies.push_back(body);
  return o;
}

const std::vector<AnyBasisOptions>& bases() {
  static const std::vector<AnyBasisOptions> both{LinearOptions{}, PowellSabinOptions{}};
  return both;
}

TEST(TriangleWalls, AContainedSquareIsExact) {
  for (const auto& basis : bases())
    for (const bool irregular : {false, true}) {
      ModelOptions o = square(elastic(), basis, irregular);
      contain(o, 1e-3);
      Model<2> model(o);
      Implicit<2> analysis(model, QuasiStaticOptions{.steps = 1});
      analysis.step(1.0);
      const double modulus = elastic().p_wave_modulus(), strain = -1e-3;
      Mat<2> r, own;
      r << cosine, -sine, sine, cosine;
      own << modulus * strain, 0.0, 0.0, Elasticity::from(1e6, 0.3).lambda * strain;
      const Mat<2> sigma = r * own * r.transpose();
      for_each_point(model, [&](const auto& body, std::size_t p) {
        ASSERT_LT((matrix<2>(stress_of(body, p)) - sigma).norm(), 1e-8 * modulus * 1e-3) << basis.index();
      });
      EXPECT_LT((model.reactions[3] + modulus * 1e-3 * Vec<2>(cosine, sine)).norm(), 1e-9 * modulus * 1e-3);
      EXPECT_LT((model.reactions[0] + model.reactions[3]).norm(), 1e-9 * modulus * 1e-3);
    }
}

/// Between smooth walls and under its own weight along them the square moves by (rho g/M)(L x - x²/2), which
/// quadratic splines have: with points that integrate products of their gradients nothing is left to err.
TEST(TriangleWalls, SplinesReproduceAQuadraticField) {
  for (const bool irregular : {false, true}) {
    ModelOptions o = square(elastic(), PowellSabinOptions{}, irregular);
    add_wall(o, "support", {0, 1}, {0, 0}, WallKind::fixed);
    add_wall(o, "base", {0, 0}, {1, 0}, WallKind::roller);
    add_wall(o, "top", {1, 1}, {0, 1}, WallKind::roller);
    Curve weight = ramp();
    add_gravity(o, {cosine, sine}, weight);
    Model<2> model(o);
    Implicit<2> analysis(model, QuasiStaticOptions{.steps = 1});
    analysis.step(1.0);
    const double scale = 1000.0 / elastic().p_wave_modulus();
    const Vec<2> along(cosine, sine);
    for_each_point(model, [&](const auto& body, std::size_t p) {
      const Vec<2> u = body.points.displacement[p];
      const double x = along.dot(body.points.position[p] - u);
      ASSERT_LT((u - scale * (x - 0.5 * x * x) * along).norm(), 1e-9 * scale);
    });
    EXPECT_LT((model.reactions[0] + 1000.0 * along).norm(), 1e-6);  // the weight
    EXPECT_LT((model.reactions[1] + model.reactions[2]).norm(), 1e-6);
  }
}

TEST(TriangleWalls, FiniteDeformationConvergesQuadratically) {
  for (const auto& basis : bases()) {
    Hencky law;
    law.young_modulus = 1e6, law.poisson_ratio = 0.3, law.density = 1000.0;
    ModelOptions o = square(law, basis, true);
    add_wall(o, "support", {0, 1}, {0, 0}, WallKind::fixed);
    add_wall(o, "press", {1, 0}, {1, 1}, WallKind::fixed).displacement = {ramp(0.1), ramp(0.05)};
    Model<2> model(o);
    QuasiStaticOptions stage;
    stage.steps = 2, stage.tolerance = 1e-9;
    Implicit<2> analysis(model, stage);
    for (int k = 0; k < 2; ++k) {
      const auto record = analysis.step(analysis.time_step());
      const auto& r = record.residuals;
      ASSERT_GE(r.size(), 3U);
      EXPECT_LE(record.iterations, 7) << basis.index();
      EXPECT_LT(r.back(), 1e-2 * r[r.size() - 2]) << basis.index();
    }
    EXPECT_LT((model.reactions[0] + model.reactions[1]).norm(), 1e-6 * model.reactions[0].norm());
  }
}

TEST(TriangleWalls, TheTangentIsTheDerivativeOfTheResidualAtFiniteDeformation) {
  for (const auto& basis : bases()) {
    Hencky law;
    law.young_modulus = 1e6, law.poisson_ratio = 0.3, law.density = 1000.0;
    ModelOptions o = square(law, basis, true, 0.4);
    add_wall(o, "support", {0, 1}, {0, 0}, WallKind::fixed);
    Model<2> model(o);
    auto& wall = std::get<Wall<2>>(model.boundaries[0]);
    const auto cells = active_cells(*model.space, model.bodies);
    wall.begin_step(*model.space, cells, model.bodies, 0.0, 1.0);
    BlockMatrix fixed(2), tangent(2);
    fixed.begin_pattern(model.space->n_functions());
    add_point_pattern(*model.space, model.bodies, fixed);
    wall.add_pattern(fixed);
    fixed.end_pattern();
    wall.add_stiffness(fixed);
    tangent.share_pattern(fixed);
    StoredStencils<2> stencils;
    tabulate(*model.space, model.bodies[0].points, stencils);
    const auto n = static_cast<std::size_t>(model.space->n_functions()) * 2;
    const auto residual = [&](const std::vector<double>& u) {
      std::vector<double> r(n, 0.0);
      fixed.multiply(u, r);
      wall.add_force(r);
      add_internal_force(stencils, model.bodies[0], u, 1.0, r);
      return r;
    };
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    std::vector<double> u(n), direction(n), ahead(n), behind(n), product(n);
    for (std::size_t i = 0; i < n; i += 2) {  // a stretch of a fifth, and unevenness
      const Vec<2> x = model.space->node_position(static_cast<int>(i / 2));
      u[i] = 0.2 * x[0] + 0.1 * x[1] + 0.005 * any(random), u[i + 1] = -0.15 * x[1] + 0.005 * any(random);
      direction[i] = any(random), direction[i + 1] = any(random);
    }
    constexpr double step = 1e-6;
    for (std::size_t i = 0; i < n; ++i)
      ahead[i] = u[i] + step * direction[i], behind[i] = u[i] - step * direction[i];
    const auto plus = residual(ahead), minus = residual(behind);
    residual(u);  // leaves the trial states that the tangent needs
    add_stiffness(stencils, model.bodies[0], u, 1.0, tangent);
    tangent.add_matrix(1.0, fixed);
    tangent.multiply(direction, product);
    double error = 0.0, norm = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double difference = (plus[i] - minus[i]) / (2.0 * step);
      error += std::pow(difference - product[i], 2), norm += std::pow(product[i], 2);
    }
    EXPECT_LT(std::sqrt(error / norm), 1e-7) << basis.index();
  }
}

TEST(TriangleWalls, ImplicitDynamicsFollowsAMovingWall) {
  for (const auto& basis : bases()) {
    ModelOptions o = square(elastic(), basis, true);
    auto& wall = add_wall(o, "carrier", {0, 0}, {1, 0}, WallKind::fixed);
    wall.motion = RigidMotionOptions{};
    wall.motion->velocity = {Curve(0.1), Curve(0.0)};
    o.bodies[0].velocity = {0.1, 0.0};
    Model<2> model(o);
    ImplicitDynamicOptions stage;
    stage.duration = 0.2, stage.steps = 4;
    Implicit<2> analysis(model, stage);
    for (int k = 0; k < 4; ++k) analysis.step(analysis.time_step());
    EXPECT_LT(model.reactions[0].norm(), 1e-4) << basis.index();
    for (const auto& u : model.bodies[0].points.displacement)
      EXPECT_LT((u - Vec<2>(0.02, 0.0)).norm(), 1e-8) << basis.index();
  }
}

/// A press goes through whole triangles: they become empty, neighbours stand in, and what it has gathered
/// goes along. Between smooth walls the compression is uniform, tau = M ln(1 - 0.3), on a height of 1.
TEST(TriangleWalls, AWallThatMovesThroughTrianglesKeepsHolding) {
  for (const auto& basis : bases()) {
    Hencky law;
    law.young_modulus = 1e6, law.poisson_ratio = 0.3, law.density = 1000.0;
    ModelOptions o = square(law, basis, true);
    o.bodies[0].sampling.points_per_cell = 3;
    add_wall(o, "left", {0, 1}, {0, 0}, WallKind::roller);
    add_wall(o, "base", {0, 0}, {1, 0}, WallKind::roller);
    add_wall(o, "top", {1, 1}, {0, 1}, WallKind::roller);
    auto& press = add_wall(o, "press", {1, 0}, {1, 1}, WallKind::roller);
    press.motion = RigidMotionOptions{};
    press.motion->displacement = {ramp(-0.3 * cosine), ramp(-0.3 * sine)};
    Model<2> model(o);
    Implicit<2> analysis(model, QuasiStaticOptions{.steps = 10});
    const Vec<2> along(cosine, sine);
    double extrapolated = 0.0;
    for (int k = 1; k <= 10; ++k) {
      analysis.step(analysis.time_step());
      const auto& wall = std::get<Wall<2>>(model.boundaries[3]);
      EXPECT_NEAR(wall.coverage().held, 1.0, 1e-9) << basis.index() << ", step " << k;
      extrapolated += wall.coverage().extrapolated;
      // Cut points may begin next to the wall, which holds the mean of a part: a hundredth of a triangle's
      // side.
      double farthest = 0.0;
      for (const auto& x : model.bodies[0].points.position) farthest = std::max(farthest, along.dot(x));
      EXPECT_LT(farthest, 1.0 - 0.03 * k + 0.01 * 0.3) << basis.index() << ", step " << k;
      EXPECT_LT((model.reactions[0] + model.reactions[3]).norm(), 1e-6 * model.reactions[3].norm());
      const double stretch = 1.0 - 0.03 * k, exact = law.p_wave_modulus() * std::log(stretch) / stretch;
      EXPECT_NEAR(model.reactions[3].dot(along), exact, 0.03 * std::abs(exact))
          << basis.index() << ", step " << k;
    }
    EXPECT_GT(extrapolated, 0.0) << basis.index();
  }
}

}  // namespace
}  // namespace wisp
