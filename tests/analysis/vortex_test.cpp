// The generalised vortex: a manufactured motion of large rotation and shear with its body force.
#include "analysis/fixtures.h"

namespace wisp {
namespace {

using namespace analysis_test;

/// x = Q(alpha) X with alpha = g(t) H(R), H = 1 - 32 (R-1)^2 + 256 (R-1)^4 on 3/4 < R < 5/4 and 0 elsewhere
/// (Kamojjala et al. 2015), g = A sin(pi t). Rings slide on each other: F = Q (I + s e_theta (x) e_R) with
/// the shear s = g R H', so J = 1 and for Hencky's law tau = mu ln b, in closed form.
struct Vortex {
  double mu = 1000.0, rho = 1000.0, amplitude = 0.15;

  static double shape(double r) {
    const double x = r - 1.0;
    return std::abs(x) < 0.25 ? 1.0 - 32.0 * x * x + 256.0 * x * x * x * x : 0.0;
  }
  static double slope(double r) {
    const double x = r - 1.0;
    return std::abs(x) < 0.25 ? -64.0 * x + 1024.0 * x * x * x : 0.0;
  }
  double g(double t) const { return amplitude * std::sin(M_PI * t); }

  /// Stress (rr, theta theta, r theta) on the ring of radius r: ln b = k (b - (1 + s^2/2) I) for det b = 1.
  Vec<3> stress(double r, double t) const {
    const double s = g(t) * r * slope(r);
    const double k =
        std::abs(s) < 1e-8 ? 1.0 : 2.0 * std::asinh(0.5 * s) / (s * std::sqrt(1.0 + 0.25 * s * s));
    return mu * k * Vec<3>(-0.5 * s * s, 0.5 * s * s, s);
  }
  Vec<2> position(const Vec<2>& start, double t) const {
    const double alpha = g(t) * shape(start.norm());
    return {std::cos(alpha) * start[0] - std::sin(alpha) * start[1],
            std::sin(alpha) * start[0] + std::cos(alpha) * start[1]};
  }
  Vec<2> start_velocity(const Vec<2>& start) const {
    return amplitude * M_PI * shape(start.norm()) * Vec<2>(-start[1], start[0]);
  }
  /// b = a - div(sigma)/rho in polar coordinates at the present position.
  Vec<2> body_acceleration(const Vec<2>& start, double t) const {
    const double r = start.norm();
    if (std::abs(r - 1.0) >= 0.25) return Vec<2>::Zero();
    const double rate = amplitude * M_PI * std::cos(M_PI * t) * shape(r),
                 change = -M_PI * M_PI * g(t) * shape(r);
    const double step = 1e-6;
    const Vec<3> sigma = stress(r, t), d = (stress(r + step, t) - stress(r - step, t)) / (2 * step);
    const double radial = -r * rate * rate - (d[0] + (sigma[0] - sigma[1]) / r) / rho;
    const double around = r * change - (d[2] + 2.0 * sigma[2] / r) / rho;
    const Vec<2> e = position(start, t) / r;
    return radial * e + around * Vec<2>(-e[1], e[0]);
  }
};

/// Root mean square of the points' distance from their exact place at t = 1/2, the greatest turn.
double error(int n, MassKind kind, StressUpdate scheme) {
  const Vortex vortex;
  auto o = on_grid<2>({-1.5, -1.5}, {1.5, 1.5}, {n, n}, true);
  const double E = 2.0 * vortex.mu * 1.3;
  add_box<2>(o, {-1.5, -1.5}, {1.5, 1.5}, Hencky{vortex.rho, E, 0.3});
  for (const double side : {-1.5, 1.5}) hold(o, "x", side, "xy"), hold(o, "y", side, "xy");
  const Mass mass = apply(kind, o);
  Model<2> model(o);
  auto& points = model.bodies[0].points;
  for (std::size_t p = 0; p < points.position.size(); ++p)
    points.velocity[p] = vortex.start_velocity(points.position[p]);
  model.body_acceleration = [&](const Vec<2>& start, double t) { return vortex.body_acceleration(start, t); };
  const int steps = 2 * n;
  Explicit<2> run(model, explicit_steps(0.5 / steps, mass, scheme));
  for (int k = 0; k < steps; ++k) run.step(0.5 / steps);
  double sum = 0.0;
  for (std::size_t p = 0; p < points.position.size(); ++p)
    sum += (points.position[p] - vortex.position(points.position[p] - points.displacement[p], 0.5))
               .squaredNorm();
  return std::sqrt(sum / static_cast<double>(points.size()));
}

TEST(Vortex, ClosedFormStressIsHenckys) {
  const Vortex vortex;
  const Hencky law{vortex.rho, 2.0 * vortex.mu * 1.3, 0.3};
  const double r = 0.9, s = vortex.g(0.5) * r * Vortex::slope(r);
  Mat<2> F = Mat<2>::Identity();
  F(1, 0) = s;  // axes (r, theta)
  Hencky::State<2> state;
  law.stress<2>(Kinematics<2>{F, 0.0}, state, state);
  const Vec<3> exact = vortex.stress(r, 0.5);
  EXPECT_NEAR(state.stress[0], exact[0], 1e-9);
  EXPECT_NEAR(state.stress[1], exact[1], 1e-9);
  EXPECT_NEAR(state.stress[3], exact[2], 1e-9);
}

TEST(Vortex, ConvergesUnderRefinement) {
  const auto converges = [](MassKind kind, StressUpdate scheme) {
    // GIMP converges between the first and the second order (Coombs 2023, section 5.4); 1.2 to 1.5 is seen
    // here.
    const double coarse = error(16, kind, scheme), middle = error(32, kind, scheme),
                 fine = error(64, kind, scheme);
    EXPECT_GT(order(coarse, middle), 1.0) << coarse << " " << middle << " " << fine;
    EXPECT_GT(order(middle, fine), 1.2) << coarse << " " << middle << " " << fine;
    EXPECT_LT(fine, 0.004);
  };
  converges(MassKind::lumped, StressUpdate::usl);
  converges(MassKind::lumped, StressUpdate::musl);
  converges(MassKind::ghost, StressUpdate::usl);
}

}  // namespace
}  // namespace wisp
