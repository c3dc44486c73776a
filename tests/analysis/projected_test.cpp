// The thesis's step, written a second time with dense matrices from its figure 2.5.
#include <Eigen/Cholesky>

#include "analysis/fixtures.h"

namespace wisp {
namespace {

using namespace analysis_test;

/// Uniaxial strain along x on unit cells [0, n], held at both ends; nu = 0. One entry a point.
struct DenseBar {
  int n;
  double E, g;
  std::vector<double> x, v, m, volume, sigma;

  std::pair<int, double> place(double at) const {
    const int c = std::min(static_cast<int>(at), n - 1);
    return {c, at - c};
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const {
    Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n + 1, n + 1);
    for (std::size_t p = 0; p < x.size(); ++p) {
      const auto [c, r] = place(x[p]);
      const Eigen::Vector2d phi(1.0 - r, r);
      mass.block<2, 2>(c, c) += m[p] * phi * phi.transpose();
    }
    Eigen::VectorXd result = Eigen::VectorXd::Zero(n + 1);
    result.segment(1, n - 1) = mass.block(1, 1, n - 1, n - 1).ldlt().solve(b.segment(1, n - 1));
    return result;
  }
  void step(double dt) {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(n + 1), momentum = force;
    for (std::size_t p = 0; p < x.size(); ++p) {
      const auto [c, r] = place(x[p]);
      force[c] += volume[p] * sigma[p] + m[p] * g * (1.0 - r);
      force[c + 1] += -volume[p] * sigma[p] + m[p] * g * r;
    }
    const Eigen::VectorXd a = solve(force);
    for (std::size_t p = 0; p < x.size(); ++p) {
      const auto [c, r] = place(x[p]);
      v[p] += dt * ((1.0 - r) * a[c] + r * a[c + 1]);
      momentum[c] += m[p] * v[p] * (1.0 - r), momentum[c + 1] += m[p] * v[p] * r;
    }
    const Eigen::VectorXd w = solve(momentum);
    for (std::size_t p = 0; p < x.size(); ++p) {
      const auto [c, r] = place(x[p]);
      const double strain = dt * (w[c + 1] - w[c]);
      sigma[p] += E * strain - strain * sigma[p];
      volume[p] *= 1.0 + strain;
      x[p] += dt * ((1.0 - r) * w[c] + r * w[c + 1]);
    }
  }
};

TEST(ProjectedStep, IsTheThesissFigure) {
  constexpr int n = 6;
  const double E = 50.0, rho = 2.0, g = 0.7;
  auto o = on_grid<2>({0, 0}, {n, 1}, {n, 1}, false);
  add_box<2>(o, {0, 0}, {n, 1}, JaumannElastic{rho, E, 0.0}, 3);
  hold(o, "x", 0.0, "x"), hold(o, "x", n, "x"), hold(o, "y", 0.0, "y"), hold(o, "y", 1.0, "y");
  add_gravity(o, {g, 0.0});
  Model<2> model(o);
  auto& points = model.bodies[0].points;
  // Points of the three rows move alike: one of them stands for all.
  DenseBar bar{n, E, g, {}, {}, {}, {}, {}};
  std::vector<std::int64_t> ids;
  for (std::size_t p = 0; p < points.position.size(); ++p) {
    const double x = points.position[p][0];
    points.velocity[p] = {0.8 * std::sin(M_PI * x / n) + 0.1 * x, 0.0};
    if (std::abs(points.position[p][1] - 0.5) > 0.1) continue;
    ids.push_back(points.id[p]);
    bar.x.push_back(x), bar.v.push_back(points.velocity[p][0]), bar.m.push_back(3.0 * points.mass[p]);
    bar.volume.push_back(3.0 * points.volume[p]), bar.sigma.push_back(0.0);
  }
  ASSERT_EQ(bar.x.size(), 18U);
  const double dt = 0.02;
  Explicit<2> run(model, explicit_steps(dt, Mass::consistent, StressUpdate::projected));
  for (int k = 0; k < 15; ++k) run.step(dt), bar.step(dt);
  double moved = 0.0;
  for (std::size_t q = 0; q < ids.size(); ++q) {
    const auto p =
        static_cast<std::size_t>(std::find(points.id.begin(), points.id.end(), ids[q]) - points.id.begin());
    EXPECT_NEAR(points.position[p][0], bar.x[q], 1e-10);
    EXPECT_NEAR(points.velocity[p][0], bar.v[q], 1e-9);
    const double ratio = bar.volume[q] / (3.0 * points.volume[p]);
    EXPECT_NEAR(stress_of(model.bodies[0], p)[0] / ratio, bar.sigma[q], 1e-8);
    moved = std::max(moved, std::abs(points.displacement[p][0]));
  }
  EXPECT_GT(moved, 0.1) << "the volumetric term counts";
}

TEST(ProjectedStep, MovesPointsByTheVelocityThatStrainsThem) {
  // On linear functions v = x is reproduced: after a step, F and the positions tell the same stretch.
  auto o = on_grid<2>({0, 0}, {4, 4}, {4, 4}, false);
  add_box<2>(o, {1, 1}, {3, 3}, Hencky{1.0, 1.0, 0.0});
  o.bodies[0].velocity_gradient = {{0.3, 0.1}, {-0.2, 0.05}};
  Model<2> model(o);
  Explicit<2> run(model, explicit_steps(0.1, Mass::consistent, StressUpdate::projected));
  run.step(0.1);
  Mat<2> expected;
  expected << 1.03, 0.01, -0.02, 1.005;
  for_each_point(model, [&](const auto& body, std::size_t p) {
    EXPECT_LT((body.points.deformation_gradient[p] - expected).norm(), 1e-10);
    const Vec<2> start = body.points.position[p] - body.points.displacement[p];
    EXPECT_LT((body.points.displacement[p] - (expected - Mat<2>::Identity()) * start).norm(), 1e-10);
  });
}

}  // namespace
}  // namespace wisp
