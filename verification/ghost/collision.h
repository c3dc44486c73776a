// The collision of two ghosts of sections 5.2 and 5.3: set-up and run, shared by figures 13 to 15 and
// table 3.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "analysis/explicit.h"

namespace wisp::ghost_paper {

struct CollisionCase {
  StressUpdate update = StressUpdate::usf;
  Mass mass = Mass::consistent;  ///< consistent: with Ghost
  std::string points = "medium";
  int steps = 1000;
  int cells = 10;  ///< a metre: h = 1/cells
  bool plastic = false;

  auto operator<=>(const CollisionCase&) const = default;
};

/// Energies of every step: kinetic of the points' velocities at its start, strain and dissipation of the
/// stress of its forces. The work of external forces is zero.
struct CollisionRun {
  double initial = 0.0;  ///< W0, J: kinetic energy of the points at the start
  std::vector<double> time, kinetic, strain, dissipation;
  std::vector<double> grid_kinetic;  ///< v^T M v / 2 of the start-of-step nodal velocity, J
  std::string failure;               ///< why it ended early; empty if complete

  /// Mean over the steps of |kinetic + strain - W0| / W0; infinite if the run did not complete.
  double mean_error(bool of_grid = false) const;
};

inline constexpr double collision_duration = 3.5;  // s

/// `watch` sees the model after every step.
CollisionRun run_collision(const CollisionCase& collision,
                           const std::function<void(const Model<2>&)>& watch = {});

}  // namespace wisp::ghost_paper
