// Explicit dynamics.
#pragma once
#include "analysis/model.h"
#include "analysis/options.h"
#include "analysis/record.h"
#include "boundary/wall_contact.h"
#include "stabilise/ghost.h"
#include "stabilise/mass_equation.h"
#include "transfer/explicit_transfer.h"

namespace wisp {

/// The walls among the boundaries of a model.
template <int dim>
std::vector<Wall<dim>> walls_of(const std::vector<AnyBoundary<dim>>& boundaries);

/// One explicit stage: owns the order of the operations of a step, which are also the names of its timers.
template <int dim>
class Explicit {
 public:
  Explicit(Model<dim>& model, const ExplicitOptions& options);

  /// Length of the next step (s): given, or by the CFL number from the present wave and point speeds; never
  /// beyond `end`. Errors (RunError): CFL with no wave speed.
  double time_step(double end) const;

  /// One step of length dt. With `record`, energies at the time level of the forces.
  /// Errors (RunError): mass solve failed, velocities not finite, points left the grid.
  void step(double dt, EnergyRecord* record = nullptr);

  /// Energies of the present state, as the next step would record them before its forces are used.
  /// Errors (RunError): mass solve failed.
  void measure(EnergyRecord& record);

  const ExplicitOptions& options() const { return options_; }
  /// Start-of-step velocity (n_functions x dim) and, for the consistent mass, the matrix with Ghost of the
  /// last step.
  std::span<const double> start_velocity() const { return velocity_; }
  const BlockMatrix& mass() const { return mass_; }
  /// Mean over all solves with the consistent mass so far, 0 without any.
  double iterations_per_solve() const {
    return solves_ > 0 ? static_cast<double>(iterations_) / static_cast<double>(solves_) : 0.0;
  }
  /// Warm starts that a resumed run needs for the same bits.
  std::vector<double>& warm_acceleration() { return acceleration_; }
  std::vector<double>& warm_velocity() { return velocity_; }
  /// Whether a step that failed had changed points already; otherwise the state before it stands.
  bool points_changed() const { return points_changed_; }
  /// Drops what the solver keeps between steps, as in a run that starts here.
  void renew_solver();

 private:
  void gather(Gather what, const FollowedMotion& followed = {});
  void assemble_mass();
  bool reconstructs_density() const { return options_.integration == Integration::reconstructed_mass; }
  void prescribe(double t, std::vector<double>& velocity);
  void solve_velocity(double t, std::vector<double>& velocity);
  void solve_acceleration(double dt);
  void set_motion(double dt);
  void advance_lumped(double dt);
  double reaction(std::size_t k) const;
  void find_reactions();
  void check_finite(double sum) const;
  void record_energy(EnergyRecord& record) const;
  void add_work(double dt);
  void points(const PointUpdate& update);
  void project_velocity(double dt);
  // Walls, explicit_walls.cpp: their hooks in the order of a step.
  StepMass step_mass();
  void find_walls();
  void correct_strain_velocity(bool alone);
  void correct_acceleration(double dt);
  void record_walls();
  void calm_light_functions(PointUpdate& update);

  Model<dim>& model_;
  ExplicitOptions options_;
  bool consistent_;
  double dt_ = 0.0;  // of the running step
  bool points_changed_ = false;
  // Arrays over functions; see explicit_transfer.h for the records.
  RecordArray sums_, motion_;
  std::vector<double> velocity_, strain_velocity_, acceleration_, loads_, right_side_, inertia_;
  std::vector<double> gradients_;  // of one body, where forces are reconstructed
  BlockMatrix mass_{1}, ghost_mass_{1};
  BlockMatrix field_mass_{1};  // of the reconstructed density, for the acceleration
  ActiveCells mass_cells_;     // for which their pattern was made
  MassEquation equation_, field_equation_;
  std::int64_t solves_ = 0, iterations_ = 0;
  WallContact<dim> walls_;
};

}  // namespace wisp
