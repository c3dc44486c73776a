// What walls cost.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "analysis/explicit.h"
#include "analysis/implicit.h"
#include "app/bench.h"

namespace wisp {

namespace {

constexpr double target_share = 0.20;  // of an explicit step, and of Newton's assembly

/// A polyline, the solid on its left.
WallOptions line(const char* name, WallKind kind, std::vector<std::vector<double>> vertices) {
  WallOptions wall;
  wall.label = name, wall.kind = kind;
  PolylineWall shape;
  shape.vertices = std::move(vertices);
  wall.shape = shape;
  return wall;
}

/// A footing 1 m wide is pushed into a block of 3 m in a smooth box, at `speed` (m/s), 2 points a cell and
/// direction; no wall lies on a grid line.
ModelOptions footing(int points, double speed) {
  const int cells = std::max(8, static_cast<int>(std::lround(std::sqrt(points) / 2)));
  const double h = 3.0 / cells, low = -2.4 * h;
  ModelOptions o;
  o.grid.cells = {cells + 5, cells + 5};
  o.grid.lower = {low, low}, o.grid.upper = {low + (cells + 5) * h, low + (cells + 5) * h};
  o.basis = GimpOptions{};
  BodyOptions body;
  body.label = "ground";
  body.shape = Box{{0.0, 0.0}, {3.0, 3.0}};
  body.sampling.points_per_cell = 2;
  body.sampling.clip = true;
  Hencky law;
  law.density = 1000.0, law.young_modulus = 1e6, law.poisson_ratio = 0.3;
  body.material = law;
  o.bodies = {body};
  o.boundaries = {
      line("box", WallKind::roller, {{0.0, 3.0 + 2.0 * h}, {0.0, 0.0}, {3.0, 0.0}, {3.0, 3.0 + 2.0 * h}}),
      line("footing", WallKind::fixed, {{1.0, 3.0 + 2.0 * h}, {1.0, 3.0}, {0.0, 3.0}})};
  std::get<WallOptions>(o.boundaries[1]).motion = RigidMotionOptions{.velocity = {Curve(0.0), Curve(-speed)}};
  return o;
}

/// Seconds of the parts whose names begin with one of the characters.
double seconds(const Timers& timers, std::string_view first) {
  double sum = 0.0;
  for (const auto& part : timers.parts())
    if (first.find(part.name.front()) != std::string_view::npos) sum += part.seconds;
  return sum;
}

void print_share(const char* what, double points, double walls, double whole, const std::string& more) {
  const double share = walls / whole;
  fmt::print("  {:<24} {:>9.0f} points  walls {:>4.1f} % of it, target < {:.0f} %: {}   ({})\n", what, points,
             100.0 * share, 100.0 * target_share, share < target_share ? "met" : "MISSED", more);
  std::fflush(stdout);
}

void bench_explicit_walls(int points, bool gimp) {
  ModelOptions o = footing(points, 0.37);  // a hundredth of the speed of waves
  if (!gimp) o.basis = LinearOptions{};
  Model<2> model(o);
  ExplicitOptions stage;
  stage.duration = 1e9, stage.cfl = 0.4;
  Explicit<2> analysis(model, stage);
  const double dt = analysis.time_step(std::numeric_limits<double>::max());
  for (int k = 0; k < 10; ++k) analysis.step(dt);
  constexpr int steps = 50;
  const double walls = seconds(model.timers, "w"), whole = model.timers.total();
  for (int k = 0; k < steps; ++k) analysis.step(dt);
  const auto n = static_cast<double>(model.n_points());
  const double of_walls = seconds(model.timers, "w") - walls, of_all = model.timers.total() - whole;
  print_share(gimp ? "explicit step, GIMP" : "explicit step, linear", n, of_walls, of_all,
              fmt::format("{:.1f} of {:.1f} ns a point and step", 1e9 * of_walls / n / steps,
                          1e9 * of_all / n / steps));
}

void bench_newton_walls(int points) {
  ModelOptions o = footing(points, 5e-2);
  o.solver.solver = SolverKind::direct;
  Model<2> model(o);
  QuasiStaticOptions stage;
  stage.steps = 50;
  Implicit<2> analysis(model, stage);
  int iterations = 0;
  for (int k = 0; k < 2; ++k) iterations += analysis.step(analysis.time_step()).iterations;
  const Timers& timers = model.timers;
  double assembly = seconds(timers, "12w");
  for (const auto& part : timers.parts())
    if (part.name.starts_with("3a") || part.name.starts_with("3b")) assembly += part.seconds;
  print_share(
      "Newton's assembly, GIMP", static_cast<double>(model.n_points()), seconds(timers, "w"), assembly,
      fmt::format("stencils, Ghost, residual, tangent and walls: {:.0f} ms an iteration; {} iterations "
                  "in 2 load steps",
                  1e3 * assembly / iterations, iterations));
}

}  // namespace

void bench_walls(int points) {
  bench_explicit_walls(points, false);
  bench_explicit_walls(points, true);
  bench_newton_walls(points);
}

}  // namespace wisp
