// Whether the state of a run makes sense: what may be kept as its last good one.
#pragma once
#include <algorithm>
#include <cmath>

#include "analysis/model.h"
#include "analysis/record.h"

namespace wisp {

/// Energies of the points, all ranks, without the grid's. Collective.
template <int dim>
EnergyRecord energies_of_points(const Model<dim>& model);

/// Whether positions, velocities, deformation gradients (not turned inside out) and stresses of all points
/// are numbers. Collective.
template <int dim>
bool is_finite(const Model<dim>& model);

/// A step beyond the stable one makes energy out of nothing long before the first number overflows.
class EnergyBalance {
 public:
  /// `start`: J, of the points at the start of the run; `given`: the most that they were given so far.
  explicit EnergyBalance(double start = 0.0, double given = 0.0)
      : start_(start), given_(std::max(start, given)) {}
  /// Takes note of the work so far; it may be given back later, so the most counts.
  void add_work(double work) { given_ = std::max(given_, start_ + std::abs(work)); }
  /// Whether the points have a hundred times what they were given: schemes that gain some energy (stress
  /// first) stay far below.
  bool is_broken(const EnergyRecord& now) const { return !(total(now) <= 100.0 * given_); }
  double start() const { return start_; }
  double given() const { return given_; }

  static double total(const EnergyRecord& r) { return r.kinetic + r.strain + r.dissipation; }

 private:
  double start_, given_;
};

}  // namespace wisp
