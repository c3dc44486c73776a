// M x = b of an explicit step, solved as it stands or in one of the ways that keep it stable where functions
// have next to no mass.
#pragma once
#include <span>
#include <vector>

#include "basis/space.h"
#include "linear/mass_solver.h"
#include "stabilise/mass_options.h"
#include "transfer/active.h"

namespace wisp {

/// Flags of the functions that belong to a populated and to an unpopulated cell of the grid (n_functions):
/// the boundary functions of partial lumping (de Koster et al. 2021; thesis, section 5.4). The edge of the
/// grid does not count, so a body wants an empty row of cells around it. Owners and ghosts agree. Collective.
template <int dim>
std::vector<char> boundary_functions(const Space<dim>& space, const ActiveCells& cells);

/// Solves (M ⊗ I) x = b for a scalar mass matrix M:
/// - consistent: as it stands;
/// - partial: rows of boundary functions are lumped, x_i = b_i / m_i there, the others are solved with these
///   values (thesis, section 5.4). Momentum is not conserved: the columns stay;
/// - fmpm: x = sum_{l<k} (I - L^-1 M)^l L^-1 b with L the lumped mass (Nairn and Hammerquist 2021, eq. 13;
///   k = 1 is lumping). M = L on constants, so every k conserves momentum; the eigenvalues of L^-1 M lie in
///   (0, 1] for non-negative functions, so k to infinity is the consistent mass;
/// - any of them with a threshold: functions with M_ii below it are zero (thesis, section 5.2).
class MassEquation {
 public:
  explicit MassEquation(const MassTreatment& treatment = {}, const MassSolverOptions& options = {})
      : treatment_(treatment), options_(options), solver_(options) {}

  /// Takes the matrix of the following solves; it must stay alive and unchanged until they are done.
  /// `lumped`: mass of each function on all ranks (n_local, kg); `boundary`: see boundary_functions (only for
  /// `partial`); other arguments as in MassSolver. Collective.
  void set_matrix(const BlockMatrix& mass, const Halo& halo, int columns, std::vector<char> active,
                  std::span<const char> fixed, std::vector<double> lumped,
                  std::span<const char> boundary = {});

  /// As MassSolver::solve.
  SolveReport solve(std::span<const double> b, std::span<double> x);

  /// Functions that take part in the solves (n_local).
  std::span<const char> active() const { return active_; }
  /// Unknowns that no system is solved for (n_local x columns): fixed by a condition, or lumped.
  std::span<const char> held() const { return held_; }
  /// Drops what the solver keeps between steps.
  void renew() { solver_ = MassSolver(options_); }

 private:
  SolveReport sum_series(std::span<const double> b, std::span<double> x);

  MassTreatment treatment_;
  MassSolverOptions options_;
  MassSolver solver_;
  const BlockMatrix* mass_ = nullptr;
  Halo halo_;
  int columns_ = 0;
  std::vector<char> active_, given_;      // given_: n_local x columns, fixed by a condition
  std::vector<char> held_;                // given_ or lumped
  std::vector<double> lumped_, product_;  // n_local; n_local x columns
};

}  // namespace wisp
