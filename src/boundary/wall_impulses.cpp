// Impulses of walls on the velocity of the grid.
#include <algorithm>
#include <cmath>

#include "boundary/wall_contact.h"
#include "core/error.h"

namespace wisp {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

/// Functions of the live rows get slots; weights go to functions with mass.
template <int dim>
void WallContact<dim>::take_functions(const StepMass& mass) {
  for (const int f : functions_)
    if (f >= 0) slot_[at(f)] = -1;
  functions_.clear();
  std::fill(wall_slot_.begin(), wall_slot_.end(), -1);
  for (const Live& live : live_)
    for (const int i : rows_[at(live.row)].functions()) {
      if (wall_slot_[at(i)] >= 0) continue;
      wall_slot_[at(i)] = static_cast<int>(functions_.size());
      if (local_[at(i)] >= 0) slot_[at(local_[at(i)])] = wall_slot_[at(i)];
      functions_.push_back(local_[at(i)]);
    }
  take_masses(mass);
  constexpr std::size_t stride = 1 + dim;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < live_.size(); ++k) {
    Live& live = live_[k];
    const WallRow<dim>& row = rows_[at(live.row)];
    double sum = 0.0;
    live.n = static_cast<std::size_t>(row.n);
    for (std::size_t i = 0; i < live.n; ++i) {
      live.slot[i] = wall_slot_[at(row.function[i])];
      live.weight[i] = slot_mass_[at(live.slot[i]) * stride] > 0.0 ? row.weight[i] : 0.0;
      sum += live.weight[i];
    }
    if (!(sum > 0.0)) continue;  // no material on any of its functions
    for (std::size_t i = 0; i < live.n; ++i) live.weight[i] /= sum;
    if (kept != k) live_[kept] = live, states_[kept] = states_[k];
    ++kept;
  }
  live_.resize(kept);
  states_.resize(kept);
}

/// Mass and freedom of the functions with slots, from their owners.
template <int dim>
void WallContact<dim>::take_masses(const StepMass& mass) {
  constexpr std::size_t stride = 1 + dim;
  slot_mass_.assign(functions_.size() * stride, 0.0);
  for (std::size_t k = 0; k < functions_.size(); ++k) {
    if (functions_[k] < 0 || !space_->nodes().owns(functions_[k])) continue;
    const auto f = at(functions_[k]);
    slot_mass_[k * stride] = mass.sums[f * at(mass.stride)];
    for (std::size_t d = 0; d < dim; ++d)
      slot_mass_[k * stride + 1 + d] = mass.fixed.empty() || !mass.fixed[f * dim + d] ? 1.0 : 0.0;
  }
  if (Session::size() > 1) Session::sum_in_place(slot_mass_);
  inverse_.clear();
  for (std::size_t k = 0; k < functions_.size(); ++k)
    for (std::size_t d = 0; d < dim; ++d) {
      const double m = slot_mass_[k * stride];
      inverse_.push_back(m > 0.0 && slot_mass_[k * stride + 1 + d] != 0.0 ? 1.0 / m : 0.0);
    }
  value_.assign(functions_.size() * dim, 0.0);
  spread_.assign(functions_.size() * dim, 0.0);
}

/// C M^-1 C^T: rows that share functions, or with the consistent mass all, by one solve a row.
template <int dim>
void WallContact<dim>::couple(const StepMass& mass) {
  consistent_ = static_cast<bool>(mass.solve);
  system_.clear();
  if (!consistent_) return couple_by_functions();
  const std::size_t n = live_.size();
  coupling_.assign(n * n * dim, 0.0);
  right_side_.assign(slot_.size() * dim, 0.0);
  solved_.resize(slot_.size() * dim);
  for (std::size_t r = 0; r < n; ++r) {
    const Live& live = live_[r];
    const auto set = [&](bool on) {
      for (std::size_t i = 0; i < live.n; ++i)
        if (const int f = functions_[at(live.slot[i])]; f >= 0)
          std::fill_n(right_side_.begin() + f * dim, dim, on ? live.weight[i] : 0.0);
    };
    set(true);
    std::fill(solved_.begin(), solved_.end(), 0.0);
    mass.solve(right_side_, solved_);
    set(false);
    for (std::size_t s = 0; s < n; ++s)
      for (std::size_t i = 0; i < live_[s].n; ++i)
        if (const int f = functions_[at(live_[s].slot[i])]; f >= 0 && space_->nodes().owns(f))
          for (std::size_t d = 0; d < dim; ++d)
            coupling_[(r * n + s) * dim + d] += live_[s].weight[i] * solved_[at(f) * dim + d];
  }
  if (Session::size() > 1) Session::sum_in_place(coupling_);
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t s = 0; s < n; ++s)
      system_.add(static_cast<int>(s), Eigen::Map<const Vec<dim>>(coupling_.data() + (r * n + s) * dim));
    system_.end_row();
  }
}

template <int dim>
void WallContact<dim>::couple_by_functions() {
  if (rows_of_slot_.size() < functions_.size()) rows_of_slot_.resize(functions_.size());
  for (auto& rows : rows_of_slot_) rows.clear();
  for (std::size_t r = 0; r < live_.size(); ++r)
    for (std::size_t i = 0; i < live_[r].n; ++i)
      if (live_[r].weight[i] != 0.0) rows_of_slot_[at(live_[r].slot[i])].push_back(static_cast<int>(r));
  seen_.assign(live_.size(), 0);
  for (const Live& live : live_) {
    met_.clear();
    for (std::size_t i = 0; i < live.n; ++i) {
      if (live.weight[i] == 0.0) continue;
      for (const int s : rows_of_slot_[at(live.slot[i])])
        if (!seen_[at(s)]) seen_[at(s)] = 1, met_.push_back(s);
      for (int d = 0; d < dim; ++d)
        spread_[at(live.slot[i]) * dim + at(d)] = live.weight[i] * inverse_[at(live.slot[i]) * dim + at(d)];
    }
    for (const int s : met_) {
      seen_[at(s)] = 0;
      const Live& other = live_[at(s)];
      Vec<dim> a = Vec<dim>::Zero();
      for (std::size_t j = 0; j < other.n; ++j)
        a += other.weight[j] * Eigen::Map<const Vec<dim>>(spread_.data() + at(other.slot[j]) * dim);
      system_.add(s, a);
    }
    system_.end_row();
    for (std::size_t i = 0; i < live.n; ++i) std::fill_n(spread_.begin() + live.slot[i] * dim, dim, 0.0);
  }
}

template <int dim>
void WallContact<dim>::take_row_velocities() {
  auto& velocity = system_.velocity();
  velocity.assign(live_.size(), Vec<dim>::Zero());
  for (std::size_t r = 0; r < live_.size(); ++r)
    for (std::size_t i = 0; i < live_[r].n; ++i)
      velocity[r] +=
          live_[r].weight[i] * Eigen::Map<const Vec<dim>>(value_.data() + at(live_[r].slot[i]) * dim);
}

/// `value_` made admissible on the rows that carry an impulse.
template <int dim>
void WallContact<dim>::project() {
  take_row_velocities();
  impulses_.assign(live_.size(), Vec<dim>::Zero());
  system_.project(states_, impulses_);
  if (!consistent_) spread_lumped();
}

/// `value_` changes by M^-1 C^T impulses.
template <int dim>
void WallContact<dim>::spread_lumped() {
  for (std::size_t r = 0; r < live_.size(); ++r) {
    if (impulses_[r].isZero(0.0)) continue;
    for (std::size_t i = 0; i < live_[r].n; ++i)
      for (int d = 0; d < dim; ++d) {
        const std::size_t k = at(live_[r].slot[i]) * dim + at(d);
        value_[k] += live_[r].weight[i] * inverse_[k] * impulses_[r][d];
      }
  }
}

/// C^T impulse of one row.
template <int dim>
void WallContact<dim>::add_row(const Live& live, const Vec<dim>& impulse, std::span<double> sum) const {
  for (std::size_t i = 0; i < live.n; ++i)
    if (const int f = functions_[at(live.slot[i])]; f >= 0)
      for (int d = 0; d < dim; ++d) sum[at(f) * dim + at(d)] += live.weight[i] * impulse[d];
}

/// M^-1 C^T impulses over all functions.
template <int dim>
void WallContact<dim>::spread(const StepMass& mass, std::span<double> change) {
  std::fill(right_side_.begin(), right_side_.end(), 0.0);
  for (std::size_t r = 0; r < live_.size(); ++r) add_row(live_[r], impulses_[r], right_side_);
  std::fill(change.begin(), change.end(), 0.0);
  mass.solve(right_side_, change);
}

template <int dim>
void WallContact<dim>::find_impulses() {
  take_row_velocities();
  system_.find(states_);
  impulses_.resize(live_.size());
  for (std::size_t r = 0; r < live_.size(); ++r) impulses_[r] = states_[r].impulse();
}

template <int dim>
void WallContact<dim>::correct_velocity(const StepMass& mass, std::span<const double> velocity, double dt,
                                        std::span<double> acceleration) {
  take_functions(mass);
  couple(mass);
  take_values(
      [&](std::size_t f, std::size_t d) { return velocity[f * dim + d] + dt * acceleration[f * dim + d]; });
  find_impulses();
  if (!consistent_) {
    value_.assign(value_.size(), 0.0);
    spread_lumped();
    give_values(
        [&](std::size_t f, std::size_t d, std::size_t k) { acceleration[f * dim + d] += value_[k] / dt; });
  } else if (!live_.empty()) {
    spread(mass, solved_);
    for (std::size_t k = 0; k < acceleration.size(); ++k) acceleration[k] += solved_[k] / dt;
  }
  set_reactions(dt);
}

template <int dim>
void WallContact<dim>::set_reactions(double dt) {
  for (auto& reaction : reactions_) reaction = {};
  work_ = 0.0;
  for (std::size_t r = 0; r < live_.size(); ++r) {
    if (!states_[r].loaded()) continue;
    const WallRow<dim>& row = rows_[at(live_[r].row)];
    const Vec<dim> impulse = states_[r].impulse(), force = impulse / dt;
    WallReaction<dim>& reaction = reactions_[at(row.wall)];
    reaction.force += force;
    const Vec<dim> arm = row.middle - walls_[at(row.wall)].motion().centre(time_);
    if constexpr (dim == 2)
      reaction.moment[0] += arm[0] * force[1] - arm[1] * force[0];
    else
      reaction.moment += Vec<3>(arm[1] * force[2] - arm[2] * force[1], arm[2] * force[0] - arm[0] * force[2],
                                arm[0] * force[1] - arm[1] * force[0]);
    work_ += impulse.dot(system_.velocity()[r]);
  }
}

template <int dim>
void WallContact<dim>::add_force(double dt, std::span<double> force) const {
  for (std::size_t r = 0; r < live_.size(); ++r)
    if (states_[r].loaded()) add_row(live_[r], states_[r].impulse() / dt, force);
}

template <int dim>
void WallContact<dim>::correct_strain_velocity(const StepMass& mass, std::span<double> velocity, bool alone) {
  if (alone) {
    take_functions(mass);
    couple(mass);
  }
  if (live_.empty()) return;
  take_values([&](std::size_t f, std::size_t d) { return velocity[f * dim + d]; });
  if (alone) {
    find_impulses();
    if (!consistent_) spread_lumped();
    for (auto& state : states_) state.lambda_n = 0.0, state.lambda_t.setZero(), state.sticks = false;
  } else {
    project();
  }
  if (consistent_) {
    spread(mass, solved_);
    for (std::size_t k = 0; k < velocity.size(); ++k) velocity[k] += solved_[k];
    return;
  }
  give_values([&](std::size_t f, std::size_t d, std::size_t k) { velocity[f * dim + d] = value_[k]; });
}

template class WallContact<2>;
template class WallContact<3>;

}  // namespace wisp
