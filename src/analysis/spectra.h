// Condition numbers and critical time steps of a run's matrices. Costly: whole spectra of small systems,
// Krylov iterations on large ones.
#pragma once
#include "analysis/model.h"
#include "analysis/options.h"
#include "linear/block_matrix.h"
#include "linear/dof_map.h"
#include "stabilise/mass_equation.h"

namespace wisp {

/// Condition number (2-norm) of a matrix over local functions, on the given unknowns. Collective.
double condition_number(const BlockMatrix& matrix, const DofMap& unknowns);

/// What the time step of an explicit stage meets at the present state of the points, on free unknowns and
/// without walls.
///
/// With W the operator that a step uses for the inverse of the mass (of the consistent mass M with Ghost, of
/// the lumped one, the series of FMPM, or partial lumping) and K the stiffness of the points, small motions
/// about a state obey v' = v - dt W M W K u: the points receive the acceleration W f and give their velocity
/// back to the grid by W again, so that the mass of the points stands between the two. With u' = u + dt v',
/// which is what `projected`, `musl` and, read the other way round, `usf` do, the step is stable up to
/// 2/sqrt(lambda) with lambda the greatest eigenvalue of W M W K. `usl` moves by v - dt W K u, and with
/// u* K (step) u every root obeys a real quadratic whose stability ends at z = -1, at the greatest eigenvalue
/// of (2 W - W M W) K. Where W M = 1 all of them are the lambda of K v = lambda M v (Coombs 2023,
/// section 5.1). Damping and shares of PIC, which take energy, are not counted.
template <int dim>
class ExplicitSpectrum {
 public:
  /// Of what `options` says of mass and stress update. Collective. The points must be settled.
  ExplicitSpectrum(Model<dim>& model, const ExplicitOptions& options);
  /// Of the matrix that the step solves with (with Ghost if the model has it; partial: without the lumped
  /// rows), or, of lumped masses and their series, greatest over least mass.
  double condition() const;
  /// s. Infinite where nothing is stiff. The W of partial lumping is not symmetric and W M W K has complex
  /// eigenvalues, which grow slowly at every step; the greatest magnitude tells where motions blow up at
  /// once.
  double critical_time_step();

 private:
  void assemble_stiffness();
  void inverse_mass(const std::vector<double>& b, std::vector<double>& x);
  void point_mass(const std::vector<double>& x, std::vector<double>& y);
  void stiffness(const std::vector<double>& x, std::vector<double>& y);
  void take(std::vector<double>& y);
  void step_inverse(const std::vector<double>& b, std::vector<double>& x);

  Model<dim>& model_;
  ExplicitOptions options_;
  bool exact_;  // W M = 1
  BlockMatrix mass_{1}, point_mass_{1}, stiffness_{dim};
  std::vector<double> lumped_;  // n_functions
  DofMap unknowns_, solved_;
  MassEquation equation_;
  std::vector<double> first_, second_, product_;  // scratch, n_functions x dim
};

}  // namespace wisp
