#include "analysis/explicit.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "transfer/active.h"
#include "transfer/explicit_transfer.h"
#include "transfer/reconstruction.h"

namespace wisp {

namespace {
MassSolverOptions mass_solver_options(const SolverOptions& solver) {
  MassSolverOptions options;
  options.solver = solver.solver;
  options.max_iterations = solver.max_iterations;
  return options;
}

template <int dim>
std::vector<Wall<dim>> walls_of(const std::vector<AnyBoundary<dim>>& boundaries) {
  std::vector<Wall<dim>> walls;
  for_each<Wall>(boundaries, [&](const Wall<dim>& wall, std::size_t) { walls.push_back(wall); });
  return walls;
}
}  // namespace

template <int dim>
Explicit<dim>::Explicit(Model<dim>& model, const ExplicitOptions& options)
    : model_(model),
      options_(options),
      consistent_(options.mass != Mass::lumped),
      equation_({options.mass, options.fmpm_order, options.deactivate_below},
                mass_solver_options(model.options.solver)),
      walls_(walls_of(model.boundaries), *model.space) {
  if (options.velocity_update == VelocityUpdate::apic)
    for (auto& body : model_.bodies)
      if (body.points.affine.empty())
        body.points.affine.assign(body.points.position.size(), Mat<dim>::Zero());
  for (const char* name : {"1 locate, stencils", "2 mass, momentum, forces to grid", "3 contributions",
                           "4 solve for acceleration", "5-7 grid to points, deformation, stress, move"})
    model_.timers.part(name);
  if (!walls_.empty()) model_.timers.part("walls");
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
    mass_.multiply_columns(acceleration_, inertia_, dim);
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

template <int dim>
void Explicit<dim>::check_finite(double sum) const {
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
  const auto& nodes = model_.space->nodes();
  const auto end_velocity = [&](std::size_t k) { return motion_[k / dim * motion_stride<dim> + k % dim]; };
  double work = 0.0;
  for (const std::size_t k : model_.constraints.held)
    if (nodes.owns(static_cast<int>(k / dim))) work += dt * reaction(k) * end_velocity(k);
  if (!gravity.isZero() || !loads_.empty())
    for (std::size_t i = 0; i < sums_.size() / sums_stride<dim>; ++i) {
      if (!nodes.owns(static_cast<int>(i))) continue;
      for (std::size_t d = 0; d < dim; ++d) {
        double f = sums_[i * sums_stride<dim>] * gravity[static_cast<int>(d)];
        if (!loads_.empty()) f += loads_[i * dim + d];
        work += dt * f * end_velocity(i * dim + d);
      }
    }
  model_.external_work += Session::sum(work);
}

template <int dim>
void Explicit<dim>::points(const PointUpdate& update) {
  points_changed_ = true;
  for (auto& body : model_.bodies) grid_to_points<dim>(*model_.space, body, update);
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
  if (!walls_.empty()) find_walls();
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
    if (needs_start_velocity(record != nullptr))
      solve_velocity(model_.time, velocity_);
    else if (consistent_)
      prescribe(model_.time, velocity_);
  }
  if (scheme == StressUpdate::usf) {
    PointUpdate strain = update;
    strain_velocity_ = velocity_;
    if (!walls_.empty()) correct_strain_velocity(true);
    // Mass and forces of a step share their functions, so domains wait for the end of the step.
    strain.strain = true, strain.strain_velocity = strain_velocity_, strain.domains = false;
    {
      const auto timer = model_.timers.start(4);
      points(strain);
    }
    const auto timer = model_.timers.start(1);
    gather(Gather::both, {velocity_, dt});
  }
  {
    const auto timer = model_.timers.start(3);
    consistent_ ? solve_acceleration(dt) : advance_lumped(dt);
  }
  if (!walls_.empty()) correct_acceleration(dt);
  {
    const auto timer = model_.timers.start(3);
    if (consistent_ || !walls_.empty()) set_motion(dt);
    find_reactions();
    add_work(dt);
  }
  if (!walls_.empty()) record_walls();
  if (record) record_energy(*record);
  points_changed_ = true;  // what loads mark on the bodies moves first
  model_.move_loads(motion_, motion_stride<dim>, dt);
  update.motion = motion_;
  update.velocity = true;
  if (scheme == StressUpdate::musl || scheme == StressUpdate::projected) {
    {
      const auto timer = model_.timers.start(4);
      points(update);
    }
    map_again(dt);
    update.velocity = false, update.strain_velocity = strain_velocity_;
  } else if (scheme == StressUpdate::usl && !walls_.empty() && !model_.space->domains()) {
    calm_light_functions(update);
  }
  update.move = true;
  update.strain = scheme != StressUpdate::usf;
  {
    const auto timer = model_.timers.start(4);
    points(update);
    if (scheme == StressUpdate::usf)
      for (auto& body : model_.bodies) follow_stretch(body);
  }
  if (!walls_.empty()) {
    const auto timer = model_.timers.start(5);
    walls_.correct_points(model_.bodies);
  }
  model_.time += dt;
  ++model_.step;
  points_changed_ = false;
}

template class Explicit<2>;
template class Explicit<3>;

}  // namespace wisp
