// The mass of an explicit step: its matrix, and what is solved with it.
#include "analysis/explicit.h"
#include "core/error.h"
#include "transfer/active.h"
#include "transfer/mass.h"

namespace wisp {

template <int dim>
void Explicit<dim>::assemble_mass() {
  const auto& space = *model_.space;
  const ActiveCells cells = active_cells(space, model_.bodies);
  const auto& ghost = model_.options.stabilisation;
  // A series of the mass converges without a penalty, not with one.
  const bool with_ghost = ghost && options_.mass == Mass::consistent;
  // Points without domains meet the functions of their cells: the same cells, the same pattern and penalty.
  const bool kept = Session::size() == 1 && !space.domains() && cells.bits == mass_cells_.bits &&
                    mass_.n_local() == space.n_functions();
  if (!kept) {
    std::vector<GhostFacet> facets;
    if (with_ghost)
      facets = ghost_facets(space, cells, model_.bodies, held_edges(model_.boundaries), ghost->elements);
    mass_.begin_pattern(space.n_functions());
    add_point_pattern(space, model_.bodies, mass_);
    add_ghost_pattern(space, facets, mass_);
    mass_.end_pattern();
    if (with_ghost) {
      ghost_mass_.share_pattern(mass_);
      add_ghost(space, facets, *ghost, GhostMatrix::mass, ghost_mass_);
    }
    mass_cells_ = cells;
  }
  mass_.zero();
  add_consistent_mass(space, model_.bodies, mass_);
  if (with_ghost) mass_.add_matrix(1.0, ghost_mass_);
  std::vector<char> active = active_functions(space, with_ghost ? ghost_cells(space, cells, *ghost) : cells);
  for (std::size_t i = 0; i < active.size(); ++i)
    if (!with_ghost && sums_[i * sums_stride<dim>] <= 0.0) active[i] = 0;
  std::vector<double> lumped(active.size());
  for (std::size_t i = 0; i < active.size(); ++i) lumped[i] = sums_[i * sums_stride<dim>];
  std::vector<char> boundary;
  if (options_.mass == Mass::partial) boundary = boundary_functions(space, cells);
  equation_.set_matrix(
      mass_, space.nodes(), dim, std::move(active),
      model_.constraints.any ? std::span<const char>(model_.constraints.fixed) : std::span<const char>(),
      std::move(lumped), boundary);
}

/// The projected step needs no velocity at its start but for what asks for one: the last projection is at
/// hand. With a lumped mass it is found on the way.
template <int dim>
bool Explicit<dim>::needs_start_velocity(bool recorded) const {
  if (options_.stress_update == StressUpdate::usf) return true;
  if (!consistent_) return false;
  const auto n = static_cast<std::size_t>(model_.space->n_functions()) * dim;
  return options_.stress_update != StressUpdate::projected || recorded || !walls_.empty() ||
         options_.velocity_update != VelocityUpdate::flip || options_.pic_fraction > 0 ||
         options_.damping > 0 || velocity_.size() != n;
}

/// Sets the velocity of held unknowns to that at time t.
template <int dim>
void Explicit<dim>::prescribe(double t, std::vector<double>& velocity) {
  auto& constraints = model_.constraints;
  if (!constraints.any) return;
  set_velocities(model_.boundaries, t - dt_, dt_, constraints);
  for (const std::size_t k : constraints.held) velocity[k] = constraints.prescribed(k);
}

/// Velocity from the gathered momentum (Coombs 2023, eq. 10); prescribed where a condition holds, as at time
/// t.
template <int dim>
void Explicit<dim>::solve_velocity(double t, std::vector<double>& velocity) {
  const auto n = static_cast<std::size_t>(model_.space->n_functions());
  velocity.resize(n * dim, 0.0);
  if (!consistent_) {
    for (std::size_t i = 0; i < n; ++i) {
      const double* const s = sums_.data() + i * sums_stride<dim>;
      const double per_mass = s[0] > 0 ? 1.0 / s[0] : 0.0;
      for (std::size_t d = 0; d < dim; ++d) velocity[i * dim + d] = s[1 + d] * per_mass;
    }
    prescribe(t, velocity);
    return;
  }
  right_side_.resize(n * dim);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t d = 0; d < dim; ++d) right_side_[i * dim + d] = sums_[i * sums_stride<dim> + 1 + d];
  prescribe(t, velocity);
  const SolveReport report = equation_.solve(right_side_, velocity);
  ++solves_, iterations_ += report.iterations;
  if (!report.solved)
    run_error(
        "step {} at t = {:.6g} s: the velocity solve with the consistent mass failed ({}); add "
        "[stabilisation], or use mass = \"lumped\"",
        model_.step, model_.time, report.cause);
}

/// The same for the acceleration with the consistent mass; held unknowns reach their velocity at the end of
/// the step.
template <int dim>
void Explicit<dim>::solve_acceleration(double dt) {
  const auto n = static_cast<std::size_t>(model_.space->n_functions());
  auto& constraints = model_.constraints;
  acceleration_.resize(n * dim, 0.0);
  right_side_.resize(n * dim);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t d = 0; d < dim; ++d) {
      double f = sums_[i * sums_stride<dim> + 1 + dim + d];
      if (!loads_.empty()) f += loads_[i * dim + d];
      if (options_.damping > 0) f -= damped(options_.damping, f, velocity_[i * dim + d]);
      right_side_[i * dim + d] = f;
    }
  if (constraints.any) set_velocities(model_.boundaries, model_.time, dt, constraints);
  for (const std::size_t k : constraints.held)
    acceleration_[k] = (constraints.prescribed(k) - velocity_[k]) / dt;
  const SolveReport report = equation_.solve(right_side_, acceleration_);
  ++solves_, iterations_ += report.iterations;
  if (!report.solved)
    run_error(
        "step {} at t = {:.6g} s: the solve for the acceleration failed ({}); add [stabilisation], or use "
        "mass = \"lumped\"",
        model_.step, model_.time, report.cause);
}

/// The second map: velocity of the points just found, by the functions and the mass of this step. The
/// projected step also moves the points by it (de Koster et al. 2021; thesis, eq. 2.37-2.39).
template <int dim>
void Explicit<dim>::map_again(double dt) {
  {
    const auto timer = model_.timers.start(1);
    gather(Gather::inertia);
    // The solve starts from the velocity just found, not from an array that a resumed run would not have.
    strain_velocity_.resize(velocity_.size());
    for (std::size_t k = 0; k < velocity_.size(); ++k)
      strain_velocity_[k] = velocity_[k] + dt * acceleration_[k];
    solve_velocity(model_.time + dt, strain_velocity_);
  }
  if (!walls_.empty()) correct_strain_velocity(false);
  if (options_.stress_update != StressUpdate::projected) return;
  velocity_ = strain_velocity_;
  for (std::size_t k = 0; k < velocity_.size(); ++k)
    motion_[k / dim * motion_stride<dim> + k % dim] = velocity_[k];
}

template class Explicit<2>;
template class Explicit<3>;

}  // namespace wisp
