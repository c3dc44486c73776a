// The open issue of the thesis's chapter 5, triangles that are almost empty: what each treatment of the mass
// makes of it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/progress.h"
#include "verification/powell_sabin/disc.h"
#include "verification/powell_sabin/dynamics.h"
#include "verification/powell_sabin/exact.h"
#include "verification/powell_sabin/histories.h"
#include "verification/published.h"

namespace wisp {

namespace {
using namespace powell_sabin;

struct Treatment {
  const char* name;
  Mass mass;
  double deactivate_below = 0.0;
  bool ghost = false;
  int fmpm_order = 1;
  Integration integration = Integration::points;
};
constexpr Treatment treatments[] = {
    {"consistent", Mass::consistent},       {"lumped", Mass::lumped},
    {"partially lumped", Mass::partial},    {"deactivated", Mass::consistent, 1e-2},
    {"FMPM(2)", Mass::fmpm, 0.0, false, 2}, {"FMPM(4)", Mass::fmpm, 0.0, false, 4},
    {"FMPM(8)", Mass::fmpm, 0.0, false, 8}, {"Ghost", Mass::consistent, 0.0, true}};
constexpr Treatment reconstructed{"Ghost, stress reconstructed", Mass::consistent, 0.0, true, 1,
                                  Integration::reconstructed};

/// A line on how far a table is, where it is looked at while it runs.
class Steps {
 public:
  Steps(const char* table, std::size_t number)
      : progress_(table, Progress::Style::automatic, stderr), number_(static_cast<double>(number)) {}
  void done(const std::string& what) { progress_.update(++count_ / number_, what); }

 private:
  Progress progress_;
  double number_, count_ = 0.0;
};

/// The thesis's column under its own weight, table 4.6, over a little more than five periods.
StripCase column(int across, int blocks, int points) {
  StripCase s = large_column();
  s.blocks_across = across, s.blocks = blocks, s.points = s.points_across = points;
  s.empty_blocks = 1, s.hencky = true;
  // A quarter of the critical step of the consistent mass on 2x16 blocks, and coarser ones alike.
  s.dt = 2.5e-4 * std::min(1.0, 16.0 / blocks), s.duration = 2.2, s.record_every = 8;
  return s;
}

StripCase treated(StripCase s, const Treatment& t) {
  s.mass = t.mass, s.deactivate_below = t.deactivate_below, s.fmpm_order = t.fmpm_order;
  s.integration = t.integration;
  if (t.ghost) s.ghost = GhostOptions{};
  return s;
}

/// Largest gain of energy over the start, in units of the largest kinetic energy.
double energy_gain(const StripRun& run) {
  double most = 0.0;
  for (const double e : run.energy) most = std::max(most, e - run.energy.front());
  return run.kinetic_scale > 0 ? most / run.kinetic_scale : 0.0;
}

std::string grid_name(const StripCase& s) {
  return fmt::format("{}x{} blocks, {} points a triangle", s.blocks_across, s.blocks,
                     s.points * s.points_across / 4);
}

/// Error of displacement and energy of each treatment over time, side by side.
void write_side_by_side(const VerificationRequest& request, const std::string& name,
                        const std::vector<std::pair<std::string, StripRun>>& runs,
                        const Reference& reference) {
  const double kinetic = runs.back().second.kinetic_scale;
  std::vector<FigureColumn> errors{{"t [s]", reference.time}}, energies{{"t [s]", reference.time}};
  for (const auto& [label, run] : runs) {
    FigureColumn error{label, {}}, energy{label, {}};
    for (std::size_t k = 0; k < reference.time.size(); ++k) {
      const bool there = k < run.displacement.size();
      // Signs change: from 1e-6 m down the axis says nothing.
      const double e = there ? std::abs(run.displacement[k] - reference.displacement[k]) : std::nan("");
      error.values.push_back(there ? std::clamp(e, 1e-6, 0.2) : e);
      const double gain = there ? (run.energy[k] - run.energy.front()) / kinetic : std::nan("");
      energy.values.push_back(there ? std::clamp(gain, -0.1, 0.1) : gain);
    }
    errors.push_back(error), energies.push_back(energy);
  }
  write_curves(request.folder, name + "-error", "Soil column: error of the middle point's displacement [m]",
               errors);
  write_curves(request.folder, name + "-energy",
               "Soil column: change of energy over the largest kinetic energy", energies);
}

/// The study on blocks: every treatment on every grid.
class Blocks {
 public:
  explicit Blocks(bool full) : grids_{column(1, 4, 12), column(1, 8, 12), column(2, 16, 12)} {
    if (full) grids_.push_back(column(4, 32, 12)), grids_.push_back(column(8, 64, 12));
    treatments_.assign(std::begin(treatments), std::end(treatments));
    treatments_.push_back(reconstructed);
    for (const auto& t : treatments_) errors_.push_back({t.name, {}});
  }

  std::vector<VerificationRow> run(const VerificationRequest& request) {
    std::size_t number = 0;
    for (const auto& grid : grids_)
      number += static_cast<std::size_t>(std::count_if(treatments_.begin(), treatments_.end(),
                                                       [&](const auto& t) { return wanted(grid, t); }));
    Steps steps("near-empty.blocks", number);
    for (const auto& grid : grids_) run_grid(grid, request, steps);
    for (std::size_t k = 0; k < treatments_.size(); ++k) {
      if (!treatments_[k].ghost) continue;
      const double ratio = errors_[k].values.back() / errors_[k].values.front();
      rows_.push_back(bound(std::string(treatments_[k].name) + ", finest over coarsest grid",
                            "ratio of errors", ratio, ratio < 1.0 / 3.0));
    }
    rows_.push_back(bound("Ghost, all grids", "largest condition number of the mass", worst_condition_,
                          worst_condition_ < 1e8));
    std::vector<FigureColumn> columns{{"h [m]", {}}};
    for (const auto& grid : grids_) columns.front().values.push_back(grid.length / grid.blocks);
    columns.insert(columns.end(), errors_.begin(), errors_.end());
    write_curves(request.folder, "near-empty.blocks",
                 "Soil column: largest displacement error over five periods", columns);
    return rows_;
  }

 private:
  /// On the finest grids the others would take hours, and nothing is asked of them.
  static bool wanted(const StripCase& grid, const Treatment& t) {
    return grid.blocks <= 16 || t.mass == Mass::lumped || t.ghost;
  }

  void run_grid(const StripCase& grid, const VerificationRequest& request, Steps& steps) {
    double lumped = 0.0;
    Reference reference;
    std::vector<std::pair<std::string, StripRun>> runs;
    for (std::size_t k = 0; k < treatments_.size(); ++k) {
      const Treatment& t = treatments_[k];
      if (!wanted(grid, t)) {
        errors_[k].values.push_back(std::nan(""));
        continue;
      }
      StripCase s = treated(grid, t);
      s.with_conditions = t.ghost;
      const StripRun run = run_strip(s);
      const std::string name = std::string(t.name) + ", " + grid_name(s);
      if (run.stable() && reference.time.empty()) reference = ulfem_reference(s, run.middle, run.time);
      const double error = run.stable() ? largest_error(run, reference) : std::nan("");
      steps.done(name + (run.stable() ? fmt::format(": error {:.3e} m", error) : ": unstable"));
      if (run.stable()) {
        rows_.push_back(number(name, "largest displacement error (m)", error));
        rows_.push_back(number(name, "gain of energy / largest kinetic energy", energy_gain(run)));
      } else {
        rows_.push_back(number(name, "became unstable at (s)", run.end));
      }
      if (t.mass == Mass::lumped) lumped = error;
      if (t.ghost) judge(name, run, error, lumped, errors_[k].values);
      errors_[k].values.push_back(error);
      runs.emplace_back(t.name, run);
    }
    if (grid.blocks != 8) return;
    write_history(request, "near-empty.blocks-1x8", "Soil column, 1x8 blocks, every treatment", runs,
                  reference, "ULFEM");
    write_side_by_side(request, "near-empty.blocks-1x8", runs, reference);
  }

  /// What a run with Ghost must do; `before`: its errors on the coarser grids.
  void judge(const std::string& name, const StripRun& run, double error, double lumped,
             const std::vector<double>& before) {
    rows_.push_back(bound(name, "stable over five periods", run.end, run.stable() && run.end > 2.0));
    rows_.push_back(bound(name, "lumping's error over Ghost's", lumped / error, lumped / error > 5.0));
    if (!before.empty())
      rows_.push_back(bound(name, "error over that of the grid before", error / before.back(),
                            error < 1.5 * before.back()));
    const double condition =
        run.condition.empty() ? std::nan("") : *std::max_element(run.condition.begin(), run.condition.end());
    worst_condition_ = std::max(worst_condition_, condition);
    rows_.push_back(number(name, "largest condition number of the mass", condition));
  }

  std::vector<StripCase> grids_;
  std::vector<Treatment> treatments_;
  std::vector<FigureColumn> errors_;  // of every treatment, over the grids
  std::vector<VerificationRow> rows_;
  double worst_condition_ = 0.0;
};

std::vector<VerificationRow> blocks(const VerificationRequest& request) {
  return Blocks(request.full).run(request);
}

std::vector<VerificationRow> delaunay(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  Steps steps("near-empty.delaunay", 20 * (request.full ? std::size(treatments) : 2));
  for (const auto& t : treatments) {
    if (t.mass != Mass::lumped && !t.ghost && !request.full) continue;
    int stable = 0;
    double worst = 0.0, sum = 0.0, gain = 0.0;
    for (int seed = 1; seed <= 20; ++seed) {
      StripCase s = treated(column(1, 8, 12), t);
      s.delaunay_seed = seed;
      const StripRun run = run_strip(s);
      steps.done(fmt::format("{}, seed {}", t.name, seed));
      if (!run.stable()) continue;
      ++stable;
      const double error = largest_error(run, ulfem_reference(s, run.middle, run.time));
      worst = std::max(worst, error), sum += error, gain = std::max(gain, energy_gain(run));
    }
    const std::string name = std::string(t.name) + ", 20 random triangulations";
    if (t.ghost)
      rows.push_back(bound(name, "stable", stable, stable == 20));
    else
      rows.push_back(number(name, "stable", stable));
    if (stable == 0) continue;
    rows.push_back(number(name, "mean of the largest displacement errors (m)", sum / stable));
    rows.push_back(number(name, "worst of the largest displacement errors (m)", worst));
    rows.push_back(number(name, "largest gain of energy / largest kinetic energy", gain));
  }
  return rows;
}

/// Few points a triangle: what the quadrature does to the energy, and what cures it.
std::vector<VerificationRow> few_points(const VerificationRequest&) {
  std::vector<VerificationRow> rows;
  constexpr int counts[] = {2, 3, 4, 6, 8};
  constexpr double much = 0.005;
  Steps steps("near-empty.few-points", 2 * std::size(counts));
  for (const int points : counts) {
    bool finding = false;
    for (const GhostElements elements : {GhostElements::ring, GhostElements::ring_all}) {
      StripCase s = column(1, 8, points);
      s.ghost = GhostOptions{};
      s.ghost->elements = elements;
      const StripRun run = run_strip(s);
      const bool all = elements == GhostElements::ring_all;
      const std::string name =
          fmt::format("{} points a triangle, {}", 0.25 * points * points, all ? "ring-all" : "ring");
      steps.done(name);
      const double gain = run.stable() ? energy_gain(run) : std::nan("");
      if (!run.stable())
        rows.push_back(number(name, "FINDING: became unstable at (s)", run.end));
      else
        rows.push_back(number(
            name,
            gain > much ? "FINDING: gain of energy above 0.5 %" : "gain of energy / largest kinetic energy",
            gain));
      if (all)
        rows.push_back(bound(name, finding ? "which cures it: gain of energy" : "gain of energy below 0.5 %",
                             gain, gain < much));
      finding = !(gain < much);
      if (run.stable())
        rows.push_back(number(name, "largest displacement error (m)",
                              largest_error(run, ulfem_reference(s, run.middle, run.time))));
    }
  }
  return rows;
}

/// Linear functions and cubic splines on the same column.
std::vector<VerificationRow> other_functions(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  Steps steps("near-empty.other-functions", request.full ? 8 : 7);
  for (const bool cubic : {false, true})
    for (const bool ghost : {false, true})
      for (const StripCase& grid : {column(1, 8, 12), column(2, 16, 12)}) {
        // Conjugate gradients fail on the stabilised mass of cubic splines: a factorisation in every step.
        if (cubic && ghost && grid.blocks == 16 && !request.full) continue;
        StripCase s = grid;
        s.splines = cubic, s.cubic = cubic;
        if (cubic) s.dt /= 2.0;
        if (ghost) s.ghost = GhostOptions{};
        const StripRun run = run_strip(s);
        const std::string name = fmt::format("{}{}, {}", cubic ? "cubic splines" : "linear functions",
                                             ghost ? ", Ghost" : ", no treatment", grid_name(s));
        steps.done(name);
        if (!run.stable()) {
          rows.push_back(number(name, "became unstable at (s)", run.end));
          continue;
        }
        rows.push_back(number(name, "largest displacement error (m)",
                              largest_error(run, ulfem_reference(s, run.middle, run.time))));
        rows.push_back(number(name, "gain of energy / largest kinetic energy", energy_gain(run)));
      }
  return rows;
}

/// A disc that flies, turns and breathes: nothing of it was used to choose the penalty.
std::vector<VerificationRow> disc(const VerificationRequest&) {
  std::vector<VerificationRow> rows;
  Steps steps("near-empty.disc", std::size(treatments));
  const auto add = [&](const std::string& name, const DiscCase& d, bool gated) {
    const DiscRun run = run_disc(d);
    steps.done(name);
    if (!run.failure.empty()) {
      rows.push_back(gated ? bound(name, "stable", 0.0, false)
                           : number(name, "became unstable at (s)", run.end));
      return;
    }
    const auto row = [&](const char* quantity, double value, double limit) {
      rows.push_back(gated ? bound(name, quantity, value, value < limit) : number(name, quantity, value));
    };
    row("change of momentum, relative", run.momentum, 1e-12);
    row("change of angular momentum, relative", run.angular_momentum, 1e-12);
    row("largest change of energy, relative", run.energy, 0.005);
  };
  for (const auto& t : treatments) {
    DiscCase d;
    d.mass = t.mass, d.deactivate_below = t.deactivate_below, d.fmpm_order = t.fmpm_order;
    if (t.ghost) d.ghost = GhostOptions{};
    add(std::string(t.name) + ", disc on a random triangulation", d, t.ghost);
  }
  return rows;
}

}  // namespace

std::vector<VerificationTable> near_empty_tables() {
  return {{"near-empty.blocks", "Soil column on blocks: every treatment of the mass", blocks, false},
          {"near-empty.delaunay", "Soil column on 20 random triangulations", delaunay, false},
          {"near-empty.few-points", "Soil column with few points a triangle", few_points, false},
          {"near-empty.other-functions", "Soil column: linear functions and cubic splines", other_functions,
           false},
          {"near-empty.disc", "A disc in free flight", disc, false}};
}

}  // namespace wisp
