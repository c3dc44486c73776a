// Implicit analyses: quasi-static equilibrium, and dynamics by Newmark on the same residual.
#pragma once
#include <optional>

#include "analysis/model.h"
#include "analysis/options.h"
#include "analysis/record.h"
#include "linear/block_matrix.h"
#include "linear/dof_map.h"
#include "linear/newton.h"
#include "linear/system_matrix.h"
#include "stabilise/ghost.h"
#include "transfer/implicit_transfer.h"

namespace wisp {

/// One implicit stage. Unknown: the displacement u of the grid functions over the step. Residual (all
/// functions)
///     r = f_ext - f_int(u) - K_G u - (M + M_G) a(u) + reactions,
/// without the inertia in quasi-static analyses (Coombs 2023, eq. 12, 25). Reactions are accumulated from the
/// linearised equations as in the AMPLE code, which the paper's iteration counts come from (Coombs and
/// Augarde 2020).
template <int dim>
class Implicit {
 public:
  Implicit(Model<dim>& model, const QuasiStaticOptions& options);
  Implicit(Model<dim>& model, const ImplicitDynamicOptions& options);

  /// Length of a step (s).
  double time_step() const { return duration_ / steps_; }
  /// One step, halved up to `cuts` times where Newton fails. Errors (RunError): it fails all the same.
  ImplicitRecord step(double dt, EnergyRecord* record = nullptr);

  /// Whether a step that failed had begun to move points; otherwise the state that `model` tells of stands
  /// (of a step that was cut: what has been done of it).
  bool points_changed() const { return points_changed_; }
  /// Drops what the solver keeps between steps, as in a run that starts here.
  void renew_solver();

  /// The tangent of the last Newton iteration with Ghost, over all local functions, and its free unknowns.
  const BlockMatrix& stiffness() const { return stiffness_; }
  const DofMap& unknowns() const { return dofs_; }
  /// Displacement (m) of the local functions over the last step, n_functions x dim.
  const std::vector<double>& displacement() const { return displacement_; }

 private:
  struct Newmark {
    double beta, gamma;
  };

  void prepare();
  NewtonReport attempt(double dt);
  void set_up(double dt);
  void set_up_matrices(const ActiveCells& cells, double dt);
  void number_unknowns();
  void external_force(double t, std::vector<double>& force) const;
  void start_inertia(double dt);
  void start_walls(const ActiveCells& cells, double dt);
  void assemble_walls();
  void add_walls(std::span<const double> u, std::vector<double>& action);
  void add_wall_stiffness();
  void finish_walls(std::span<const double> u, double dt);
  double residual(std::span<const double> u, double dt);
  std::string correct(std::span<double> du, std::span<const double> u, double dt);
  void finish(std::span<const double> u, double dt);
  void update_velocities(std::span<const double> u, double dt);
  void advance(double dt, int cuts_left, ImplicitRecord& record);
  std::vector<double> acceleration(std::span<const double> u, double dt) const;

  Model<dim>& model_;
  double duration_;
  int steps_;
  int cuts_;
  NewtonOptions newton_;
  std::optional<Newmark> newmark_;
  int evaluations_ = 0;
  bool points_changed_ = false;
  double inertia_scale_ = 0.0;  // N

  std::vector<StoredStencils<dim>> stencils_;
  std::vector<char> active_;
  DofMap dofs_;
  std::optional<GhostOptions> ghost_options_;
  bool walls_ = false;
  BlockMatrix ghost_{1}, mass_{1}, stiffness_{dim}, wall_matrix_{dim};
  SystemMatrix system_;
  LinearSolver solver_;
  // n_functions x dim each
  std::vector<double> external_, start_external_, force_, reaction_, residual_, prescribed_, velocity_,
      acceleration_, wall_force_, wall_action_, displacement_;
};

}  // namespace wisp
