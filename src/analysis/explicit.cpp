#include "analysis/explicit.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "transfer/active.h"
#include "transfer/explicit_transfer.h"
#include "transfer/mass.h"
#include "transfer/reconstruction.h"

namespace wisp {

namespace {
MassSolverOptions mass_solver_options(const SolverOptions& solver) {
  MassSolverOptions options;
  options.solver = solver.solver;
  options.max_iterations = solver.max_iterations;
  return options;
}
}  // namespace

template <int dim>
Explicit<dim>::Explicit(Model<dim>& model, const ExplicitOptions& options)
    : model_(model),
      options_(options),
      consistent_(options.mass != Mass::lumped),
      equation_({options.mass, options.fmpm_order, options.deactivate_below},
                mass_solver_options(model.options.solver)) {
  if (options.velocity_update == VelocityUpdate::apic)
    for (auto& body : model_.bodies)
      if (body.points.affine.empty())
        body.points.affine.assign(body.points.position.size(), Mat<dim>::Zero());
  for (const char* name : {"1 locate, stencils", "2 mass, momentum, forces to grid", "3 contributions",
                           "4 solve for acceleration", "5-7 grid to points, deformation, stress, move"})
    model_.timers.part(name);
}

template <int dim>
void Explicit<dim>::renew_solver() {
  equation_.renew();
}

template <int dim>
double Explicit<dim>::time_step(double end) const {
  const double rest = end - model_.time;
  if (options_.dt) {
    // A rest of less than a millionth of a step is rounding, not a step.
    return rest < *options_.dt * (1.0 + 1e-6) ? rest : *options_.dt;
  }
  if (options_.steps) return options_.duration / *options_.steps;
  double speed = 0.0;
  bool any_wave = false;
  for (const auto& body : model_.bodies) {
    const double wave = body.density() > 0 ? std::sqrt(body.p_wave_modulus() / body.density()) : 0.0;
    any_wave |= wave > 0;
    double fastest = 0.0;
    for (const auto& v : body.points.velocity) fastest = std::max(fastest, v.squaredNorm());
    speed = std::max(speed, wave + std::sqrt(fastest));
  }
  if (!any_wave)
    run_error(
        "explicit: no body has a wave speed (stiffness or density is zero), so the CFL number gives no time "
        "step; set dt or steps");
  return std::min(rest, options_.cfl * model_.space->shortest_extent() / Session::max(speed));
}

template <int dim>
void Explicit<dim>::gather(Gather what, const FollowedMotion& followed) {
  const auto n = static_cast<std::size_t>(model_.space->n_functions());
  sums_.assign(n * sums_stride<dim>, 0.0);
  const Vec<dim> gravity = model_.gravity(model_.time);
  for (const auto& body : model_.bodies)
    points_to_grid<dim>(*model_.space, body, what, gravity, options_.velocity_update == VelocityUpdate::apic,
                        sums_, followed);
  if (what != Gather::inertia && options_.integration == Integration::reconstructed)
    add_reconstruction<dim>(*model_.space, model_.bodies, active_cells(*model_.space, model_.bodies), sums_);
  model_.space->nodes().add_update(sums_.data(), sums_stride<dim>);
}

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

/// Velocities that conditions prescribe at time t.
template <int dim>
void Explicit<dim>::prescribe(double t, std::vector<double>& velocity) {
  auto& constraints = model_.constraints;
  set_velocities(model_.boundaries, t - dt_, dt_, constraints);
  for (std::size_t k = 0; k < constraints.fixed.size(); ++k)
    if (constraints.fixed[k]) velocity[k] = constraints.prescribed(k);
}

/// Velocity from the gathered momentum (Coombs 2023, eq. 10); prescribed where a condition holds, as at time
/// t.
template <int dim>
void Explicit<dim>::solve_velocity(double t, std::vector<double>& velocity) {
  const auto n = static_cast<std::size_t>(model_.space->n_functions());
  velocity.resize(n * dim, 0.0);
  const auto& constraints = model_.constraints;
  if (!consistent_) {
    for (std::size_t i = 0; i < n; ++i) {
      const double* const s = sums_.data() + i * sums_stride<dim>;
      const double per_mass = s[0] > 0 ? 1.0 / s[0] : 0.0;
      for (std::size_t d = 0; d < dim; ++d) velocity[i * dim + d] = s[1 + d] * per_mass;
    }
    if (constraints.any) prescribe(t, velocity);
    return;
  }
  right_side_.resize(n * dim);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t d = 0; d < dim; ++d) right_side_[i * dim + d] = sums_[i * sums_stride<dim> + 1 + d];
  if (constraints.any) prescribe(t, velocity);
  const SolveReport report = equation_.solve(right_side_, velocity);
  if (!report.solved)
    run_error(
        "step {} at t = {:.6g} s: the velocity solve with the consistent mass failed ({}); add "
        "[stabilisation], or use mass = \"lumped\"",
        model_.step, model_.time, report.cause);
}

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
      // Local non-viscous damping (Cundall 1987): a share of the out-of-balance force, against the velocity.
      if (options_.damping > 0)
        f -= options_.damping * std::abs(f) *
             (velocity_[i * dim + d] > 0   ? 1.0
              : velocity_[i * dim + d] < 0 ? -1.0
                                           : 0.0);
      right_side_[i * dim + d] = f;
    }
  if (constraints.any) set_velocities(model_.boundaries, model_.time, dt, constraints);
  for (std::size_t k = 0; k < constraints.fixed.size(); ++k)
    if (constraints.fixed[k]) acceleration_[k] = (constraints.prescribed(k) - velocity_[k]) / dt;
  if (consistent_) {
    const SolveReport report = equation_.solve(right_side_, acceleration_);
    if (!report.solved)
      run_error(
          "step {} at t = {:.6g} s: the solve for the acceleration failed ({}); add [stabilisation], or use "
          "mass = \"lumped\"",
          model_.step, model_.time, report.cause);
  } else {
    for (std::size_t i = 0; i < n; ++i) {
      const double mass = sums_[i * sums_stride<dim>];
      const double per_mass = mass > 0 ? 1.0 / mass : 0.0;
      for (std::size_t d = 0; d < dim; ++d)
        if (constraints.fixed.empty() || !constraints.fixed[i * dim + d])
          acceleration_[i * dim + d] = right_side_[i * dim + d] * per_mass;
    }
  }
}

/// End-of-step velocity (eq. 11) and acceleration side by side, as the points read them; reactions on the
/// way.
template <int dim>
void Explicit<dim>::set_motion(double dt) {
  const auto n = static_cast<std::size_t>(model_.space->n_functions());
  motion_.resize(n * motion_stride<dim>);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t d = 0; d < dim; ++d) {
      motion_[i * motion_stride<dim> + d] = velocity_[i * dim + d] + dt * acceleration_[i * dim + d];
      motion_[i * motion_stride<dim> + dim + d] = acceleration_[i * dim + d];
    }
  if (!model_.constraints.any) return;
  // R = M a - f at held unknowns.
  if (consistent_) {
    inertia_.resize(n * dim);
    mass_.multiply_columns(acceleration_, inertia_, dim);
    model_.space->nodes().add(inertia_.data(), dim);
  }
  for (auto& r : model_.reactions) r.setZero();
  for (std::size_t i = 0; i < n; ++i) {
    if (!model_.space->nodes().owns(static_cast<int>(i))) continue;
    for (std::size_t d = 0; d < dim; ++d) {
      const std::size_t k = i * dim + d;
      if (!model_.constraints.fixed[k]) continue;
      const double ma = consistent_ ? inertia_[k] : sums_[i * sums_stride<dim>] * acceleration_[k];
      model_.reactions[static_cast<std::size_t>(model_.constraints.condition[k])][static_cast<int>(d)] +=
          ma - right_side_[k];
    }
  }
  for (auto& r : model_.reactions) r = Session::sum(r);
}

template <int dim>
void Explicit<dim>::check_finite() const {
  double sum = 0.0;
  for (const double m : motion_) sum += m * m;
  if (!std::isfinite(Session::sum(sum)))
    run_error(
        "step {} at t = {:.6g} s: grid velocities are not finite: the step is longer than the stable one, or "
        "nearly empty cells "
        "have no stabilisation; try a smaller dt or cfl, or add [stabilisation] with mass = \"consistent\"",
        model_.step, model_.time);
}

template <int dim>
void Explicit<dim>::record_energy(EnergyRecord& record) const {
  record = {};
  for (const auto& body : model_.bodies) {
    record.grid_kinetic += grid_kinetic_energy<dim>(*model_.space, body, velocity_, dim);
    const BodyEnergy e = energy(body);
    record.kinetic += e.kinetic, record.strain += e.strain, record.dissipation += e.dissipation;
  }
  Vec<4> sum = Session::sum(Vec<4>(record.kinetic, record.strain, record.dissipation, record.grid_kinetic));
  record.kinetic = sum[0], record.strain = sum[1], record.dissipation = sum[2], record.grid_kinetic = sum[3];
  record.external_work = model_.external_work;
}

template <int dim>
void Explicit<dim>::measure(EnergyRecord& record) {
  model_.settle();
  gather(Gather::inertia);
  if (consistent_) assemble_mass();
  solve_velocity(model_.time, velocity_);
  record_energy(record);
}

/// Work of body forces and loads on the end-of-step velocity, and of prescribed motion against its reactions.
template <int dim>
void Explicit<dim>::add_work(double dt) {
  const Vec<dim> gravity = model_.gravity(model_.time);
  if (gravity.isZero() && loads_.empty() && !model_.constraints.any) return;
  double work = 0.0;
  for (std::size_t i = 0; i < sums_.size() / sums_stride<dim>; ++i) {
    if (!model_.space->nodes().owns(static_cast<int>(i))) continue;
    for (std::size_t d = 0; d < dim; ++d) {
      double f = sums_[i * sums_stride<dim>] * gravity[static_cast<int>(d)];
      if (!loads_.empty()) f += loads_[i * dim + d];
      const std::size_t k = i * dim + d;
      if (model_.constraints.any && model_.constraints.fixed[k])
        f += (consistent_ ? inertia_[k] : sums_[i * sums_stride<dim>] * acceleration_[k]) - right_side_[k];
      work += dt * f * motion_[i * motion_stride<dim> + d];
    }
  }
  model_.external_work += Session::sum(work);
}

template <int dim>
void Explicit<dim>::points(const PointUpdate& update) {
  points_changed_ = true;
  for (auto& body : model_.bodies) grid_to_points<dim>(*model_.space, body, update);
}

/// The second map: velocity of the points just found, by the functions and the mass of this step (de Koster
/// et al. 2021; thesis, eq. 2.37).
template <int dim>
void Explicit<dim>::project_velocity(double dt) {
  const auto timer = model_.timers.start(1);
  gather(Gather::inertia);
  // The solve starts from the velocity just found, not from an array that a resumed run would not have.
  strain_velocity_.resize(velocity_.size());
  for (std::size_t k = 0; k < velocity_.size(); ++k)
    strain_velocity_[k] = velocity_[k] + dt * acceleration_[k];
  solve_velocity(model_.time + dt, strain_velocity_);
  if (options_.stress_update != StressUpdate::projected) return;
  velocity_ = strain_velocity_;
  for (std::size_t i = 0; i < velocity_.size() / dim; ++i)
    for (std::size_t d = 0; d < dim; ++d) motion_[i * motion_stride<dim> + d] = strain_velocity_[i * dim + d];
}

template <int dim>
void Explicit<dim>::step(double dt, EnergyRecord* record) {
  dt_ = dt;
  points_changed_ = false;
  const StressUpdate scheme = options_.stress_update;
  const bool pic = options_.velocity_update != VelocityUpdate::flip;
  PointUpdate update;
  update.dt = dt;
  update.flip = pic ? 0.0 : 1.0 - options_.pic_fraction;
  update.apic = options_.velocity_update == VelocityUpdate::apic;
  {
    const auto timer = model_.timers.start(0);
    model_.settle();
  }
  {
    const auto timer = model_.timers.start(1);
    gather(scheme == StressUpdate::usf ? Gather::inertia : Gather::both);
  }
  {
    const auto timer = model_.timers.start(2);
    if (consistent_) assemble_mass();
    if (model_.has_loads()) {
      loads_.assign(static_cast<std::size_t>(model_.space->n_functions()) * dim, 0.0);
      model_.add_loads(model_.time, loads_);
      model_.space->nodes().add_update(loads_.data(), dim);
    }
  }
  {
    const auto timer = model_.timers.start(3);
    const auto n = static_cast<std::size_t>(model_.space->n_functions()) * dim;
    // The projected step needs no velocity at its start but for what asks for one; the last projection is at
    // hand.
    if (scheme != StressUpdate::projected || record || pic || options_.pic_fraction > 0 ||
        options_.damping > 0 || velocity_.size() != n)
      solve_velocity(model_.time, velocity_);
    else
      prescribe(model_.time, velocity_);
  }
  if (scheme == StressUpdate::usf) {
    PointUpdate strain = update;
    // Mass and forces of a step share their functions, so domains wait for the end of the step.
    strain.strain = true, strain.strain_velocity = velocity_, strain.domains = false;
    {
      const auto timer = model_.timers.start(4);
      points(strain);
    }
    const auto timer = model_.timers.start(1);
    gather(Gather::both, {velocity_, dt});
  }
  {
    const auto timer = model_.timers.start(3);
    solve_acceleration(dt);
    set_motion(dt);
    check_finite();
    add_work(dt);
  }
  if (record) record_energy(*record);
  update.motion = motion_;
  update.velocity = true;
  const bool second_map = scheme == StressUpdate::musl || scheme == StressUpdate::projected;
  if (second_map) {
    {
      const auto timer = model_.timers.start(4);
      points(update);
    }
    project_velocity(dt);
    update.velocity = false, update.strain_velocity = strain_velocity_;
  }
  points_changed_ |= !model_.tractions.empty();
  for (auto& traction : model_.tractions) traction.move(*model_.space, motion_, motion_stride<dim>, dt);
  update.move = true;
  update.strain = scheme != StressUpdate::usf;
  {
    const auto timer = model_.timers.start(4);
    points(update);
    if (scheme == StressUpdate::usf)
      for (auto& body : model_.bodies) follow_stretch(body);
  }
  model_.time += dt;
  ++model_.step;
  points_changed_ = false;
}

template class Explicit<2>;
template class Explicit<3>;

}  // namespace wisp
