#include "io/run.h"

#include <algorithm>
#include <cmath>

#include "analysis/explicit.h"
#include "analysis/implicit.h"
#include "analysis/spectra.h"
#include "core/error.h"
#include "core/progress.h"
#include "grid/triangulate.h"
#include "io/checkpoint_state.h"
#include "io/output.h"
#include "io/results_folder.h"
#include "io/run_report.h"
#include "io/sound_state.h"
#include "io/stored_case.h"

namespace wisp {
namespace {
namespace fs = std::filesystem;

/// Steps between looks at the balance of points over the ranks.
constexpr std::int64_t rebalance_every = 20;

ModelOptions model_options(const Case& c) {
  const auto* lines = std::get_if<StructuredGridOptions>(&c.grid);
  return {lines ? *lines : StructuredGridOptions{},
          triangulation_of(c.grid),
          c.basis,
          c.bodies,
          c.boundaries,
          c.loads,
          c.gravity,
          c.stabilisation,
          c.solver,
          c.file.folder};
}

/// Explicit stages start steps from these: see Explicit::warm_velocity.
struct WarmStart {
  std::vector<double> velocity, acceleration;
};

template <int dim>
class Run {
 public:
  /// `begun`: the case as it was when the history got its columns.
  Run(const Case& c, const fs::path& folder, Talk talk, const Case& begun)
      : case_(c),
        folder_(folder),
        talk_(Session::rank() == 0 ? talk : Talk::quiet),
        model_(model_options(c)),
        begun_(begun.file),
        columns_(begun, model_),
        tracked_(c.output.track, model_) {}

  void start() {
    balance_ = EnergyBalance(EnergyBalance::total(energies_of_points(model_)));
    results_.emplace(ResultsFolder::start(folder_, case_, columns_.titles()));
    show_triangulation();
    add_state();
    go();
  }

  /// `first`: this rank's part if as many ranks go on as were stopped; else that of rank 0, and `parts` reads
  /// all of them. `changed`: the case is not quite that of the stopped run.
  void resume(const Checkpoint& first, const CheckpointParts* parts, bool changed) {
    const bool same_ranks = parts == nullptr;
    if (same_ranks)
      restore(first, model_);
    else
      restore_parts(*parts, model_);
    stage_ = static_cast<std::size_t>(first.integer("stage"));
    step_in_stage_ = first.integer("step in stage");
    stage_start_ = first.number("stage start");
    if (const auto& energy = first.doubles("first energy"); !energy.empty()) first_energy_ = energy.front();
    balance_ = EnergyBalance(first.number("energy at the start"), first.number("energy given"));
    told_removed_ = model_.removed, checkpoint_step_ = model_.step, checkpoint_time_ = model_.time;
    if (changed) count_steps_anew();
    if (same_ranks) warm_ = {first.doubles("warm velocity"), first.doubles("warm acceleration")};
    results_.emplace(
        ResultsFolder::resume(folder_, columns_.titles(), model_.time, first.integer("last row")));
    if (stage_ == case_.stages.size())
      tell(fmt::format("the run has ended already, with step {} at t = {:.6g} s", model_.step, model_.time));
    else
      tell(fmt::format("going on from step {} at t = {:.6g} s", model_.step, model_.time));
    go();
  }

 private:
  void tell(const std::string& text) const {
    if (talk_ == Talk::normal) fmt::print("{}\n", text);
  }

  /// A grid of triangles is a file of its own, and its quality is told.
  void show_triangulation() const {
    if constexpr (dim == 2) {
      if (model_.space->structured()) return;
      const Triangulation& mesh = model_.space->triangulation();
      write_vtu_cells(folder_ / "grid.vtu", grid_cells(mesh));
      tell(quality_line(mesh));
      if (const std::string warning = sliver_warning(mesh); !warning.empty()) tell(warning);
    }
  }

  void go() {
    for (; stage_ < case_.stages.size(); ++stage_) {
      if (step_in_stage_ == 0) stage_start_ = model_.time;
      model_.timers = Timers();
      point_steps_ = 0.0;
      std::visit([&](const auto& options) { stage(options); }, case_.stages[stage_]);
      times_.push_back({stage_title(), model_.timers, point_steps_});
      step_in_stage_ = 0;
    }
    const double bandwidth = talk_ == Talk::normal ? triad_bandwidth() : 0.0;
    if (model_.options.leaving() == Leaving::remove)
      tell(fmt::format("{} points left the grid and were removed", model_.removed));
    tell(summary(folder_, times_, bandwidth));
  }

  std::string stage_title() const {
    const std::string_view type =
        std::visit([](const auto& o) -> std::string_view { return std::decay_t<decltype(o)>::name; },
                   case_.stages[stage_]);
    if (case_.stages.size() == 1) return std::string(type);
    return fmt::format("stage {}/{} {}", stage_ + 1, case_.stages.size(), type);
  }
  double stage_duration() const {
    return std::visit([](const auto& o) { return o.duration; }, case_.stages[stage_]);
  }
  double stage_end() const { return stage_start_ + stage_duration(); }
  double share_done() const { return (model_.time - stage_start_) / stage_duration(); }

  /// Before every step.
  bool rebalance() {
    point_steps_ += static_cast<double>(local_points());
    if (Session::size() == 1 || model_.step % rebalance_every != 0) return false;
    model_.settle();  // points that left the grid have no cell to count
    return model_.rebalance();
  }
  int local_points() const {
    int n = 0;
    for (const auto& body : model_.bodies) n += body.points.size();
    return n;
  }

  void stage(const ExplicitOptions& options);
  template <class Options>
  void stage(const Options& options);  // implicit
  template <class Analysis>
  void after_step(Analysis& analysis, double time_before, Progress& progress);
  template <class Analysis>
  void add_checkpoint(Analysis& analysis, bool stage_is_over);
  void add_last_row(Explicit<dim>& analysis);
  void measure_spectrum(const ExplicitOptions& options, Row<dim>& row);

  bool row_due() const {
    return results_->last_row() < model_.step && model_.step % case_.output.history_every == 0;
  }
  /// Finished steps of the stage where their number per stage may have changed.
  void count_steps_anew() {
    if (stage_ == case_.stages.size()) return;
    const double done = share_done();
    std::visit(
        [&](const auto& o) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(o)>, ExplicitOptions>)
            step_in_stage_ = static_cast<std::int64_t>(std::floor(done * o.steps + 1e-9));
        },
        case_.stages[stage_]);
  }
  /// Only explicit stages make energy out of nothing, and only conforming conditions account for their work.
  bool energy_is_broken(const EnergyRecord& record) const {
    const bool accounted = std::all_of(model_.boundaries.begin(), model_.boundaries.end(), [](const auto& b) {
      return std::holds_alternative<Conforming<dim>>(b);
    });
    return accounted && std::holds_alternative<ExplicitOptions>(case_.stages[stage_]) &&
           balance_.is_broken(record);
  }
  void settle_or_stop(auto& analysis);
  void check_balance(Explicit<dim>& analysis, const EnergyRecord& record, double work);
  template <class Analysis>
  [[noreturn]] void stop(Analysis& analysis, const std::string& cause);
  void keep_start();
  void add_row(std::int64_t step, double time, Row<dim> row);
  void add_state() {
    if (state_step_ == model_.step) return;
    results_->add_state(model_.step, model_.time, picture(model_));
    state_step_ = model_.step;
  }

  Case case_;
  fs::path folder_;
  Talk talk_;
  Model<dim> model_;
  CaseSource begun_;
  HistoryColumns<dim> columns_;
  Tracked<dim> tracked_;
  std::optional<ResultsFolder> results_;

  std::size_t stage_ = 0;
  std::int64_t step_in_stage_ = 0;
  double stage_start_ = 0.0;            ///< s
  std::optional<double> first_energy_;  ///< J
  std::optional<WarmStart> warm_;       ///< of the checkpoint, until its stage goes on
  double last_dt_ = 0.0;                ///< s
  std::int64_t told_removed_ = 0;
  EnergyBalance balance_;
  std::int64_t state_step_ = -1;       ///< of the newest state
  std::int64_t checkpoint_step_ = -1;  ///< of the newest checkpoint
  double checkpoint_time_ = 0.0;       ///< s
  double point_steps_ = 0.0;
  std::vector<StageTimes> times_;
};

/// Stops a run that makes energy out of nothing.
template <int dim>
void Run<dim>::check_balance(Explicit<dim>& analysis, const EnergyRecord& record, double work) {
  balance_.add_work(work);
  if (!energy_is_broken(record)) return;
  stop(analysis,
       fmt::format(
           "step {} at t = {:.6g} s: the points have {:.3g} J, more than a hundred times the {:.3g} J that "
           "they "
           "were given: the step is longer than the stable one, or nearly empty cells have no stabilisation; "
           "try a smaller dt or cfl, or add [stabilisation] with mass = \"consistent\"",
           model_.step, model_.time, EnergyBalance::total(record), balance_.given()));
}

/// A step has failed. Keeps the state before it if that is at hand and makes sense, and tells from where the
/// run can go on.
template <int dim>
template <class Analysis>
void Run<dim>::stop(Analysis& analysis, const std::string& cause) {
  if (!analysis.points_changed() && is_finite(model_) && !energy_is_broken(energies_of_points(model_))) {
    if (checkpoint_step_ != model_.step || checkpoint_time_ != model_.time) {
      if constexpr (std::is_same_v<Analysis, Explicit<dim>>)  // of the failed step
        analysis.warm_velocity().clear(), analysis.warm_acceleration().clear();
      add_state();
      add_checkpoint(analysis, false);
    }
    run_error("{}; the state at t = {:.6g} s, after step {}, is kept: wisp resume {}", cause, model_.time,
              model_.step, folder_.string());
  }
  if (checkpoint_step_ >= 0)
    run_error("{}; the last good state is the checkpoint of step {} at t = {:.6g} s: wisp resume {}", cause,
              checkpoint_step_, checkpoint_time_, folder_.string());
  keep_start();
  run_error("{}; no state but the start is kept (checkpoint_every in [output] keeps more): wisp resume {}",
            cause, folder_.string());
}

/// The start of the run, made anew from the case: steps change the points in place, and a copy of them would
/// cost every run time and memory.
template <int dim>
void Run<dim>::keep_start() {
  Model<dim> start(model_options(case_));
  Checkpoint checkpoint;
  store(start, checkpoint);
  store_case(case_.file, begun_, checkpoint);
  checkpoint.set_integer("stage", 0);
  checkpoint.set_integer("step in stage", 0);
  checkpoint.set_number("stage start", start.time);
  checkpoint.set_integer("last row", -1);
  checkpoint.set_number("energy at the start", balance_.start());
  checkpoint.set_number("energy given", balance_.start());
  for (const char* empty : {"first energy", "warm velocity", "warm acceleration"})
    checkpoint.set(empty, Checkpoint::Doubles{});
  results_->add_checkpoint(checkpoint);
}

template <int dim>
void Run<dim>::settle_or_stop(auto& analysis) {
  try {
    model_.settle();
  } catch (const RunError& error) {
    stop(analysis, error.what());
  }
}

template <int dim>
void Run<dim>::add_row(std::int64_t step, double time, Row<dim> row) {
  row.stage = static_cast<int>(stage_) + 1;
  if (!first_energy_)
    first_energy_ =
        row.energy.kinetic + row.energy.strain + row.energy.dissipation - row.energy.external_work;
  row.first_energy = *first_energy_;
  results_->add_row(step, time, columns_.values(row, model_));
}

/// What follows every step: the last row of an explicit stage, states, checkpoints, and word of points that
/// left.
template <int dim>
template <class Analysis>
void Run<dim>::after_step(Analysis& analysis, double time_before, Progress& progress) {
  const int every = case_.output.checkpoint_every, frames = case_.output.frames;
  const bool over = model_.time >= stage_end();
  const auto frame = [&](double time) {
    return std::floor((time - stage_start_) / stage_duration() * frames + 1e-9);
  };
  const bool state_due = frames > 0 && (over || frame(model_.time) > frame(time_before));
  const bool checkpoint_due = over || (every > 0 && model_.step % every == 0);
  // Files show and hold settled states: points in the grid, each with its rank.
  if (state_due || checkpoint_due) settle_or_stop(analysis);
  if (model_.removed > told_removed_) {
    const auto now = model_.removed - told_removed_;
    progress.line(fmt::format("step {} at t = {:.6g} s: {} left the grid and {} removed, {} so far",
                              model_.step, model_.time, now == 1 ? "1 point" : fmt::format("{} points", now),
                              now == 1 ? "was" : "were", model_.removed));
    told_removed_ = model_.removed;
  }
  if constexpr (std::is_same_v<Analysis, Explicit<dim>>)
    if (over) add_last_row(analysis);
  const auto timer = model_.timers.start("states, checkpoints");
  if (state_due) add_state();
  if (!checkpoint_due) return;
  if constexpr (std::is_same_v<Analysis, Explicit<dim>>)  // never a bad state in the place of a good one
    check_balance(analysis, energies_of_points(model_), model_.external_work);
  add_checkpoint(analysis, over);
}

template <int dim>
template <class Analysis>
void Run<dim>::add_checkpoint(Analysis& analysis, bool stage_is_over) {
  Checkpoint checkpoint;
  store(model_, checkpoint);
  store_case(case_.file, begun_, checkpoint);
  checkpoint.set_integer("stage", static_cast<std::int64_t>(stage_) + (stage_is_over ? 1 : 0));
  checkpoint.set_integer("step in stage", stage_is_over ? 0 : step_in_stage_);
  checkpoint.set_number("stage start", stage_start_);
  checkpoint.set_integer("last row", results_->last_row());
  checkpoint.set_number("energy at the start", balance_.start());
  checkpoint.set_number("energy given", balance_.given());
  checkpoint.set("first energy", first_energy_ ? Checkpoint::Doubles{*first_energy_} : Checkpoint::Doubles{});
  WarmStart warm;
  if constexpr (std::is_same_v<Analysis, Explicit<dim>>)
    if (!stage_is_over) warm = {analysis.warm_velocity(), analysis.warm_acceleration()};
  checkpoint.set("warm velocity", std::move(warm.velocity));
  checkpoint.set("warm acceleration", std::move(warm.acceleration));
  results_->add_checkpoint(checkpoint);
  // A run that goes on from here has nothing kept in its solvers, so neither has this one.
  analysis.renew_solver();
  checkpoint_step_ = model_.step, checkpoint_time_ = model_.time;
}

/// The row after the last step: energies of the state that no further step starts from.
template <int dim>
void Run<dim>::add_last_row(Explicit<dim>& analysis) {
  Row<dim> row;
  row.dt = last_dt_;
  if (case_.output.energies) analysis.measure(row.energy);
  measure_spectrum(analysis.options(), row);
  row.reactions = model_.reactions;
  row.tracked = tracked_.now(model_);
  add_row(model_.step, model_.time, row);
}

template <int dim>
void Run<dim>::measure_spectrum(const ExplicitOptions& options, Row<dim>& row) {
  const OutputOptions& output = case_.output;
  if (!output.condition_numbers && !output.critical_time_step) return;
  const auto timer = model_.timers.start("condition number, critical time step");
  model_.settle();
  ExplicitSpectrum<dim> spectrum(model_, options);
  if (output.condition_numbers) row.condition = spectrum.condition();
  if (output.critical_time_step) row.critical_time_step = spectrum.critical_time_step();
}

/// A row of an explicit step tells of the state that it starts from: energies at the time of its forces.
template <int dim>
void Run<dim>::stage(const ExplicitOptions& options) {
  Explicit<dim> analysis(model_, options);
  if (warm_) analysis.warm_velocity() = warm_->velocity, analysis.warm_acceleration() = warm_->acceleration;
  warm_.reset();
  Progress progress(stage_title(),
                    talk_ == Talk::normal ? Progress::Style::automatic : Progress::Style::quiet);
  std::string remark;  // energies of the last row
  while (model_.time < stage_end()) {
    try {
      if (rebalance()) analysis.warm_velocity().clear(), analysis.warm_acceleration().clear();
    } catch (const RunError& error) {
      stop(analysis, error.what());
    }
    const double time = model_.time, work = model_.external_work;
    const std::int64_t step = model_.step;
    const bool row_is_due = row_due(), energies = row_is_due && case_.output.energies;
    Row<dim> row;
    if (row_is_due) row.tracked = tracked_.now(model_), measure_spectrum(options, row);
    row.dt = last_dt_ = analysis.time_step(stage_end());
    try {
      analysis.step(row.dt, energies ? &row.energy : nullptr);
    } catch (const RunError& error) {
      stop(analysis, error.what());
    }
    ++step_in_stage_;
    // Times of equal steps are summed, and their number may have been changed when the run went on.
    const bool last = stage_end() - model_.time <= (options.steps ? 1e-3 : 1e-9) * row.dt;
    if (last) model_.time = stage_end();  // sums of steps miss it by rounding
    if (row_is_due) {
      row.energy.external_work = work;
      row.reactions = model_.reactions;
      add_row(step, time, row);
    }
    if (energies) check_balance(analysis, row.energy, work);
    if (energies)
      remark = fmt::format("  kinetic {:.4g} J  strain {:.4g} J", row.energy.kinetic, row.energy.strain);
    if (progress.wants_update(share_done()))
      progress.update(share_done(), fmt::format("step {}{}", model_.step, remark));
    after_step(analysis, time, progress);
  }
}

template <int dim>
template <class Options>
void Run<dim>::stage(const Options& options) {
  Implicit<dim> analysis(model_, options);
  warm_.reset();
  Progress progress(stage_title(),
                    talk_ == Talk::normal ? Progress::Style::automatic : Progress::Style::quiet);
  if (row_due()) {
    Row<dim> row;
    row.energy = energies_of_points(model_), row.reactions = model_.reactions,
    row.tracked = tracked_.now(model_);
    add_row(model_.step, model_.time, row);
  }
  while (step_in_stage_ < options.steps) {
    rebalance();
    const double time = model_.time;
    const std::int64_t next = step_in_stage_ + 1;
    const double target = next == options.steps
                              ? stage_end()
                              : stage_start_ + options.duration * (static_cast<double>(next) / options.steps);
    Row<dim> row;
    // Ends of steps are not summed, so that a step that was halted midway ends where it should have.
    row.dt = target - time;
    try {
      row.newton = analysis.step(row.dt, &row.energy);
    } catch (const RunError& error) {
      stop(analysis, error.what());
    }
    step_in_stage_ = next;
    model_.time = target;
    if (row_due() || next == options.steps) {
      row.reactions = model_.reactions, row.tracked = tracked_.now(model_);
      if (case_.output.condition_numbers)
        row.condition = condition_number(analysis.stiffness(), analysis.unknowns());
      add_row(model_.step, model_.time, row);
    }
    if (progress.wants_update(share_done()))
      progress.update(share_done(), fmt::format("step {}  {} iterations  residual {:.2e}", model_.step,
                                                row.newton->iterations, row.newton->residuals.back()));
    after_step(analysis, time, progress);
  }
}

/// Calls f with the dimension of a case as a constant.
template <class F>
void with_dimension(const Case& c, F&& f) {
  if (c.dimension == 2)
    f(std::integral_constant<int, 2>());
  else
    f(std::integral_constant<int, 3>());
}

}  // namespace

void run_case(const Case& c, const fs::path& folder, Talk talk) {
  with_dimension(c, [&](auto dim) { Run<dim()>(c, folder, talk, c).start(); });
}

void resume_run(const fs::path& folder, const std::vector<std::string>& changes, Talk talk) {
  check_changes(changes);
  std::vector<std::string> passed_over;
  std::optional<CheckpointParts> parts;
  if (checkpoint_sets(folder).front().ranks != Session::size())
    parts = latest_checkpoint_parts(folder, &passed_over);
  const Checkpoint first =
      parts ? parts->read(0) : read_latest_checkpoint(folder, output_ranks(), &passed_over);
  if (talk == Talk::normal && Session::rank() == 0)
    for (const auto& reason : passed_over) fmt::print("passed over: {}\n", reason);
  const Case c = stored_case(first, changes), begun = begun_case(first);
  with_dimension(c, [&](auto dim) {
    Run<dim()>(c, folder, talk, begun).resume(first, parts ? &*parts : nullptr, !changes.empty());
  });
}

}  // namespace wisp
