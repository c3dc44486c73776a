// Figures 13 to 15 and table 3: energies of two ghosts that collide.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "core/error.h"
#include "verification/ghost/collision.h"
#include "verification/ghost/ghost_body.h"
#include "verification/ghost/list.h"
#include "verification/published.h"

namespace wisp {

namespace {

using namespace ghost_paper;

/// Each run is made once, whatever tables need it.
class Runs {
 public:
  const CollisionRun& of(const CollisionCase& collision) {
    auto& kept = kept_[collision];
    if (!kept) kept = std::make_unique<CollisionRun>(run_collision(collision));
    return *kept;
  }

 private:
  std::map<CollisionCase, std::unique_ptr<CollisionRun>> kept_;
};

const char* word(StressUpdate update) { return update == StressUpdate::usf ? "USF" : "USL"; }
const char* word(Mass mass) { return mass == Mass::consistent ? "ghost" : "lumped"; }
std::string spacing(int cells) { return fmt::format("h={:.2f}", 1.0 / cells); }
std::string name(const CollisionCase& c) {
  return fmt::format("{} {} {} {} {}", word(c.update), word(c.mass), c.points, c.steps, spacing(c.cells));
}

std::vector<double> total_error(const CollisionRun& run) {
  std::vector<double> error;
  for (std::size_t i = 0; i < run.time.size(); ++i)
    error.push_back(run.kinetic[i] + run.strain[i] - run.initial);
  return error;
}

/// Sum of all energies against the initial one; external forces do no work here.
VerificationRow balance(const std::string& label, double worst, double bound) {
  VerificationRow row{label, "greatest |energy - work| / W0", std::nullopt, worst};
  row.reference = "exact", row.expected = 0.0, row.tolerance = bound, row.gated = true;
  return row;
}

std::vector<VerificationRow> figure_13(Runs& runs, const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  const CollisionCase shown{StressUpdate::usf, Mass::consistent, "medium", 1000, 10, false};
  const CollisionRun& a = runs.of(shown);
  std::vector<double> total;
  for (std::size_t i = 0; i < a.time.size(); ++i) total.push_back(a.kinetic[i] + a.strain[i]);
  write_curves(request.folder, "ghost.figure-13a", "Two elastic ghosts: energies in J (" + name(shown) + ")",
               {{"time [s]", a.time}, {"kinetic", a.kinetic}, {"strain", a.strain}, {"total", total}});
  rows.push_back({"a: " + name(shown), "W0, J", Published("ghost-collision").at({"W0"}, "value"), a.initial});
  rows.push_back({"a: " + name(shown), "greatest strain energy / W0", std::nullopt,
                  *std::max_element(a.strain.begin(), a.strain.end()) / a.initial});
  // The caption says 2000 steps, the text 4000.
  for (const int steps : {2000, 4000}) {
    std::vector<FigureColumn> columns;
    double dissipated[2] = {};  // USL: lumped, Ghost
    for (const StressUpdate update : {StressUpdate::usf, StressUpdate::usl})
      for (const Mass mass : {Mass::consistent, Mass::lumped}) {
        const CollisionCase c{update, mass, "medium", steps, 10, false};
        const CollisionRun& run = runs.of(c);
        const auto error = total_error(run);
        if (columns.empty()) columns.push_back({"time [s]", run.time});
        columns.push_back({fmt::format("{} {}", word(update), word(mass)), error});
        columns.back().values.resize(columns[0].values.size(), std::nan(""));
        const double last = error.empty() ? std::nan("") : error.back() / run.initial;
        rows.push_back({"b: " + name(c), "energy error at the end / W0", std::nullopt, last});
        if (update == StressUpdate::usl) dissipated[mass == Mass::consistent] = -last;
      }
    VerificationRow less{fmt::format("b: USL, {} steps", steps), "dissipated, lumped over Ghost",
                         std::nullopt, dissipated[0] / std::abs(dissipated[1])};
    less.gated = true, less.verdict = dissipated[0] > 5.0 * std::abs(dissipated[1]);
    rows.push_back(less);
    write_curves(request.folder, fmt::format("ghost.figure-13b-{}", steps),
                 fmt::format("Two elastic ghosts: energy error in J, {} steps", steps), columns);
  }
  return rows;
}

const std::vector<int> meshes{5, 10, 20};
const std::vector<int> step_counts{1000, 2000, 4000};

std::vector<CollisionCase> table_3_cases(bool full) {
  std::vector<CollisionCase> cases;
  for (const StressUpdate update : {StressUpdate::usf, StressUpdate::usl})
    for (const Mass mass : {Mass::consistent, Mass::lumped})
      for (const auto& points : resolutions())
        for (const int steps : step_counts)
          for (const int cells : meshes) {
            const bool chosen = points.name == "coarse" && steps <= 2000;
            if (full || chosen) cases.push_back({update, mass, points.name, steps, cells, false});
          }
  return cases;
}

std::optional<double> printed_error(const Published& published, const CollisionCase& c) {
  return published.at({word(c.update), word(c.mass), c.points, std::to_string(c.steps)}, spacing(c.cells));
}

using Errors = std::map<CollisionCase, double>;

VerificationRow trend(const std::string& label, const char* quantity, double value, bool holds) {
  VerificationRow row{label, quantity, std::nullopt, value};
  row.gated = true, row.verdict = holds;
  return row;
}

/// "Increasing the number of time steps reduces the average energy error ... for all analyses."
void add_point_1(const Errors& errors, std::vector<VerificationRow>& rows) {
  for (const auto& [c, error] : errors) {
    CollisionCase finer = c;
    finer.steps = 2 * c.steps;
    if (const auto other = errors.find(finer); other != errors.end())
      rows.push_back(trend("(i) " + name(c), "error over that of twice the steps", error / other->second,
                           error > other->second));
  }
}

/// "Ghost ... is more sensitive to changes in background grid resolution compared to the lumped mass matrix
/// when an USF approach is adopted, with the average energy error being smaller for the h = 0.2 m and 0.1 m
/// analyses ... but the opposite being true for the h = 0.05 m analysis."
void add_point_2(const Published& published, const Errors& errors, std::vector<VerificationRow>& rows) {
  for (const auto& [c, error] : errors) {
    CollisionCase lumped = c;
    lumped.mass = Mass::lumped;
    if (c.update != StressUpdate::usf || c.mass == Mass::lumped || !errors.count(lumped)) continue;
    const double ratio = errors.at(lumped) / error;
    const double printed = printed_error(published, lumped).value() / printed_error(published, c).value();
    VerificationRow row{"(ii) " + name(c), "lumped over Ghost", printed, ratio};
    row.gated = true, row.verdict = (ratio > 1.0) == (printed > 1.0);
    rows.push_back(row);
    CollisionCase fine = c, fine_lumped = lumped;
    fine.cells = fine_lumped.cells = 20;
    if (c.cells != 10 || !errors.count(fine) || !errors.count(fine_lumped)) continue;
    const auto print = [&](const CollisionCase& of) { return printed_error(published, of).value(); };
    VerificationRow growth{"(ii) " + name(c), "growth of the error to h=0.05, Ghost over lumped",
                           print(fine) / print(c) / (print(fine_lumped) / print(lumped)),
                           errors.at(fine) / error / (errors.at(fine_lumped) / errors.at(lumped))};
    growth.gated = true, growth.verdict = growth.computed > 1.0;
    rows.push_back(growth);
  }
}

/// "The combination of an USL approach with a lumped mass matrix ... yields excessive energy dissipation ...
/// an order of magnitude larger than that of the USL with a stabilised consistent mass matrix for mesh sizes
/// h = 0.1 m and 0.05 m."
void add_point_3(const Published& published, const Errors& errors, std::vector<VerificationRow>& rows) {
  for (const auto& [c, error] : errors) {
    CollisionCase lumped = c;
    lumped.mass = Mass::lumped;
    if (c.update != StressUpdate::usl || c.mass == Mass::lumped || c.cells == 5 || !errors.count(lumped))
      continue;
    // In print the order of magnitude is a factor of 5.6 (h = 0.05 m, fine points) to 14.
    rows.push_back(trend("(iii) " + name(c), "lumped over Ghost", errors.at(lumped) / error,
                         errors.at(lumped) > 5.0 * error));
    rows.back().published = printed_error(published, lumped).value() / printed_error(published, c).value();
  }
}

std::vector<VerificationRow> table_3(Runs& runs, bool full) {
  const Published published("ghost-table-3");
  std::vector<VerificationRow> rows;
  Errors errors;
  for (const auto& c : table_3_cases(full)) {
    const double error = runs.of(c).mean_error();
    errors[c] = error;
    VerificationRow row{name(c), "mean energy error, 1e-3", printed_error(published, c), 1e3 * error};
    row.tolerance = 0.25;  // a target, not gated: the time of the impact depends on the outline
    rows.push_back(row);
    rows.push_back({name(c), "the same with the nodal kinetic energy, 1e-3", std::nullopt,
                    1e3 * runs.of(c).mean_error(true)});
  }
  add_point_1(errors, rows);
  add_point_2(published, errors, rows);
  add_point_3(published, errors, rows);
  return rows;
}

/// Points at the four moments of figure 15.
struct Moments {
  FigureColumn x{"x [m]", {}}, y{"y [m]", {}}, strain{"plastic logarithmic strain", {}}, time{"t [s] =", {}};
  std::vector<double> wanted{1.5, 2.0, 2.5, 3.0};

  void look(const Model<2>& model) {
    if (wanted.empty() || model.time < wanted.front() - 1e-9) return;
    for (const auto& body : model.bodies)
      for_each_state<2>(body, [&](int p, const auto& law, const auto& state) {
        const Vec<2>& position = body.points.position[static_cast<std::size_t>(p)];
        x.values.push_back(position[0]), y.values.push_back(position[1]);
        // |eps_p| of the paper is the accumulated strain's norm: sqrt(3/2) of the equivalent plastic strain.
        strain.values.push_back(std::sqrt(1.5) * law.template plastic_strain<2>(state));
        time.values.push_back(wanted.front());
      });
    wanted.erase(wanted.begin());
  }
};

struct PlasticRun {
  CollisionRun run;
  Moments moments;
};

class Plastic {
 public:
  const PlasticRun& get() {
    if (kept_) return *kept_;
    kept_ = std::make_unique<PlasticRun>();
    const CollisionCase c{StressUpdate::usf, Mass::consistent, "medium", 1000, 20, true};
    kept_->run = run_collision(c, [this](const Model<2>& model) { kept_->moments.look(model); });
    if (!kept_->run.failure.empty()) run_error("elasto-plastic ghosts: {}", kept_->run.failure);
    return *kept_;
  }

 private:
  std::unique_ptr<PlasticRun> kept_;
};

std::vector<VerificationRow> figure_14(Plastic& plastic, const VerificationRequest& request) {
  const CollisionRun& run = plastic.get().run;
  std::vector<double> total;
  double worst = 0.0;
  for (std::size_t i = 0; i < run.time.size(); ++i) {
    total.push_back(run.kinetic[i] + run.strain[i]);
    worst = std::max(worst, std::abs(total.back() + run.dissipation[i] - run.initial) / run.initial);
  }
  write_curves(request.folder, "ghost.figure-14", "Two elasto-plastic ghosts: energies in J",
               {{"time [s]", run.time},
                {"kinetic", run.kinetic},
                {"strain", run.strain},
                {"plastic dissipation", run.dissipation},
                {"kinetic + strain", total}});
  // At the most dt/2 times the rate of the strain energy, which is largest on impact: half a step of 3.5 ms
  // in which some 2 W0 a second are stored and dissipated, 3.5e-3.
  return {balance("USF Ghost medium 1000 h=0.05", worst, 0.01),
          {"at the end", "kinetic energy / W0", std::nullopt, run.kinetic.back() / run.initial},
          {"at the end", "strain energy / W0", std::nullopt, run.strain.back() / run.initial},
          {"at the end", "plastic dissipation / W0", std::nullopt, run.dissipation.back() / run.initial}};
}

std::vector<VerificationRow> figure_15(Plastic& plastic, const VerificationRequest& request) {
  const Moments& m = plastic.get().moments;
  write_points(request.folder, "ghost.figure-15", "Two elasto-plastic ghosts: plastic logarithmic strain",
               {m.x, m.y, m.strain, m.time});
  std::vector<VerificationRow> rows;
  double before = 0.0;
  bool grows = true;
  for (const double t : {1.5, 2.0, 2.5, 3.0}) {
    double most = 0.0;
    for (std::size_t i = 0; i < m.time.values.size(); ++i)
      if (m.time.values[i] == t) most = std::max(most, m.strain.values[i]);
    rows.push_back({fmt::format("t = {} s", t), "greatest plastic logarithmic strain", std::nullopt, most});
    grows = grows && most >= before;
    before = most;
  }
  rows.back().gated = true, rows.back().verdict = grows && before > 0.0;
  return rows;
}

}  // namespace

std::vector<VerificationTable> collision_tables() {
  const auto runs = std::make_shared<Runs>();
  const auto plastic = std::make_shared<Plastic>();
  return {{"ghost.figure-13", "Two elastic ghosts: energies, and their error for 2000 and 4000 steps",
           [=](const VerificationRequest& r) { return figure_13(*runs, r); }},
          {"ghost.table-3", "Two elastic ghosts: mean energy error (--full: all 108 runs)",
           [=](const VerificationRequest& r) { return table_3(*runs, r.full); }},
          {"ghost.figure-14", "Two elasto-plastic ghosts: energies against work",
           [=](const VerificationRequest& r) { return figure_14(*plastic, r); }},
          {"ghost.figure-15", "Two elasto-plastic ghosts: plastic strain at four times",
           [=](const VerificationRequest& r) { return figure_15(*plastic, r); }}};
}

}  // namespace wisp
