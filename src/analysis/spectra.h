// Condition numbers and critical time steps of a run's matrices. Costly: whole spectra of small systems,
// Krylov iterations on large ones.
#pragma once
#include "analysis/model.h"
#include "analysis/options.h"
#include "linear/block_matrix.h"
#include "linear/dof_map.h"

namespace wisp {

/// Condition number (2-norm) of a matrix over local functions, on the given unknowns. Collective.
double condition_number(const BlockMatrix& matrix, const DofMap& unknowns);

/// What the time step of an explicit stage meets at the present state of the points: the mass that it solves
/// with (consistent: with Ghost if the model has it), on free unknowns.
template <int dim>
class ExplicitSpectrum {
 public:
  /// Collective. The points must be settled.
  ExplicitSpectrum(Model<dim>& model, Mass mass);
  /// Of the mass matrix (lumped: greatest over least mass).
  double condition() const;
  /// 2/sqrt(lambda_max) (s) of K v = lambda M v, K the stiffness of the points without Ghost, which explicit
  /// forces do not have (Coombs 2023, section 5.1). Infinite where nothing is stiff.
  double critical_time_step();

 private:
  Model<dim>& model_;
  bool consistent_;
  BlockMatrix mass_{1}, stiffness_{dim};
  std::vector<double> lumped_;  // n_functions
  DofMap unknowns_;
};

}  // namespace wisp
