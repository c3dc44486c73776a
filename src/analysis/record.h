// What a step reports.
#pragma once
#include <vector>

#include "core/error.h"

namespace wisp {

/// A step that all ranks together could not do. The state at its start stands (of a step that was cut: what
/// has been done of it), so a run may keep it.
class StepRefused : public RunError {
 public:
  using RunError::RunError;
};

/// Energies of all ranks at one time level: that of the forces of the step (explicit: kinetic energy v^T M v
/// / 2 of the start-of-step grid velocity with the consistent mass, without Ghost; strain energy of the
/// stress used for the forces).
struct EnergyRecord {
  double kinetic = 0.0;        ///< J
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
