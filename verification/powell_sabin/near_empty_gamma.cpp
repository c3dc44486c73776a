// The penalty's factor and elements on a motion that they were not chosen on, with an exact solution.
#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/spectra.h"
#include "core/error.h"
#include "core/progress.h"
#include "verification/powell_sabin/disc.h"
#include "verification/powell_sabin/dynamics.h"
#include "verification/powell_sabin/exact.h"
#include "verification/powell_sabin/histories.h"
#include "verification/published.h"

namespace wisp {

namespace {
using namespace powell_sabin;

/// The lowest axisymmetric vibration of a free elastic disc in plane strain, small: u_r = a J1(k r) sin(omega
/// t) with no traction at its edge, (1 - nu) k R J0(k R) = (1 - 2 nu) J1(k R), omega = k c_p.
struct Breathing {
  double k = 0.0, omega = 0.0, amplitude = 0.0;  ///< 1/m, 1/s, m

  Breathing() {
    const Hencky law = disc_law();
    const double nu = law.poisson_ratio;
    const auto traction = [&](double x) {
      return (1.0 - nu) * x * std::cyl_bessel_j(0.0, x) - (1.0 - 2.0 * nu) * std::cyl_bessel_j(1.0, x);
    };
    double low = 1.0, high = 3.0;  // of one sign change
    while (high - low > 1e-14) {
      const double middle = 0.5 * (low + high);
      (traction(middle) > 0) == (traction(low) > 0) ? low = middle : high = middle;
    }
    k = low / disc_radius;
    const double modulus = law.young_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
    omega = k * std::sqrt(modulus / law.density);
    amplitude = 1e-3 * disc_radius;  // so that what is not linear stays below a thousandth
  }
  /// u = direction times this times sin(omega t).
  Vec<2> shape(const Vec<2>& x) const {
    const double r = x.norm();
    return r > 0 ? Vec<2>(amplitude * std::cyl_bessel_j(1.0, k * r) / r * x) : Vec<2>(Vec<2>::Zero());
  }
};

struct BreathingRun {
  double error = 0.0;  ///< largest over time of the rms distance of points from exact, over the rms amplitude
  double energy = 0.0;     ///< largest change of energy over that of the vibration
  double condition = 0.0;  ///< largest of the mass
  bool stable = true;
  double end = 0.0;  ///< s
};

BreathingRun run_breathing(const DiscCase& d, double periods) {
  const Breathing exact;
  Model<2> model(disc_options(d));
  Explicit<2> analysis(model, disc_step(d));
  Particles<2>& points = model.bodies.front().points;
  const Vec<2> flight(disc_velocity[0], disc_velocity[1]);
  double vibration = 0.0, amplitude = 0.0, mass = 0.0;
  for (std::size_t p = 0; p < points.position.size(); ++p) {
    const Vec<2> u = exact.shape(points.position[p]);
    const Vec<2> v = exact.omega * std::cos(0.5 * exact.omega * d.dt) * u;  // that at -dt/2
    points.velocity[p] += v;
    vibration += 0.5 * points.mass[p] * v.squaredNorm();
    amplitude += points.mass[p] * u.squaredNorm(), mass += points.mass[p];
  }
  BreathingRun run;
  const auto total = [&] {
    const BodyEnergy e = energy(model.bodies.front());
    return e.kinetic + e.strain;
  };
  const double first = total();
  const auto steps = static_cast<int>(periods * 2.0 * M_PI / exact.omega / d.dt);
  try {
    for (int i = 0; i < steps; ++i) {
      analysis.step(d.dt);
      run.end = model.time;
      double distance = 0.0;
      for (std::size_t p = 0; p < points.position.size(); ++p) {
        const Vec<2> start = points.position[p] - points.displacement[p];
        const Vec<2> u = flight * model.time + exact.shape(start) * std::sin(exact.omega * model.time);
        distance += points.mass[p] * (points.displacement[p] - u).squaredNorm();
      }
      run.error = std::max(run.error, std::sqrt(distance / amplitude));
      run.energy = std::max(run.energy, std::abs(total() - first) / vibration);
      if (i % 150 == 0) {
        model.settle();
        run.condition = std::max(run.condition, ExplicitSpectrum<2>(model, disc_step(d)).condition());
      }
      if (!(run.error < 1e3)) run_error("the points have left the motion");
    }
  } catch (const RunError&) {
    run.stable = false;
  }
  return run;
}

constexpr const char* names[] = {"boundary", "ring", "ring-all"};
constexpr GhostElements choices_of_elements[] = {GhostElements::boundary, GhostElements::ring,
                                                 GhostElements::ring_all};

/// Worst of the triangulations of some seeds.
BreathingRun worst_of(DiscCase d, int seeds, double periods) {
  BreathingRun worst;
  worst.end = std::numeric_limits<double>::infinity();
  for (d.seed = 11; d.seed < 11 + seeds; ++d.seed) {
    const BreathingRun run = run_breathing(d, periods);
    worst.stable = worst.stable && run.stable, worst.end = std::min(worst.end, run.end);
    worst.error = std::max(worst.error, run.error), worst.energy = std::max(worst.energy, run.energy);
    worst.condition = std::max(worst.condition, run.condition);
  }
  return worst;
}

void add_rows(const std::string& name, const BreathingRun& run, bool gated,
              std::vector<VerificationRow>& rows) {
  if (!run.stable) {
    rows.push_back(gated ? bound(name, "stable", 0.0, false)
                         : number(name, "became unstable at (s)", run.end));
    return;
  }
  rows.push_back(number(name, "error / amplitude", run.error));
  const char* const gain = "change of energy / energy of the vibration";
  rows.push_back(gated ? bound(name, gain, run.energy, run.energy < 0.05) : number(name, gain, run.energy));
  if (run.condition > 0) rows.push_back(number(name, "largest condition number of the mass", run.condition));
}

std::vector<VerificationRow> gamma(const VerificationRequest& request) {
  const double gammas[] = {1e-4, 1e-3, 1e-2, 1e-1, 0.25, 1.0};
  const int seeds = request.full ? 4 : 2;
  const double periods = 2.0;
  std::vector<VerificationRow> rows;
  std::vector<FigureColumn> errors{{"gamma", {}}}, conditions = errors;
  for (const char* name : names) errors.push_back({name, {}}), conditions.push_back({name, {}});
  Progress progress("near-empty.gamma", Progress::Style::automatic, stderr);
  double done = 0.0;
  DiscCase lumped;
  lumped.turns = false, lumped.mass = Mass::lumped;
  const BreathingRun plain = worst_of(lumped, seeds, periods);
  add_rows("lumped", plain, false, rows);
  for (const double g : gammas) {
    errors.front().values.push_back(g), conditions.front().values.push_back(g);
    for (std::size_t k = 0; k < std::size(names); ++k) {
      DiscCase d;
      d.turns = false;
      d.ghost = GhostOptions{};
      d.ghost->mass = g, d.ghost->elements = choices_of_elements[k];
      const BreathingRun run = worst_of(d, seeds, periods);
      const bool preset = g == GhostOptions{}.mass && k == 2;
      const std::string name = fmt::format("gamma = {:g}, {}", g, names[k]);
      add_rows(name, run, preset, rows);
      if (preset)
        rows.push_back(
            bound(name, "lumping's error over it", plain.error / run.error, plain.error > 2.0 * run.error));
      errors[k + 1].values.push_back(run.stable ? run.error : std::nan(""));
      conditions[k + 1].values.push_back(run.stable ? run.condition : std::nan(""));
      progress.update(++done / 18.0, name);
    }
  }
  write_curves(request.folder, "near-empty.gamma-error", "Breathing disc in flight: error over amplitude",
               errors);
  write_curves(request.folder, "near-empty.gamma-condition",
               "Breathing disc in flight: largest condition number of the mass", conditions);
  return rows;
}

}  // namespace

std::vector<VerificationTable> gamma_tables() {
  return {
      {"near-empty.gamma", "The penalty's factor and elements on a breathing disc in flight", gamma, false}};
}

}  // namespace wisp
