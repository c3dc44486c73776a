#include "linear/solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wisp {
namespace {

/// A vector over the caller's numbers.
OwnedVec wrap(MPI_Comm comm, std::span<const double> values, PetscInt n_global) {
  OwnedVec v;
  petsc(VecCreateMPIWithArray(comm, 1, static_cast<PetscInt>(values.size()), n_global, values.data(),
                              v.renew()));
  return v;
}

/// Sparse direct solvers win below these sizes (measured on 2D and 3D elasticity; fill grows much faster in
/// 3D).
int largest_direct(int dim) { return dim == 2 ? 50000 : 4000; }

/// The case's own options, in force while this lives: PETSc reads some when it makes a solver, some when it
/// factorises. They are a database of their own, so that nothing leaks into another solver.
class OptionScope {
 public:
  explicit OptionScope(const std::string& text) {
    if (text.empty()) return;
    petsc(PetscOptionsCreate(&options_));
    if (PetscOptionsInsertString(options_, text.c_str()) != 0)
      input_error("petsc_options cannot be read: \"{}\"", text);
    petsc(PetscOptionsPush(options_));
  }
  ~OptionScope() {
    if (!options_) return;
    PetscOptionsPop();
    PetscOptionsDestroy(&options_);
  }
  OptionScope(const OptionScope&) = delete;
  OptionScope& operator=(const OptionScope&) = delete;

  /// After a solve: PETSc ignores options that no part of it asks for, so a misspelt one would go unnoticed.
  void check_used() const {
    if (!options_) return;
    PetscInt n = 0;
    char **names = nullptr, **values = nullptr;
    petsc(PetscOptionsLeftGet(options_, &n, &names, &values));
    const std::string first = n > 0 ? names[0] : "";
    petsc(PetscOptionsLeftRestore(options_, &n, &names, &values));
    if (!first.empty())
      input_error(
          "petsc_options: nothing in the chosen solver reads \"-{}\"; check its spelling, and that the "
          "solver "
          "it belongs to is chosen (-ksp_type, -pc_type)",
          first);
  }

 private:
  PetscOptions options_ = nullptr;
};

std::string reason_text(KSP ksp, KSPConvergedReason reason) {
  if (reason == KSP_DIVERGED_PC_FAILED) {
    PC pc = nullptr;
    KSPGetPC(ksp, &pc);
    PCFailedReason failed = PC_NOERROR;
    PCGetFailedReason(pc, &failed);
    if (failed == PC_FACTOR_STRUCT_ZEROPIVOT || failed == PC_FACTOR_NUMERIC_ZEROPIVOT)
      return "the matrix is singular (a zero pivot in its factorisation)";
    if (failed == PC_FACTOR_OUTMEMORY) return "the factorisation ran out of memory";
    return "the preconditioner could not be set up";
  }
  if (reason == KSP_DIVERGED_ITS) return "the iteration did not converge within its limit";
  if (reason == KSP_DIVERGED_NANORINF) return "the iteration met a number that is not finite";
  if (reason == KSP_DIVERGED_INDEFINITE_PC || reason == KSP_DIVERGED_INDEFINITE_MAT)
    return "the matrix is not positive definite";
  return KSPConvergedReasons[reason];
}

}  // namespace

void LinearSolver::reset() {
  ksp_.reset();
  structure_ = 0;
}

void LinearSolver::choose_direct(KSP ksp) {
  // MUMPS on one rank as on many: it pivots (also in L D L^T, so a symmetric matrix may turn indefinite), it
  // reports a zero pivot instead of dividing by it, and on 4000 to 40000 unknowns it was as fast as PETSc's
  // own factorisation, which does not pivot, and about twice as fast as UMFPACK. L D L^T, for values that are
  // symmetric, takes two thirds of the time of LU.
  PC pc = nullptr;
  petsc(KSPSetType(ksp, KSPPREONLY));
  petsc(KSPGetPC(ksp, &pc));
  petsc(PCSetType(pc, symmetric_ ? PCCHOLESKY : PCLU));
  petsc(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
}

void LinearSolver::choose_iterative(KSP ksp, ::Mat mat) {
  PC pc = nullptr;
  petsc(KSPSetType(ksp, traits_.symmetric ? KSPCG : KSPGMRES));
  petsc(KSPGetPC(ksp, &pc));
  petsc(PCSetType(pc, PCGAMG));
  PetscInt block = 1;
  petsc(MatGetBlockSize(mat, &block));
  if (block == traits_.dim && !traits_.coordinates.empty()) {
    PetscInt rows = 0;
    petsc(MatGetLocalSize(mat, &rows, nullptr));
    if (static_cast<std::size_t>(rows) != traits_.coordinates.size())
      run_error("multigrid was given {} coordinates for {} unknowns", traits_.coordinates.size(), rows);
    OwnedVec coordinates;
    petsc(VecCreateMPI(PetscObjectComm(reinterpret_cast<PetscObject>(mat)), rows, PETSC_DETERMINE,
                       coordinates.renew()));
    petsc(VecSetBlockSize(coordinates.get(), block));
    double* values = nullptr;
    petsc(VecGetArray(coordinates.get(), &values));
    std::copy(traits_.coordinates.begin(), traits_.coordinates.end(), values);
    petsc(VecRestoreArray(coordinates.get(), &values));
    MatNullSpace modes = nullptr;
    petsc(MatNullSpaceCreateRigidBody(coordinates.get(), &modes));
    petsc(MatSetNearNullSpace(mat, modes));
    MatNullSpaceDestroy(&modes);
  }
}

FixedUnknowns LinearSolver::numbering(int n_unknowns) const {
  return goes_direct(n_unknowns) ? FixedUnknowns::removed : FixedUnknowns::unit_rows;
}

bool LinearSolver::goes_direct(int n_unknowns) const {
  if (options_.solver != SolverKind::automatic) return options_.solver == SolverKind::direct;
  return iteration_failed_ || n_unknowns <= largest_direct(traits_.dim);
}

bool LinearSolver::takes_as_symmetric(const SystemMatrix& matrix) const {
  // A package that the case asks for may know LU only, so its options also decide on the factorisation.
  return traits_.symmetric || (options_.petsc_options.empty() && matrix.symmetric());
}

void LinearSolver::set_up(const SystemMatrix& matrix) {
  ::Mat mat = matrix.mat();
  PetscInt n = 0;
  petsc(MatGetSize(mat, &n, nullptr));
  direct_ = goes_direct(n);
  symmetric_ = takes_as_symmetric(matrix);
  petsc(KSPCreate(PetscObjectComm(reinterpret_cast<PetscObject>(mat)), ksp_.renew()));
  KSP ksp = ksp_.get();
  if (options_.petsc_options.empty()) petsc(KSPSetOptionsPrefix(ksp, "wisp_"));
  petsc(KSPSetOperators(ksp, mat, mat));
  petsc(KSPSetTolerances(ksp, options_.tolerance, 0.0, 1e10, options_.max_iterations));
  if (traits_.symmetric && !direct_) petsc(KSPSetNormType(ksp, KSP_NORM_UNPRECONDITIONED));
  direct_ ? choose_direct(ksp) : choose_iterative(ksp, mat);
  petsc(KSPSetInitialGuessNonzero(ksp, direct_ ? PETSC_FALSE : PETSC_TRUE));
  petsc(KSPSetFromOptions(ksp));
  structure_ = matrix.structure();
  PC pc = nullptr;
  PetscBool lu = PETSC_FALSE, cholesky = PETSC_FALSE;
  petsc(KSPGetPC(ksp, &pc));
  petsc(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), PCLU, &lu));
  petsc(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), PCCHOLESKY, &cholesky));
  if (!lu && !cholesky) return;
  ::Mat factor = nullptr;
  petsc(PCFactorSetUpMatSolverType(pc));
  petsc(PCFactorGetMatrix(pc, &factor));
  // Delayed pivots of an ill-conditioned matrix need more than the 20 % of spare room that MUMPS takes by
  // itself.
  petsc(MatMumpsSetIcntl(factor, 14, 100));
  // Quotient minimum degree saved up to a third of the time of small systems; nested dissection wins on large
  // ones.
  if (n < 15000) petsc(MatMumpsSetIcntl(factor, 7, 6));
}

double LinearSolver::residual(::Mat mat, ::Vec b, ::Vec x) const {
  OwnedVec r;
  double norm_b = 0.0, norm_r = 0.0;
  petsc(VecDuplicate(b, r.renew()));
  petsc(MatMult(mat, x, r.get()));
  petsc(VecAYPX(r.get(), -1.0, b));
  petsc(VecNorm(r.get(), NORM_2, &norm_r));
  petsc(VecNorm(b, NORM_2, &norm_b));
  return norm_b > 0.0 ? norm_r / norm_b : norm_r;
}

SolveReport LinearSolver::solve(const SystemMatrix& matrix, std::span<const double> b, std::span<double> x,
                                bool keep) {
  SolveReport report = solve_once(matrix, b, x, keep);
  const bool may_switch = options_.solver == SolverKind::automatic && options_.petsc_options.empty();
  if (report.solved || direct_ || !may_switch) return report;
  iteration_failed_ = true;  // from now on: the next matrix will hardly be kinder
  reset();
  std::fill(x.begin(), x.end(), 0.0);
  return solve_once(matrix, b, x, false);
}

SolveReport LinearSolver::solve_once(const SystemMatrix& matrix, std::span<const double> b,
                                     std::span<double> x, bool keep) {
  const OptionScope scope(options_.petsc_options);
  SolveReport report;
  ::Mat mat = matrix.mat();
  PetscInt n_global = 0;
  petsc(MatGetSize(mat, &n_global, nullptr));
  if (n_global == 0) return report;
  const bool other_form = direct_ && !keep && symmetric_ != takes_as_symmetric(matrix);
  const bool anew = !ksp_ || structure_ != matrix.structure() || other_form;
  if (anew) {
    set_up(matrix);
    keep = false;
  }
  KSP ksp = ksp_.get();
  const MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(mat));
  const OwnedVec rhs = wrap(comm, b, n_global);
  const OwnedVec solution = wrap(comm, x, n_global);
  PetscErrorCode code = 0;
  {
    const QuietPetsc
        quiet;  // some packages report a singular matrix as an error, which is no reason to abort
    code = KSPSetReusePreconditioner(ksp, keep ? PETSC_TRUE : PETSC_FALSE);
    if (code == 0) code = KSPSetOperators(ksp, mat, mat);
    if (code == 0) code = KSPSolve(ksp, rhs.get(), solution.get());
  }
  if (code != 0) {
    const char* text = nullptr;
    PetscErrorMessage(code, &text, nullptr);
    report = {false, 0, 1.0, fmt::format("the solver stopped: {}", text ? text : "unknown cause")};
    reset();
    return report;
  }
  if (anew) scope.check_used();
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  petsc(KSPGetConvergedReason(ksp, &reason));
  petsc(KSPGetIterationNumber(ksp, &iterations));
  report.iterations = static_cast<int>(iterations);
  if (reason < 0) {
    report.solved = false;
    report.residual = 1.0;
    report.cause = reason_text(ksp, reason);
    return report;
  }
  report.residual = residual(mat, rhs.get(), solution.get());
  if (!(report.residual <= 1.0)) {  // also catches NaN: UMFPACK divides by a zero pivot without a word
    report.solved = false;
    report.cause = "the matrix is singular to working precision";
  }
  return report;
}

SolveReport LinearSolver::solve(const SystemMatrix& matrix, const DofMap& dofs, const Halo& halo,
                                std::span<const double> rhs, std::span<double> solution, bool keep) {
  b_.resize(static_cast<std::size_t>(dofs.n_owned()));
  x_.resize(b_.size());
  dofs.gather(rhs, b_);
  dofs.gather(solution, x_);
  SolveReport report = solve(matrix, b_, x_, keep);
  dofs.scatter(x_, solution, halo);
  return report;
}

}  // namespace wisp
