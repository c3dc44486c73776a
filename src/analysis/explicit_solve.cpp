// The equation of motion on the grid: mass, velocity, acceleration, and what holds.
#include <cmath>

#include "analysis/explicit.h"
#include "core/error.h"
#include "stabilise/ghost.h"
#include "transfer/active.h"
#include "transfer/density.h"
#include "transfer/mass.h"

namespace wisp {

namespace {
/// What local non-viscous damping (Cundall 1987) takes from an out-of-balance force: a share of it, against
/// the velocity.
double damped(double share, double force, double velocity) {
  return share * std::abs(force) * (velocity > 0 ? 1.0 : velocity < 0 ? -1.0 : 0.0);
}
}  // namespace

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
    if (reconstructs_density()) add_density_pattern(space, model_.bodies, cells, mass_);
    add_ghost_pattern(space, facets, mass_);
    mass_.end_pattern();
    if (with_ghost) {
      ghost_mass_.share_pattern(mass_);
      add_ghost(space, facets, *ghost, GhostMatrix::mass, ghost_mass_);
    }
    if (reconstructs_density()) field_mass_.share_pattern(mass_);
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
  const std::span<const char> fixed =
      model_.constraints.any ? std::span<const char>(model_.constraints.fixed) : std::span<const char>();
  if (reconstructs_density()) {
    field_mass_.zero();
    field_mass_.add_matrix(1.0, mass_);
    exchange_mass(space, model_.bodies, cells, field_mass_);
    field_equation_.set_matrix(field_mass_, space.nodes(), dim, active, fixed, lumped);
  }
  equation_.set_matrix(mass_, space.nodes(), dim, std::move(active), fixed, std::move(lumped), boundary);
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
  MassEquation& equation = reconstructs_density() ? field_equation_ : equation_;
  const SolveReport report = equation.solve(right_side_, acceleration_);
  ++solves_, iterations_ += report.iterations;
  if (!report.solved)
    run_error(
        "step {} at t = {:.6g} s: the solve for the acceleration failed ({}); add [stabilisation], or use "
        "mass = \"lumped\"",
        model_.step, model_.time, report.cause);
}

/// Motion of the points' functions from velocity and acceleration (eq. 11).
template <int dim>
void Explicit<dim>::set_motion(double dt) {
  const auto n = static_cast<std::size_t>(model_.space->n_functions());
  motion_.resize(n * motion_stride<dim>);
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t d = 0; d < dim; ++d) {
      const double a = acceleration_[i * dim + d], v = velocity_[i * dim + d] + dt * a;
      motion_[i * motion_stride<dim> + d] = v, motion_[i * motion_stride<dim> + dim + d] = a;
      sum += v * v + a * a;
    }
  check_finite(sum);
}

/// Everything between the sums and the motion with a lumped mass, in one pass over the functions (Coombs
/// 2023, eq. 10 and 11): a function's numbers are read and written once.
template <int dim>
void Explicit<dim>::advance_lumped(double dt) {
  const auto n = static_cast<std::size_t>(model_.space->n_functions());
  auto& constraints = model_.constraints;
  velocity_.resize(n * dim), acceleration_.resize(n * dim), right_side_.resize(n * dim);
  motion_.resize(n * motion_stride<dim>);
  const double* const sums = sums_.data();
  const double* const loads = loads_.empty() ? nullptr : loads_.data();
  double* const velocity = velocity_.data();
  double* const acceleration = acceleration_.data();
  double* const force = right_side_.data();
  double* const motion = motion_.data();
  const double damping = options_.damping;
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double* const s = sums + i * sums_stride<dim>;
    const double per_mass = s[0] > 0 ? 1.0 / s[0] : 0.0;
    double squares = 0.0;
    for (std::size_t d = 0; d < dim; ++d) {
      const std::size_t k = i * dim + d;
      const double v = s[1 + d] * per_mass;
      double f = s[1 + dim + d];
      if (loads) f += loads[k];
      if (damping > 0) f -= damped(damping, f, v);
      const double a = f * per_mass, end = v + dt * a;
      velocity[k] = v, acceleration[k] = a, force[k] = f;
      motion[i * motion_stride<dim> + d] = end, motion[i * motion_stride<dim> + dim + d] = a;
      squares += end * end + a * a;
    }
    sum += squares;
  }
  prescribe(model_.time, velocity_);
  if (constraints.any) set_velocities(model_.boundaries, model_.time, dt, constraints);
  for (const std::size_t k : constraints.held) {
    // The force of an unknown that is held by a velocity is damped by that velocity.
    if (damping > 0) {
      const double f = sums[k / dim * sums_stride<dim> + 1 + dim + k % dim] + (loads ? loads[k] : 0.0);
      force[k] = f - damped(damping, f, velocity[k]);
    }
    const double end = constraints.prescribed(k), a = (end - velocity[k]) / dt;
    acceleration[k] = a;
    double* const m = motion + k / dim * motion_stride<dim> + k % dim;
    m[0] = velocity[k] + dt * a, m[dim] = a;
    sum += m[0] * m[0] + a * a;
  }
  check_finite(sum);
}

/// R = M a - f at a held unknown.
template <int dim>
double Explicit<dim>::reaction(std::size_t k) const {
  return (consistent_ ? inertia_[k] : sums_[k / dim * sums_stride<dim>] * acceleration_[k]) - right_side_[k];
}

/// Reactions R = M a - f of held unknowns.
template <int dim>
void Explicit<dim>::find_reactions() {
  if (!model_.constraints.any) return;
  if (consistent_) {
    inertia_.resize(acceleration_.size());
    (reconstructs_density() ? field_mass_ : mass_).multiply_columns(acceleration_, inertia_, dim);
    model_.space->nodes().add(inertia_.data(), dim);
  }
  for (auto& r : model_.reactions) r.setZero();
  for (const std::size_t k : model_.constraints.held)
    if (model_.space->nodes().owns(static_cast<int>(k / dim)))
      model_
          .reactions[static_cast<std::size_t>(model_.constraints.condition[k])][static_cast<int>(k % dim)] +=
          reaction(k);
  for (auto& r : model_.reactions) r = Session::sum(r);
}

template class Explicit<2>;
template class Explicit<3>;

}  // namespace wisp
