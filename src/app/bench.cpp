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
#include <utility>

#include "analysis/explicit.h"
#include "analysis/implicit.h"
#include "app/bench_bare.h"
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
    o.boundaries.emplace_back(std::move(roller));
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

/// What an explicit run has cost so far. Bursts are short, so that the edge of the block moves by less than
/// half a cell in all and no function keeps hardly any mass; each has several steps, so that reorderings are
/// part of it.
template <int dim>
class ExplicitRun {
 public:
  static constexpr int burst = 5, bursts = 5;

  ExplicitRun(const ModelOptions& options, Mass mass)
      : model_(options),
        analysis_(model_, explicit_options(mass)),
        dt_(analysis_.time_step(std::numeric_limits<double>::max())) {
    // Warms up; what the first reordering needs for a moment counts as memory.
    for (int k = 0; k < 3 || (model_.reorderings == 0 && k < 10); ++k) analysis_.step(dt_);
    before_ = model_.timers.parts();
    reorderings_ = -model_.reorderings;
  }

  void run(int steps) {
    const double start = processor_seconds();
    for (int k = 0; k < steps; ++k) analysis_.step(dt_);
    best_ = std::min(best_, (processor_seconds() - start) / steps);
    steps_ += steps;
  }

  int points() const { return static_cast<int>(model_.n_points()); }
  double seconds() const { return best_; }  ///< a step, in the best burst
  std::int64_t reorderings() const { return reorderings_ + model_.reorderings; }
  int steps() const { return steps_; }
  const Explicit<dim>& analysis() const { return analysis_; }
  /// ns a point and step of every part, over all bursts.
  std::string parts() const {
    std::string text;
    for (std::size_t k = 0; k < before_.size(); ++k)
      text += fmt::format("{}{:.1f}", k ? " + " : "",
                          1e9 * (model_.timers.parts()[k].seconds - before_[k].seconds) / points() / steps_);
    return text;
  }

 private:
  Model<dim> model_;
  Explicit<dim> analysis_;
  double dt_, best_ = std::numeric_limits<double>::max();
  int steps_ = 0;
  std::int64_t reorderings_ = 0;
  std::vector<Timers::Part> before_;
};

/// Engine and bare kernel in turns, so that both see the same machine; best of several bursts for both.
/// Returns the peak memory of the engine (bytes) and its points.
template <int dim>
std::pair<std::optional<double>, int> compare(int points, bool gimp) {
  const double target = gimp ? target_gimp : target_linear;
  const bool peak = PeakMemory::forget();
  ExplicitRun<dim> engine(block<dim>(points, gimp), Mass::lumped);
  const std::optional<double> memory = peak ? PeakMemory::bytes() : std::nullopt;
  BareKernel<dim> bare(points);
  double best = std::numeric_limits<double>::max();
  for (int k = 0; k < engine.bursts; ++k) {
    best = std::min(best, bare.seconds_per_step(2 * engine.burst));
    engine.run(engine.burst);
  }
  const double own = engine.points() / engine.seconds(), yardstick = bare.size() / best,
               ratio = own / yardstick;
  print(
      "  {}D {:<6} {:>9} points  {:>5.1f} M point-steps/s, bare {:>5.1f}: {:>3.0f} %, target >= {:.0f} %: {} "
      "  "
      "({} ns a point in steps 1 to 5-7; {} reorderings in {} steps)\n",
      dim, gimp ? "GIMP" : "linear", engine.points(), 1e-6 * own, 1e-6 * yardstick, 100 * ratio, 100 * target,
      verdict(ratio >= target), engine.parts(), engine.reorderings(), engine.steps());
  return {memory, engine.points()};
}

/// The explicit engine at both sizes with one basis.
template <int dim>
void bench_explicit(int points, bool gimp) {
  const auto [small, n_small] = compare<dim>(points / 10, gimp);
  const auto [large, n_large] = compare<dim>(points, gimp);
  if (!small || !large) {
    print("  {}D {:<6} memory: not measured, this system does not let a process reset its peak\n", dim,
          gimp ? "GIMP" : "linear");
    return;
  }
  const double bytes = (*large - *small) / (n_large - n_small);
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
  ExplicitRun<dim> lumped(o, Mass::lumped);
  o.stabilisation = GhostOptions{};
  ExplicitRun<dim> consistent(o, Mass::consistent);
  for (int k = 0; k < 3; ++k) {
    lumped.run(lumped.burst);
    consistent.run(3);
  }
  const double ratio = consistent.seconds() / lumped.seconds();
  print(
      "  {}D {:<6} {:>9} points  {:>5.1f} times the lumped step, target < {:.0f}: {}   ({:.1f} iterations a "
      "solve, 2 solves a step; {} ns a point in steps 1 to 5-7)\n",
      dim, gimp ? "GIMP" : "linear", consistent.points(), ratio, target_consistent,
      verdict(ratio < target_consistent), consistent.analysis().iterations_per_solve(), consistent.parts());
}

/// Powell-Sabin splines against linear functions, on the same triangles and points, and on the cells of a
/// structured grid with as many points; in turns, best of several bursts.
void bench_splines(int points) {
  const int blocks = std::max(4, static_cast<int>(std::lround(std::sqrt(points) / 4)));
  const auto on_triangles = [&](const AnyBasisOptions& basis) {
    ModelOptions o = block<2>(4 * blocks * blocks, false);
    TriangleBlocksOptions grid;
    grid.lower = o.grid.lower, grid.upper = o.grid.upper, grid.cells = o.grid.cells;
    o.triangulation = grid;
    o.basis = basis;
    return o;
  };
  ExplicitRun<2> linear(on_triangles(LinearOptions{}), Mass::lumped);
  ExplicitRun<2> spline(on_triangles(PowellSabinOptions{}), Mass::lumped);
  ExplicitRun<2> cells(block<2>(linear.points(), false), Mass::lumped);
  for (int k = 0; k < linear.bursts; ++k)
    for (auto* run : {&linear, &spline, &cells}) run->run(run->burst);
  const auto cost = [](const ExplicitRun<2>& run) { return run.seconds() / run.points(); };
  const double ratio = cost(spline) / cost(linear);
  print(
      "  {:>9} points  {:>6.2f} M point-steps/s, {:.2f} times the linear step on triangles, target <= "
      "{:.0f}: {}   "
      "({:.2f} times that on cells, {:.2f} for linear on triangles; {} ns a point in steps 1 to 5-7)\n",
      spline.points(), 1e-6 / cost(spline), ratio, target_splines, verdict(ratio <= target_splines),
      cost(spline) / cost(cells), cost(linear) / cost(cells), spline.parts());
}

}  // namespace

void bench(int points, const std::string& only) {
  if (Session::size() > 1) input_error("bench measures one rank: start it without mpirun");
  if (points < 10000)
    input_error("bench needs --points of at least 10000 (the small case has a tenth), found {}", points);
  const auto wanted = [&](const char* part) { return only.empty() || only == part; };
  print("Times are processor times, best of several runs.\n\nYardsticks\n");
  print("  triad bandwidth {:.1f} GB/s\n", 1e-9 * triad_bandwidth());
  print("  bare kernel: beside every line below, measured in turns with the engine\n");
  if (wanted("explicit")) {
    print("\nExplicit, lumped, linear elastic, with boundaries and reordering\n");
    bench_explicit<2>(points, false);
    bench_explicit<3>(points, false);
    bench_explicit<2>(points, true);
    bench_explicit<3>(points, true);
    print(
        "  (memory: difference of the peaks of resident memory at both sizes over the difference of points; "
        "the peak\n"
        "   is reset through /proc/self/clear_refs before each)\n");
  }
  if (wanted("splines")) {
    print("\nPowell-Sabin splines, explicit, lumped\n");
    bench_splines(points);
  }
  if (wanted("newton")) {
    print("\nNewton\n");
    bench_newton();
  }
  if (wanted("consistent")) {
    print("\nConsistent mass with Ghost\n");
    bench_consistent<2>(points / 10, false);
    bench_consistent<2>(points / 10, true);
    bench_consistent<3>(points / 10, false);
  }
  if (wanted("walls")) {
    print("\nWalls, a footing pushed into a box (shares by the clock)\n");
    bench_walls(points / 10);
  }
}

}  // namespace wisp
