// Conditions on grid functions that lie on grid lines, planes or single nodes.
#pragma once
#include <string>
#include <vector>

#include "basis/space.h"
#include "boundary/options.h"

namespace wisp {

/// A conforming condition with the functions of this rank that it holds. Functions are found once: the grid
/// does not move.
template <int dim>
class Conforming {
 public:
  /// Errors (InputError): neither or both of normal and node, no grid line or node there, unknown directions,
  /// both displacement and velocity.
  Conforming(const ConformingOptions& options, const Space<dim>& space);

  const std::string& name() const { return options_.label; }
  /// Local indices of the held functions, ghosts included.
  const std::vector<int>& functions() const { return functions_; }
  bool holds(int direction) const { return holds_[static_cast<std::size_t>(direction)]; }

  /// Prescribed displacement (m) over a step from t to t + dt.
  double increment(double t, double dt) const;
  /// Prescribed velocity (m/s) at the end of a step from t to t + dt.
  double velocity(double t, double dt) const;

  /// Whether the condition holds functions on the lower (side 0) or upper (side 1) edge of the grid in a
  /// direction.
  bool on_edge(int direction, int side) const {
    return edge_[static_cast<std::size_t>(2 * direction + side)];
  }

 private:
  ConformingOptions options_;
  std::vector<int> functions_;
  std::array<bool, dim> holds_{};
  std::array<bool, 2 * dim> edge_{};
};

/// Which unknowns are held, and by how much they move: arrays over (function, direction).
template <int dim>
struct Constraints {
  std::vector<char> fixed;  ///< n_functions x dim flags
  std::vector<int>
      condition;  ///< n_functions x dim: index of the condition, -1 where free; the last one wins
  bool any = false;

  Constraints() = default;
  Constraints(const std::vector<Conforming<dim>>& conditions, int n_functions);
};

/// Which edges of the grid the conditions hold: entry 2 d + side, side 0 the lower and 1 the upper edge of
/// direction d.
template <int dim>
std::array<bool, 2 * dim> held_edges(const std::vector<Conforming<dim>>& conditions) {
  std::array<bool, 2 * dim> held{};
  for (const auto& condition : conditions)
    for (int d = 0; d < dim; ++d)
      for (int side = 0; side < 2; ++side)
        held[static_cast<std::size_t>(2 * d + side)] |= condition.on_edge(d, side);
  return held;
}

}  // namespace wisp
