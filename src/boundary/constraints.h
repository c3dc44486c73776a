// Unknowns of the grid that conditions hold.
#pragma once
#include <cstddef>
#include <vector>

namespace wisp {

/// Which unknowns are held, and by how much they move: arrays over (function, direction).
template <int dim>
struct Constraints {
  std::vector<char> fixed;     ///< n_functions x dim flags
  std::vector<int> condition;  ///< n_functions x dim: index of the boundary, -1 where free; the last one wins
  std::vector<std::size_t> held;  ///< the unknowns k = function * dim + direction whose flag is set
  bool any = false;               ///< also on a rank that holds nothing: it must exchange like the others
  std::vector<double> factor;     ///< n_functions x dim: share of its boundary's motion that an unknown takes
  std::vector<double> motion;  ///< one a boundary: what its unknowns do now, see `set_increments` in list.h

  Constraints() = default;
  Constraints(int n_functions, std::size_t n_boundaries)
      : fixed(static_cast<std::size_t>(n_functions) * dim, 0),
        condition(static_cast<std::size_t>(n_functions) * dim, -1),
        factor(static_cast<std::size_t>(n_functions) * dim, 1.0),
        motion(n_boundaries, 0.0) {}

  void hold(int function, int direction, std::size_t boundary, double share = 1.0) {
    const auto k = static_cast<std::size_t>(function * dim + direction);
    if (!fixed[k]) held.push_back(k);
    fixed[k] = 1, condition[k] = static_cast<int>(boundary), factor[k] = share;
  }
  /// What a held unknown does now.
  double prescribed(std::size_t k) const {
    return factor[k] * motion[static_cast<std::size_t>(condition[k])];
  }
};

}  // namespace wisp
