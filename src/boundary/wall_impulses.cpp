// Impulses of walls on the velocity of the grid, by projected Gauss-Seidel.
#include <algorithm>
#include <cmath>

#include "boundary/wall_contact.h"
#include "core/error.h"

namespace wisp {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double tolerance = 1e-10;  // of the largest change that the first sweep asks for
constexpr int max_sweeps = 400;

}  // namespace

/// Functions of the live rows get slots; weights go to functions with mass.
template <int dim>
void WallContact<dim>::take_functions(const StepMass& mass) {
  for (const int f : functions_)
    if (f >= 0) slot_[at(f)] = -1;
  functions_.clear();
  std::fill(wall_slot_.begin(), wall_slot_.end(), -1);
  for (const Live& live : live_)
    for (const int i : rows_[at(live.row)].function) {
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
    for (std::size_t i = 0; i < row.function.size(); ++i) {
      live.slot[i] = wall_slot_[at(row.function[i])];
      live.weight[i] = slot_mass_[at(live.slot[i]) * stride] > 0.0 ? row.weight[i] : 0.0;
      sum += live.weight[i];
    }
    if (!(sum > 0.0)) continue;  // no material on any of its functions
    for (double& w : live.weight) w /= sum;
    if (kept != k) live_[kept] = live;
    ++kept;
  }
  live_.resize(kept);
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
}

/// The diagonal of C M^-1 C^T, and for the consistent mass all of it, by one solve a row.
template <int dim>
void WallContact<dim>::couple(const StepMass& mass) {
  consistent_ = static_cast<bool>(mass.solve);
  const std::size_t n = live_.size();
  if (!consistent_) {
    for (Live& live : live_) {
      live.diagonal.setZero();
      for (std::size_t i = 0; i < live.weight.size(); ++i)
        for (int d = 0; d < dim; ++d)
          live.diagonal[d] += live.weight[i] * live.weight[i] * inverse_[at(live.slot[i]) * dim + at(d)];
    }
    return;
  }
  coupling_.assign(n * n * dim, 0.0);
  right_side_.assign(slot_.size() * dim, 0.0);
  solved_.resize(slot_.size() * dim);
  for (std::size_t r = 0; r < n; ++r) {
    const Live& live = live_[r];
    const auto set = [&](bool on) {
      for (std::size_t i = 0; i < live.slot.size(); ++i)
        if (const int f = functions_[at(live.slot[i])]; f >= 0)
          std::fill_n(right_side_.begin() + f * dim, dim, on ? live.weight[i] : 0.0);
    };
    set(true);
    std::fill(solved_.begin(), solved_.end(), 0.0);
    mass.solve(right_side_, solved_);
    set(false);
    for (std::size_t s = 0; s < n; ++s)
      for (std::size_t i = 0; i < live_[s].slot.size(); ++i)
        if (const int f = functions_[at(live_[s].slot[i])]; f >= 0 && space_->nodes().owns(f))
          for (std::size_t d = 0; d < dim; ++d)
            coupling_[(r * n + s) * dim + d] += live_[s].weight[i] * solved_[at(f) * dim + d];
  }
  if (Session::size() > 1) Session::sum_in_place(coupling_);
  for (std::size_t r = 0; r < n; ++r)
    for (int d = 0; d < dim; ++d) live_[r].diagonal[d] = coupling_[(r * n + r) * dim + at(d)];
}

template <int dim>
Vec<dim> WallContact<dim>::row_velocity(const Live& live) const {
  Vec<dim> w = Vec<dim>::Zero();
  for (std::size_t i = 0; i < live.weight.size(); ++i)
    for (int d = 0; d < dim; ++d) w[d] += live.weight[i] * value_[at(live.slot[i]) * dim + at(d)];
  return w;
}

/// An impulse on a row; `value_` or `row_values_` follow.
template <int dim>
void WallContact<dim>::push(std::size_t r, const Vec<dim>& impulse) {
  if (!consistent_) {
    const Live& live = live_[r];
    for (std::size_t i = 0; i < live.weight.size(); ++i)
      for (int d = 0; d < dim; ++d) {
        const std::size_t k = at(live.slot[i]) * dim + at(d);
        value_[k] += live.weight[i] * inverse_[k] * impulse[d];
      }
    return;
  }
  const std::size_t n = live_.size();
  for (std::size_t s = 0; s < n; ++s)
    for (int d = 0; d < dim; ++d) row_values_[s][d] += coupling_[(r * n + s) * dim + at(d)] * impulse[d];
}

template <int dim>
void WallContact<dim>::solve_normal(std::size_t r, double& change) {
  Live& live = live_[r];
  const double a = live.diagonal.dot(live.normal.cwiseAbs2());
  if (!live.normal_held || !(a > 0.0)) return;
  const Vec<dim> u = (consistent_ ? row_values_[r] : row_velocity(live)) - live.target;
  double lambda = live.lambda_n - (u.dot(live.normal) - live.bias) / a;
  if (live.pushes) lambda = std::max(0.0, lambda);
  const double step = lambda - live.lambda_n;
  if (step == 0.0) return;
  live.lambda_n = lambda;
  push(r, step * live.normal);
  change = std::max(change, std::abs(step) * a);
}

template <int dim>
void WallContact<dim>::solve_tangent(std::size_t r, double& change) {
  Live& live = live_[r];
  const double a = live.diagonal.maxCoeff();
  if (!live.tangent_held || !(a > 0.0)) return;
  const Vec<dim> u = (consistent_ ? row_values_[r] : row_velocity(live)) - live.target;
  Vec<dim> lambda = live.lambda_t - (u - u.dot(live.normal) * live.normal) / a;
  live.sticks = true;
  if (live.slips) {  // Coulomb
    const double most = live.friction * std::abs(live.lambda_n), size = lambda.norm();
    if (size > most) lambda *= most / size, live.sticks = false;
  } else if (live.normal_held && live.pushes && live.lambda_n == 0.0) {
    lambda.setZero(), live.sticks = false;
  }
  const Vec<dim> step = lambda - live.lambda_t;
  if (step.isZero(0.0)) return;
  live.lambda_t = lambda;
  push(r, step);
  change = std::max(change, step.norm() * a);
}

/// From zero impulses, back and forth over the rows.
template <int dim>
void WallContact<dim>::iterate() {
  double first = 0.0;
  sweeps_ = 0;
  const std::size_t n = live_.size();
  for (double change = 1.0; sweeps_ < max_sweeps && change > tolerance * first; ++sweeps_) {
    change = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t r = sweeps_ % 2 ? n - 1 - k : k;
      solve_normal(r, change);
      solve_tangent(r, change);
    }
    first = std::max(first, change);
    if (change == 0.0) break;
  }
}

/// The velocity that strains: equalities on the rows that carry an impulse, by corrections that are
/// forgotten.
template <int dim>
void WallContact<dim>::project() {
  double first = 0.0;
  const std::size_t n = live_.size();
  int sweep = 0;
  for (double change = 1.0; sweep < max_sweeps && change > tolerance * first; ++sweep) {
    change = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t r = sweep % 2 ? n - 1 - k : k;
      const Live& live = live_[r];
      if (!live.loaded()) continue;
      const Vec<dim> u = (consistent_ ? row_values_[r] : row_velocity(live)) - live.target;
      const double un = u.dot(live.normal), an = live.diagonal.dot(live.normal.cwiseAbs2()),
                   at_most = live.diagonal.maxCoeff();
      Vec<dim> step = Vec<dim>::Zero();
      if (live.normal_held && an > 0.0) step -= (un - live.bias) / an * live.normal;
      if (live.tangent_held && live.sticks && at_most > 0.0) step -= (u - un * live.normal) / at_most;
      if (step.isZero(0.0)) continue;
      if (!impulses_.empty()) impulses_[r] += step;
      push(r, step);
      change = std::max(change, step.norm() * at_most);
    }
    first = std::max(first, change);
    if (change == 0.0) break;
  }
}

/// C^T impulse of one row.
template <int dim>
void WallContact<dim>::add_row(const Live& live, const Vec<dim>& impulse, std::span<double> sum) const {
  for (std::size_t i = 0; i < live.slot.size(); ++i)
    if (const int f = functions_[at(live.slot[i])]; f >= 0)
      for (int d = 0; d < dim; ++d) sum[at(f) * dim + at(d)] += live.weight[i] * impulse[d];
}

/// M^-1 C^T impulses over all functions.
template <int dim>
void WallContact<dim>::spread(const StepMass& mass, std::span<const Vec<dim>> impulses,
                              std::span<double> change) {
  std::fill(right_side_.begin(), right_side_.end(), 0.0);
  for (std::size_t r = 0; r < live_.size(); ++r) add_row(live_[r], impulses[r], right_side_);
  std::fill(change.begin(), change.end(), 0.0);
  mass.solve(right_side_, change);
}

template <int dim>
void WallContact<dim>::correct_velocity(const StepMass& mass, std::span<const double> velocity, double dt,
                                        std::span<double> acceleration) {
  take_functions(mass);
  couple(mass);
  take_values(
      [&](std::size_t f, std::size_t d) { return velocity[f * dim + d] + dt * acceleration[f * dim + d]; });
  if (!consistent_) {
    before_ = value_;
    iterate();
    give_values([&](std::size_t f, std::size_t d, std::size_t k) {
      acceleration[f * dim + d] += (value_[k] - before_[k]) / dt;
    });
  } else if (!live_.empty()) {
    row_values_.resize(live_.size());
    for (std::size_t r = 0; r < live_.size(); ++r) row_values_[r] = row_velocity(live_[r]);
    iterate();
    impulses_.resize(live_.size());
    for (std::size_t r = 0; r < live_.size(); ++r) impulses_[r] = live_[r].impulse();
    spread(mass, impulses_, solved_);
    for (std::size_t k = 0; k < acceleration.size(); ++k) acceleration[k] += solved_[k] / dt;
  }
  set_reactions(dt);
}

template <int dim>
void WallContact<dim>::set_reactions(double dt) {
  for (auto& reaction : reactions_) reaction = {};
  work_ = 0.0;
  for (std::size_t r = 0; r < live_.size(); ++r) {
    const Live& live = live_[r];
    if (!live.loaded()) continue;
    const WallRow<dim>& row = rows_[at(live.row)];
    const Vec<dim> impulse = live.impulse(), force = impulse / dt;
    WallReaction<dim>& reaction = reactions_[at(row.wall)];
    reaction.force += force;
    const Vec<dim> arm = row.middle - walls_[at(row.wall)].motion().centre(time_);
    if constexpr (dim == 2)
      reaction.moment[0] += arm[0] * force[1] - arm[1] * force[0];
    else
      reaction.moment += Vec<3>(arm[1] * force[2] - arm[2] * force[1], arm[2] * force[0] - arm[0] * force[2],
                                arm[0] * force[1] - arm[1] * force[0]);
    work_ += impulse.dot(consistent_ ? row_values_[r] : row_velocity(live));
  }
}

template <int dim>
void WallContact<dim>::add_force(double dt, std::span<double> force) const {
  for (const Live& live : live_)
    if (live.loaded()) add_row(live, live.impulse() / dt, force);
}

template <int dim>
void WallContact<dim>::correct_strain_velocity(const StepMass& mass, std::span<double> velocity, bool alone) {
  if (alone) {
    take_functions(mass);
    couple(mass);
  }
  if (live_.empty()) return;
  take_values([&](std::size_t f, std::size_t d) { return velocity[f * dim + d]; });
  if (consistent_) {
    row_values_.resize(live_.size());
    for (std::size_t r = 0; r < live_.size(); ++r) row_values_[r] = row_velocity(live_[r]);
    impulses_.assign(live_.size(), Vec<dim>::Zero());
  }
  if (alone) {
    iterate();
    for (std::size_t r = 0; r < live_.size(); ++r) {
      if (consistent_) impulses_[r] = live_[r].impulse();
      live_[r].lambda_n = 0.0, live_[r].lambda_t.setZero(), live_[r].sticks = false;
    }
  } else {
    project();
  }
  if (consistent_) {
    spread(mass, impulses_, solved_);
    for (std::size_t k = 0; k < velocity.size(); ++k) velocity[k] += solved_[k];
    return;
  }
  give_values([&](std::size_t f, std::size_t d, std::size_t k) { velocity[f * dim + d] = value_[k]; });
}

template class WallContact<2>;
template class WallContact<3>;

}  // namespace wisp
