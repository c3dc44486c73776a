#include "app/bench.h"

#include "io/run_report.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>

#include "analysis/explicit.h"
#include "analysis/implicit.h"
#include "core/error.h"

namespace wisp {

namespace {

/// Least share of the bare kernel's speed, most bytes a point, and so on (the project's targets).
constexpr double target_linear = 0.50, target_gimp = 0.25;
template <int dim>
constexpr double target_bytes = dim == 2 ? 300.0 : 450.0;
constexpr double target_newton = 15e-3;  // s
constexpr double target_consistent = 15.0;
constexpr double target_splines = 4.0;

const char* verdict(bool met) { return met ? "met" : "MISSED"; }

template <class... Args>
void print(fmt::format_string<Args...> format, Args&&... args) {
  fmt::print(format, std::forward<Args>(args)...);
  std::fflush(stdout);
}

/// The peak memory of this process (bytes) since `forget`, as the system counts resident pages.
class PeakMemory {
 public:
  /// Gives unused memory back and starts a new peak. False where the system cannot (not Linux): then nothing
  /// is measured.
  static bool forget() {
    malloc_trim(0);
    std::FILE* file = std::fopen("/proc/self/clear_refs", "w");
    if (!file) return false;
    const bool written = std::fputs("5\n", file) >= 0;
    return std::fclose(file) == 0 && written;
  }
  static std::optional<double> bytes() {
    std::FILE* file = std::fopen("/proc/self/status", "r");
    if (!file) return std::nullopt;
    std::optional<double> peak;
    char line[256];
    double kilobytes = 0.0;
    while (std::fgets(line, sizeof line, file))
      if (std::sscanf(line, "VmHWM: %lf kB", &kilobytes) == 1) peak = 1024.0 * kilobytes;
    std::fclose(file);
    return peak;
  }
};

/// A square (cube) of about `points` points, 2 a cell and direction, on rollers in the lower corner of its
/// grid, that is being compressed so fast that points change their cells and are reordered.
template <int dim>
ModelOptions block(int points, bool gimp) {
  constexpr double h = 0.01;
  const int cells = std::max(4, static_cast<int>(std::lround(std::pow(points, 1.0 / dim) / 2)));
  ModelOptions o;
  o.grid.lower.assign(dim, 0.0);
  o.grid.upper.assign(dim, h * (cells + 2));
  o.grid.cells.assign(dim, cells + 2);
  if (gimp) o.basis = GimpOptions{};
  LinearElastic law;
  law.density = 1000.0, law.young_modulus = 1e6, law.poisson_ratio = 0.25;
  BodyOptions body;
  body.label = "block";
  Box box;
  box.lower.assign(dim, 0.0), box.upper.assign(dim, h * cells);
  body.shape = box;
  body.material = law;
  const double wave = std::sqrt(law.p_wave_modulus() / law.density);
  body.velocity_gradient.assign(dim, std::vector<double>(dim, 0.0));
  for (std::size_t d = 0; d < dim; ++d) body.velocity_gradient[d][d] = -0.05 * wave / (h * cells);
  o.bodies = {body};
  for (int d = 0; d < dim; ++d) {
    ConformingOptions roller;
    roller.label = std::string("roller ") + "xyz"[d];
    roller.normal = std::string(1, "xyz"[d]);
    roller.at = 0.0;
    roller.directions = {roller.normal};
    o.boundaries.push_back(roller);
  }
  return o;
}

ExplicitOptions explicit_options(Mass mass) {
  ExplicitOptions o;
  o.duration = 1e9;
  o.cfl = 0.4;
  o.mass = mass;
  return o;
}

struct Measured {
  int points = 0;
  double seconds = 0.0;  ///< a step
  std::optional<double> peak;
  int steps = 0, reorderings = 0;
  std::string parts;  ///< ns a point and step of every part
  double speed() const { return points / seconds; }
};

/// Best of `repeats` runs of `steps` steps, after warming up.
template <int dim>
Measured measure(const ModelOptions& options, Mass mass, int steps, int repeats) {
  Measured result;
  const bool peak = PeakMemory::forget();
  Model<dim> model(options);
  Explicit<dim> analysis(model, explicit_options(mass));
  const double dt = analysis.time_step(std::numeric_limits<double>::max());
  for (int k = 0; k < 3; ++k) analysis.step(dt);
  result.points = static_cast<int>(model.n_points());
  result.seconds = std::numeric_limits<double>::max();
  const auto before = model.timers.parts();
  auto id = model.bodies.front().points.id;
  for (int r = 0; r < repeats; ++r) {
    double seconds = 0.0;
    for (int k = 0; k < steps; ++k) {
      const double start = processor_seconds();
      analysis.step(dt);
      seconds += processor_seconds() - start;
      const auto& now = model.bodies.front().points.id;
      if (now != id) ++result.reorderings, id = now;
    }
    result.seconds = std::min(result.seconds, seconds / steps);
  }
  result.steps = steps * repeats;
  if (peak) result.peak = PeakMemory::bytes();
  const double point_steps = static_cast<double>(result.points) * steps * repeats;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const auto& part = model.timers.parts()[k];
    result.parts +=
        fmt::format("{}{:.1f}", k ? " + " : "", 1e9 * (part.seconds - before[k].seconds) / point_steps);
  }
  return result;
}

/// Few steps: the edge of the block moves by less than half a cell in all, so that no function keeps hardly
/// any mass.
constexpr int explicit_steps = 5;

/// The explicit engine at both sizes with one basis.
template <int dim>
void bench_explicit(int points, bool gimp, const double bare[2]) {
  const int sizes[2] = {points / 10, points};
  const double target = gimp ? target_gimp : target_linear;
  std::optional<double> peak[2];
  int count[2];
  for (int k = 0; k < 2; ++k) {
    const Measured m = measure<dim>(block<dim>(sizes[k], gimp), Mass::lumped, explicit_steps, 4);
    const double ratio = m.speed() / bare[k];
    print(
        "  {}D {:<6} {:>9} points  {:>6.2f} M point-steps/s  {:>3.0f} % of bare, target >= {:.0f} %: {}   "
        "({} ns a "
        "point in steps 1 to 5-7; {} reorderings in {} steps)\n",
        dim, gimp ? "GIMP" : "linear", m.points, 1e-6 * m.speed(), 100 * ratio, 100 * target,
        verdict(ratio >= target), m.parts, m.reorderings, m.steps);
    peak[k] = m.peak, count[k] = m.points;
  }
  if (!peak[0] || !peak[1]) {
    print("  {}D {:<6} memory: not measured, this system does not let a process reset its peak\n", dim,
          gimp ? "GIMP" : "linear");
    return;
  }
  const double bytes = (*peak[1] - *peak[0]) / (count[1] - count[0]);
  print("  {}D {:<6} memory {:.0f} bytes a point, target <= {:.0f}: {}\n", dim, gimp ? "GIMP" : "linear",
        bytes, target_bytes<dim>, verdict(bytes <= target_bytes<dim>));
}

/// The point work of Newton on the elastic beam of Coombs (2023, table 5): h = 0.125 m, 4 x 4 points a cell.
void bench_newton() {
  constexpr double h = 0.125, middle = h + 0.5, half = 0.5 * h / 4;
  ModelOptions o;
  o.grid.lower = {0.0, 0.0}, o.grid.upper = {11.0, 12.0}, o.grid.cells = {88, 96};
  o.basis = GimpOptions{};
  BodyOptions body;
  body.label = "beam";
  Box box;
  box.lower = {0.0, h}, box.upper = {10.0, h + 1.0};
  body.shape = box;
  body.sampling.points_per_cell = 4;
  Hencky law;
  law.density = 0.0, law.young_modulus = 12e6, law.poisson_ratio = 0.2;
  body.material = law;
  o.bodies = {body};
  ConformingOptions wall, pin;
  wall.label = "wall", wall.normal = "x", wall.at = 0.0, wall.directions = {"x"};
  pin.label = "pin", pin.node = {0.0, middle}, pin.directions = {"y"};
  o.boundaries = {wall, pin};
  PointLoadOptions load;
  load.label = "end", load.body = "beam", load.force = {0.0, 100e3};
  load.nearest = {{10.0 - half, middle - half}, {10.0 - half, middle + half}};
  load.factor.times = {0.0, 1.0}, load.factor.values = {0.0, 1.0};
  o.loads = {load};
  o.stabilisation = GhostOptions{};
  o.solver.solver = SolverKind::direct;

  Model<2> model(o);
  QuasiStaticOptions stage;
  stage.steps = 50;
  Implicit<2> analysis(model, stage);
  const auto seconds = [&](std::string_view prefix) {
    double sum = 0.0;
    for (const auto& part : model.timers.parts())
      if (part.name.starts_with(prefix)) sum += part.seconds;
    return sum;
  };
  double best = std::numeric_limits<double>::max(), solve = 0.0;
  int iterations = 0;
  for (int step = 0; step < 5; ++step) {
    const double before = seconds("3a") + seconds("3b"), solve_before = seconds("3c");
    const int n = analysis.step(analysis.time_step()).iterations;
    iterations += n;
    const double work = (seconds("3a") + seconds("3b") - before) / n;
    if (work < best) best = work, solve = (seconds("3c") - solve_before) / n;
  }
  print(
      "  beam of table 5, {} points: point work {:.1f} ms an iteration, target < {:.0f} ms: {}   (solve "
      "{:.1f} ms; {} "
      "iterations in 5 load steps)\n",
      model.n_points(), 1e3 * best, 1e3 * target_newton, verdict(best < target_newton), 1e3 * solve,
      iterations);
}

template <int dim>
void bench_consistent(int points, bool gimp) {
  ModelOptions o = block<dim>(points, gimp);
  const Measured lumped = measure<dim>(o, Mass::lumped, explicit_steps, 3);
  o.stabilisation = GhostOptions{};
  const Measured consistent = measure<dim>(o, Mass::consistent, 3, 3);
  const double ratio = consistent.seconds / lumped.seconds;
  print(
      "  {}D {:<6} {:>9} points  {:>5.1f} times the lumped step, target < {:.0f}: {}   ({} ns a point in "
      "steps 1 to "
      "5-7)\n",
      dim, gimp ? "GIMP" : "linear", consistent.points, ratio, target_consistent,
      verdict(ratio < target_consistent), consistent.parts);
}

/// Powell-Sabin splines against linear functions, on the same triangles and points, and on the cells of a
/// structured grid with as many points.
void bench_splines(int points) {
  const int blocks = std::max(4, static_cast<int>(std::lround(std::sqrt(points) / 4)));
  const auto on_triangles = [&](const AnyBasisOptions& basis) {
    ModelOptions o = block<2>(4 * blocks * blocks, false);
    TriangleBlocksOptions grid;
    grid.lower = o.grid.lower, grid.upper = o.grid.upper, grid.cells = o.grid.cells;
    o.triangulation = grid;
    o.basis = basis;
    return measure<2>(o, Mass::lumped, explicit_steps, 4);
  };
  const Measured linear = on_triangles(LinearOptions{}), spline = on_triangles(PowellSabinOptions{});
  const Measured cells = measure<2>(block<2>(linear.points, false), Mass::lumped, explicit_steps, 4);
  const double ratio = linear.speed() / spline.speed();
  print(
      "  {:>9} points  {:>6.2f} M point-steps/s, {:.2f} times the linear step on triangles, target <= "
      "{:.0f}: {}   "
      "({:.2f} times that on cells, {:.2f} for linear on triangles; {} ns a point in steps 1 to 5-7)\n",
      spline.points, 1e-6 * spline.speed(), ratio, target_splines, verdict(ratio <= target_splines),
      cells.speed() / spline.speed(), cells.speed() / linear.speed(), spline.parts);
}

}  // namespace

void bench(int points) {
  if (Session::size() > 1) input_error("bench measures one rank: start it without mpirun");
  if (points < 10000)
    input_error("bench needs --points of at least 10000 (the small case has a tenth), found {}", points);
  print("Times are processor times, best of several runs.\n\nYardsticks\n");
  print("  triad bandwidth {:.1f} GB/s\n", 1e-9 * triad_bandwidth());
  const double bare2[2] = {bare_speed<2>(points / 10), bare_speed<2>(points)};
  const double bare3[2] = {bare_speed<3>(points / 10), bare_speed<3>(points)};
  for (int k = 0; k < 2; ++k)
    print("  bare kernel, {:>9} points: 2D {:.1f}, 3D {:.1f} M point-steps/s\n", k ? points : points / 10,
          1e-6 * bare2[k], 1e-6 * bare3[k]);
  print("\nExplicit, lumped, linear elastic, with boundaries and reordering\n");
  bench_explicit<2>(points, false, bare2);
  bench_explicit<3>(points, false, bare3);
  bench_explicit<2>(points, true, bare2);
  bench_explicit<3>(points, true, bare3);
  print(
      "  (memory: difference of the peaks of resident memory at both sizes over the difference of points; "
      "the peak\n"
      "   is reset through /proc/self/clear_refs before each)\n");
  print("\nPowell-Sabin splines, explicit, lumped\n");
  bench_splines(points);
  print("\nNewton\n");
  bench_newton();
  print("\nConsistent mass with Ghost\n");
  bench_consistent<2>(points / 10, false);
  bench_consistent<2>(points / 10, true);
  bench_consistent<3>(points / 10, false);
}

}  // namespace wisp
