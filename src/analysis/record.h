// What a step reports.
#pragma once
#include <vector>

#include "core/error.h"

namespace wisp {

/// Energies of all ranks. In explicit steps at the time level of the forces: kinetic energy of the points'
/// velocities at the start of the step, strain energy and dissipation of the stress used for the forces. The
/// grid sees less kinetic energy than the points carry (v^T M v / 2 of the start-of-step nodal velocity with
/// the consistent mass, without Ghost), because mapping smooths; only the points' closes the balance as the
/// time step goes to zero.
struct EnergyRecord {
  double kinetic = 0.0;        ///< J, of the points
  double grid_kinetic = 0.0;   ///< J, of the nodal velocity; zero in implicit analyses
  double strain = 0.0;         ///< J
  double dissipation = 0.0;    ///< J, plastic
  double external_work = 0.0;  ///< J, done on the bodies since the start
};

/// How an implicit step was found.
struct ImplicitRecord {
  int iterations = 0;   ///< Newton iterations, the first evaluation counted; of all parts of a cut step
  int cuts = 0;         ///< how often the step was halved
  double margin = 0.0;  ///< least |log10(residual / tolerance)|
  std::vector<double> residuals;  ///< relative residuals of the last Newton run
};

}  // namespace wisp
