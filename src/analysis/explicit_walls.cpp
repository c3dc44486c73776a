// Walls in an explicit step: what is handed to them, and what they did.
#include "analysis/explicit.h"
#include "core/error.h"

namespace wisp {

namespace {
constexpr int walls_timer = 5;
}

template <int dim>
std::vector<Wall<dim>> walls_of(const std::vector<AnyBoundary<dim>>& boundaries) {
  std::vector<Wall<dim>> walls;
  for_each<Wall>(boundaries, [&](const Wall<dim>& wall, std::size_t) { walls.push_back(wall); });
  return walls;
}
template std::vector<Wall<2>> walls_of<2>(const std::vector<AnyBoundary<2>>&);
template std::vector<Wall<3>> walls_of<3>(const std::vector<AnyBoundary<3>>&);

template <int dim>
StepMass Explicit<dim>::step_mass() {
  StepMass mass;
  mass.sums = sums_;
  mass.stride = sums_stride<dim>;
  if (model_.constraints.any) mass.fixed = model_.constraints.fixed;
  if (consistent_)
    mass.solve = [this](std::span<const double> b, std::span<double> dv) {
      const SolveReport report = equation_.solve(b, dv);
      if (!report.solved)
        run_error(
            "step {} at t = {:.6g} s: the solve for the walls' impulses failed ({}); add [stabilisation]",
            model_.step, model_.time, report.cause);
    };
  return mass;
}

template <int dim>
void Explicit<dim>::find_walls() {
  const auto timer = model_.timers.start(walls_timer);
  if (!walls_.is_on(*model_.space)) walls_ = WallContact<dim>(walls_of(model_.boundaries), *model_.space);
  walls_.find(model_.bodies, model_.time, dt_);
}

template <int dim>
void Explicit<dim>::correct_strain_velocity(bool alone) {
  const auto timer = model_.timers.start(walls_timer);
  walls_.correct_strain_velocity(step_mass(), strain_velocity_, alone);
}

template <int dim>
void Explicit<dim>::correct_acceleration(double dt) {
  const auto timer = model_.timers.start(walls_timer);
  walls_.correct_velocity(step_mass(), velocity_, dt, acceleration_);
  // So that the reactions of held functions are without what the walls bear.
  walls_.add_force(dt, right_side_);
}

template <int dim>
void Explicit<dim>::record_walls() {
  std::size_t w = 0;
  for_each<Wall>(model_.boundaries, [&](Wall<dim>& wall, std::size_t k) {
    const WallReaction<dim>& reaction = walls_.reactions()[w++];
    model_.reactions[k] = wall.reaction = reaction.force;
    model_.moments[k] = wall.moment = reaction.moment;
  });
  model_.external_work += walls_.work();
}

/// The strain velocity of USL with linear functions. A point's velocity may depend on the grid's own (PIC):
/// then it is found before the grid's velocity is changed.
template <int dim>
void Explicit<dim>::calm_light_functions(PointUpdate& update) {
  const bool flip = update.flip == 1.0 && !update.apic;
  if (!flip) {
    {
      const auto timer = model_.timers.start(4);
      points(update);
    }
    strain_velocity_.resize(velocity_.size());
  }
  {
    const auto timer = model_.timers.start(walls_timer);
    walls_.calm_light_functions(model_.bodies, step_mass(), flip ? dt_ : 0.0, motion_, motion_stride<dim>);
  }
  if (flip) return;
  for (std::size_t k = 0; k < strain_velocity_.size(); ++k)
    strain_velocity_[k] = motion_[k / dim * motion_stride<dim> + k % dim];
  update.velocity = false, update.strain_velocity = strain_velocity_;
}

template class Explicit<2>;
template class Explicit<3>;

}  // namespace wisp
