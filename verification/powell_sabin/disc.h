// An elastic disc in free flight over a triangulation, turning and breathing: set-up and run.
#pragma once
#include <optional>
#include <string>

#include "analysis/explicit.h"

namespace wisp::powell_sabin {

/// A disc of radius 0.3 m of Hencky's material (E = 1 kPa, nu = 0.3, 1000 kg/m3) that flies, turns a quarter
/// a second and starts with an expansion of 0.5 per second, on a random Delaunay triangulation.
struct DiscCase {
  Mass mass = Mass::consistent;
  int fmpm_order = 4;
  double deactivate_below = 0.0;
  std::optional<GhostOptions> ghost;
  double spacing = 0.12;  ///< m, of the triangulation
  int seed = 1;
  int points_across = 40;
  double dt = 1e-3, duration = 2.0;
  bool turns = true;  ///< false: it only flies; what else it does is set afterwards
};
constexpr double disc_radius = 0.3;                ///< m
constexpr double disc_velocity[2] = {0.35, 0.12};  ///< m/s
inline Hencky disc_law() { return {1000.0, 1000.0, 0.3}; }
ModelOptions disc_options(const DiscCase& disc);
ExplicitOptions disc_step(const DiscCase& disc);

struct DiscRun {
  double momentum = 0.0, angular_momentum = 0.0;  ///< largest changes, relative
  double energy = 0.0;                            ///< largest change of kinetic and strain energy, relative
  std::string failure;
  double end = 0.0;  ///< s
};

DiscRun run_disc(const DiscCase& disc);

}  // namespace wisp::powell_sabin
