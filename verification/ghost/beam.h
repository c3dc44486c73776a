// The elastic beam of Coombs 2023, section 5.5: set-up and run, shared by Table 5 and figures 18 and 19.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "analysis/implicit.h"

namespace wisp::ghost_paper {

/// A cantilever 10 m x 1 m, E = 12 MPa, nu = 0.2, 100 kN at the free end in 50 steps.
struct BeamCase {
  double h = 0.5;                     ///< cell side, m
  int points = 2;                     ///< points a cell and direction
  std::optional<GhostOptions> ghost;  ///< none: standard GIMP
};

struct BeamRun {
  int finished = 0;                 ///< load steps that converged
  int iterations = 0;               ///< of all steps
  int most = 0;                     ///< of one step
  double margin = 0.0;              ///< least |log10(residual / tolerance)| of the run
  std::string failure;              ///< why it ended early; empty if complete
  std::vector<double> load;         ///< N, after each step
  std::vector<Vec<2>> tip;          ///< displacement of the loaded points' mean, m
  double point_seconds = 0.0;       ///< residual and tangent
  std::unique_ptr<Model<2>> model;  ///< the last converged state
};

inline constexpr int beam_steps = 50;

ModelOptions beam_options(const BeamCase& beam);
BeamRun run_beam(const BeamCase& beam);

}  // namespace wisp::ghost_paper
