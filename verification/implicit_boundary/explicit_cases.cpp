#include "verification/implicit_boundary/explicit_cases.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace wisp::explicit_walls {

namespace {

/// Courant number. Points at the thin edges of a block that slides far are lost with linear functions at 0.4.
/// A wave crosses triangles along their height.
double courant(const Variant& variant) {
  switch (variant.functions) {
    case Functions::linear:
      return 0.2;
    case Functions::gimp:
      return 0.4;
    case Functions::linear_triangles:
      return 0.14;
    case Functions::powell_sabin:
      return 0.28;
  }
  return 0.0;
}

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

/// From 0 at time 0 to 1 at `end`.
Curve ramp(double end) {
  Curve c;
  c.times = {0.0, end}, c.values = {0.0, 1.0};
  return c;
}

void add_gravity(Scene& scene, const Vec<2>& direction, const Curve& factor) {
  scene.options.gravity = GravityOptions{{gravity * direction[0], gravity * direction[1]}, factor};
}

/// Slope of the straight line through (x, y) by least squares.
class Line {
 public:
  void add(double x, double y) { n_ += 1.0, x_ += x, y_ += y, xx_ += x * x, xy_ += x * y; }
  double slope() const { return (n_ * xy_ - x_ * y_) / (n_ * xx_ - x_ * x_); }

 private:
  double n_ = 0.0, x_ = 0.0, y_ = 0.0, xx_ = 0.0, xy_ = 0.0;
};

}  // namespace

Slide slide(const Variant& variant, double friction) {
  constexpr double modulus = 1e6, duration = 1.0, rise = 0.3;
  Scene scene = block(variant, 30.0, 1.0, 0.5, modulus);
  wall(scene, friction);
  add_gravity(scene, {0.0, -1.0}, ramp(rise));
  Run run(scene, explicit_options(variant, duration, time_step(modulus, courant(variant))));
  Slide result;
  Line line;
  Vec<2> impulses = Vec<2>::Zero();
  double before = 0.0, worst = 0.0;
  const double mass = run.mass();
  run.go(friction > 0.0 ? duration : 0.6, [&] {
    const double now = run.model().time, dt = now - before;
    impulses += dt * (run.model().reactions[0] + mass * run.model().gravity(before));
    before = now;
    worst = std::max(worst, (run.momentum() - impulses).norm());
    if (now > 0.4) line.add(now, run.momentum().dot(scene.along) / mass);
  });
  result.acceleration =
      line.slope() / (gravity * (std::sin(radians(30.0)) - friction * std::cos(radians(30.0))));
  result.imbalance = worst / run.momentum().norm();
  return result;
}

Stick stick(const Variant& variant) {
  constexpr double modulus = 1e6;
  Scene scene = block(variant, 30.0, 1.0, 0.5, modulus);
  wall(scene, 0.7);
  add_gravity(scene, {0.0, -1.0}, ramp(0.5));
  const double dt = time_step(modulus, courant(variant));
  Run run(scene, explicit_options(variant, 1.0, dt, 0.3));
  run.go(variant.functions == Functions::powell_sabin ? 8.0 : 2.0);
  run.change(explicit_options(variant, 1.0, dt));
  const auto place = [&] { return run.mean_displacement().dot(scene.along) / variant.side(); };
  const double start = place();
  run.go(1.0);
  const double first = place();
  run.go(1.0);
  return {std::abs(first - start), std::abs(place() - start)};
}

Rest rest(const Variant& variant) {
  constexpr double modulus = 1e6, degrees = 20.0;
  const double dt = time_step(modulus, courant(variant));
  Rest result;
  {
    Scene scene = block(variant, degrees, 0.6, 0.6, modulus);
    wall(scene, 0.0);
    add_gravity(scene, -scene.up, ramp(0.5));
    Run run(scene, explicit_options(variant, 1.0, dt, 0.3));
    run.go(2.0);
    run.change(explicit_options(variant, 1.0, dt));
    const auto height = [&] { return run.mean_displacement().dot(scene.up) / cell; };
    const auto lowest = [&] {
      double least = std::numeric_limits<double>::max();
      for (const auto& x : run.model().bodies[0].points.position)
        least = std::min(least, (x - scene.foot).dot(scene.up));
      return least / cell;
    };
    const double start = height(), low = lowest();
    double force = 0.0;
    int steps = 0;
    run.go(1.0, [&] { force += run.model().reactions[0].dot(scene.up), ++steps; });
    result.drift = std::abs(height() - start), result.lowest = std::abs(lowest() - low);
    result.force = force / steps / (run.mass() * gravity);
  }
  Scene scene = block(variant, degrees, 0.6, 0.6, modulus);
  wall(scene, 0.0);
  add_gravity(scene, -scene.up, Curve(1.0));
  Run run(scene, explicit_options(variant, 1.0, dt));
  run.go(1.0, [&] { result.jump = std::max(result.jump, run.mean_displacement().dot(scene.up) / cell); });
  return result;
}

double rebound(const Variant& variant, double degrees, int cells) {
  constexpr double modulus = 1e6;
  const double size = cells * cell;
  const bool mirrored = degrees < 0.0;
  Scene scene = block(variant, std::max(degrees, 0.0), size, size, modulus, 2, 0.3 * cell);
  scene.options.bodies[0].velocity = {-scene.up[0], -scene.up[1]};
  if (mirrored) {
    BodyOptions image = scene.options.bodies[0];
    image.label = "image";
    image.shape = block(variant, 180.0, size, size, modulus, 2, 0.3 * cell).options.bodies[0].shape;
    image.velocity = {scene.up[0], scene.up[1]};
    scene.options.bodies.push_back(image);
  } else {
    wall(scene, 0.0);
  }
  Run run(scene, explicit_options(variant, 1.0, time_step(modulus, courant(variant))));
  double most = 0.0;
  run.go(0.05 * cells, [&] { most = std::max(most, run.momentum().dot(scene.up) / run.mass()); });
  return most;
}

double push(const Variant& variant) {
  constexpr double modulus = 1e6, acceleration = 2.0, end = 0.8;
  Scene scene = block(variant, 30.0, 0.6, 0.6, modulus);
  RigidMotionOptions motion;
  for (int d = 0; d < 2; ++d) {
    Curve speed;
    speed.times = {0.0, end}, speed.values = {0.0, acceleration * end * scene.up[d]};
    motion.velocity.push_back(speed);
  }
  wall(scene, 0.0).motion = motion;
  Run run(scene, explicit_options(variant, 1.0, time_step(modulus, courant(variant))));
  // The wall's force is all that changes the momentum (see `slide`), so its mean is the slope of the
  // momentum.
  Line line;
  Vec<2> impulse = Vec<2>::Zero();
  double before = 0.0;
  run.go(end, [&] {
    const double now = run.model().time;
    impulse += (now - before) * run.model().reactions[0];
    before = now;
    if (now > 0.2) line.add(now, impulse.dot(scene.up));
  });
  return line.slope() / (run.mass() * acceleration);
}

Corner corner(const Variant& variant) {
  constexpr double modulus = 1e6, degrees = 20.0;
  Scene scene = block(variant, degrees, 0.6, 0.6, modulus);
  WallOptions side = wall(scene, 0.0);
  side.label = "side";
  const Vec<2> foot = scene.foot + 0.3 * scene.along;
  side.shape = PlaneWall{{foot[0], foot[1]}, {-scene.along[0], -scene.along[1]}};
  scene.options.boundaries.push_back(side);
  add_gravity(scene, {0.0, -1.0}, ramp(0.3));
  const double dt = time_step(modulus, courant(variant));
  Run run(scene, explicit_options(variant, 1.0, dt, 0.3));
  run.go(1.5);
  run.change(explicit_options(variant, 1.0, dt));
  Corner sum;
  int steps = 0;
  run.go(0.3, [&] {
    sum.floor += run.model().reactions[0].dot(scene.up),
        sum.side -= run.model().reactions[1].dot(scene.along);
    ++steps;
  });
  const double weight = steps * run.mass() * gravity;
  return {sum.floor / (weight * std::cos(radians(degrees))),
          sum.side / (weight * std::sin(radians(degrees)))};
}

Roll roll(const Variant& variant, double friction) {
  constexpr double modulus = 2e6, radius = 1.0, rise = 0.2, end = 0.8;
  Scene scene = disc(variant, 60.0, radius, modulus);
  wall(scene, friction);
  add_gravity(scene, {0.0, -1.0}, ramp(rise));
  Run run(scene, explicit_options(variant, 1.0, time_step(modulus, courant(variant))));
  const Vec<2> start = run.centre();
  run.go(end);
  const double s = std::sin(radians(60.0)), c = std::cos(radians(60.0));
  const bool rolls = friction > s / c / 3.0;  // more is not needed: a = 2/3 g sin
  const double a = gravity * (rolls ? s / 1.5 : s - friction * c);
  const double turn = rolls ? a / radius : 2.0 * friction * gravity * c / radius;
  const double rest = end - rise;
  const double way = a * (rise * rise / 6.0 + 0.5 * rise * rest + 0.5 * rest * rest);
  return {(run.centre() - start).dot(scene.along) / way, -run.spin() / (turn * (end - 0.5 * rise))};
}

double critical_number(const Variant& variant, bool with_wall) {
  constexpr double modulus = 1e6;
  const auto stable = [&](double number) {
    Scene scene = block(variant, 30.0, 0.6, 0.4, modulus);
    if (with_wall) {
      wall(scene, 0.3);
      add_gravity(scene, -scene.up, Curve(1.0));  // it stays where it is, however long the steps are
    }
    // Vibrations along the normal at a strain of some 1e-3.
    const Mat<2> gradient = 0.05 * scene.up * scene.up.transpose();
    scene.options.bodies[0].velocity_gradient = {{gradient(0, 0), gradient(0, 1)},
                                                 {gradient(1, 0), gradient(1, 1)}};
    scene.options.bodies[0].velocity_centre = {scene.foot[0], scene.foot[1]};
    const double dt = time_step(modulus, number);
    try {
      Run run(scene, explicit_options(variant, 1.0, dt));
      const auto inner = [&] { return run.energy() - 0.5 * run.momentum().squaredNorm() / run.mass(); };
      double early = 0.0, late = 0.0;
      run.go(300 * dt, [&] {
        (run.model().step <= 60 ? early : late) = std::max(run.model().step <= 60 ? early : late, inner());
      });
      return std::isfinite(late) && late < 10.0 * early;
    } catch (const RunError&) {
      return false;
    }
  };
  double low = 0.3, high = 1.7;
  for (int k = 0; k < 7; ++k) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace wisp::explicit_walls
