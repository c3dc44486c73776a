// Conditions on grid functions that lie on grid lines, planes or single nodes.
#pragma once
#include <string>
#include <vector>

#include "basis/space.h"
#include "boundary/constraints.h"
#include "boundary/options.h"

namespace wisp {

/// A conforming condition with the functions of this rank that it holds. Functions are found once: the grid
/// does not move.
template <int dim>
class Conforming {
 public:
  /// Errors (InputError): not one of normal, node and part, no grid line, node or part there, unknown
  /// directions, both displacement and velocity, a profile of another length; B-splines elsewhere than on
  /// edges of the grid; on triangulations functions that cannot be fixed one by one.
  Conforming(const ConformingOptions& options, const Space<dim>& space);

  const std::string& name() const { return options_.label; }
  /// Local indices of the held functions, ghosts included.
  const std::vector<int>& functions() const { return functions_; }
  void constrain(std::size_t index, Constraints<dim>& constraints) const {
    for (std::size_t k = 0; k < functions_.size(); ++k)
      for (int d = 0; d < dim; ++d)
        if (holds(d)) constraints.hold(functions_[k], d, index, factors_[k]);
  }
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
  /// The edges of a triangulation along which it holds the motion.
  const std::vector<int>& edges() const { return edges_; }

 private:
  void hold_nodes(const Space<dim>& space);
  void hold_splines(const Space<dim>& space);
  void hold_triangulation(const Space<2>& space);

  void set_factors(const Space<dim>& space);

  ConformingOptions options_;
  std::vector<int> functions_, edges_;
  std::vector<double> factors_;  // share of the motion, one a function
  std::array<bool, dim> holds_{};
  std::array<bool, 2 * dim> edge_{};
};

}  // namespace wisp
