#include "analysis/explicit.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "transfer/active.h"
#include "transfer/density.h"
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
                mass_solver_options(model.options.solver)),
      field_equation_({}, mass_solver_options(model.options.solver)),
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
  field_equation_.renew();
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
  if (what != Gather::inertia && options_.integration != Integration::points) {
    const ActiveCells cells = active_cells(*model_.space, model_.bodies);
    add_reconstruction<dim>(*model_.space, model_.bodies, cells, sums_);
    if (reconstructs_density() && !gravity.isZero())
      exchange_weight<dim>(*model_.space, model_.bodies, cells, gravity, sums_);
  }
  model_.space->nodes().add_update(sums_.data(), sums_stride<dim>);
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
  if (!update.strain || options_.integration == Integration::points) {
    for (auto& body : model_.bodies) grid_to_points<dim>(*model_.space, body, update);
    return;
  }
  // Points are where their forces were gathered: the same cells are filled.
  const ActiveCells cells = active_cells(*model_.space, model_.bodies);
  const bool own = !update.strain_velocity.empty();
  PointUpdate rest = update;
  rest.strain = false, rest.strain_velocity = {};
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    smooth_gradients<dim>(*model_.space, model_.bodies, b, cells,
                          own ? update.strain_velocity : update.motion, own ? dim : motion_stride<dim>,
                          gradients_);
    if (rest.velocity || rest.move) grid_to_points<dim>(*model_.space, model_.bodies[b], rest);
    strain_points<dim>(model_.bodies[b], gradients_, update.dt);
  }
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
  if (!walls_.empty()) correct_strain_velocity(false);
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
    // The projected step needs no velocity at its start but for what asks for one; the last projection is at
    // hand.
    const auto n = static_cast<std::size_t>(model_.space->n_functions()) * dim;
    if (scheme == StressUpdate::projected && !record && !pic && options_.pic_fraction <= 0 &&
        options_.damping <= 0 && velocity_.size() == n)
      prescribe(model_.time, velocity_);
    else if (consistent_ || scheme == StressUpdate::usf)
      solve_velocity(model_.time, velocity_);
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
    gather(Gather::both, options_.updated_gradients ? FollowedMotion{velocity_, dt} : FollowedMotion{});
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
  if (reconstructs_density())
    balance_momentum<dim>(*model_.space, model_.bodies, active_cells(*model_.space, model_.bodies), motion_,
                          dt);
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
  } else if (scheme == StressUpdate::usl && !walls_.empty() && !model_.space->domains()) {
    calm_light_functions(update);
  }
  points_changed_ |= !model_.loads.empty();
  model_.move_loads(motion_, motion_stride<dim>, dt);
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
