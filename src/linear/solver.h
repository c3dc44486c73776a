// Linear systems: PETSc's solvers with defaults that suit the material point method.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/describe.h"
#include "core/error.h"
#include "linear/system_matrix.h"

namespace wisp {

enum class SolverKind { automatic, direct, iterative };
template <>
inline constexpr auto choices<SolverKind> = choice_list<SolverKind>({{"auto", SolverKind::automatic},
                                                                     {"direct", SolverKind::direct},
                                                                     {"iterative", SolverKind::iterative}});

/// How linear systems are solved.
struct SolverOptions {
  static constexpr std::string_view name = "solver";
  static constexpr std::string_view summary = "how linear systems are solved";
  static constexpr std::string_view source = "";

  SolverKind solver = SolverKind::automatic;
  double tolerance = 1e-10;
  int max_iterations = 1000;
  std::string petsc_options{};

  static constexpr auto keys() {
    return std::tuple{
        key("solver", &SolverOptions::solver, "",
            "auto: a sparse direct solver for small systems and where iterations fail, else multigrid"),
        key("tolerance", &SolverOptions::tolerance, "-",
            "relative residual at which an iterative solver stops")
            .positive()
            .below(1.0),
        key("max_iterations", &SolverOptions::max_iterations, "-", "most iterations of an iterative solver")
            .at_least(1),
        key("petsc_options", &SolverOptions::petsc_options, "",
            "options of PETSc's KSP and PC, such as \"-ksp_type minres -pc_type jacobi\"; they override the "
            "above")};
  }
};

/// What is known of a matrix beyond its entries.
struct MatrixTraits {
  int dim = 2;  ///< space dimension: direct solvers fill in faster in 3D
  /// Symmetric positive definite: conjugate gradients, otherwise GMRES. A direct solver sees symmetry itself.
  bool symmetric = false;
  /// Coordinates of this rank's unknowns, n_owned/components x dim, for multigrid's rigid-body modes; only
  /// used when the numbering keeps whole blocks (FixedUnknowns::unit_rows). May be empty.
  std::vector<double> coordinates;
};

/// How a solve went. `solved` is false when the factorisation met a singular matrix, the result is not finite
/// or worse than none, or the iteration did not converge; `cause` then says which.
struct SolveReport {
  bool solved = true;
  int iterations = 0;     ///< 1 for a direct solver
  double residual = 0.0;  ///< |b - A x| / |b|
  std::string cause;
};

/// A linear solver that keeps its factorisation or preconditioner between calls. Same input, same bits (on
/// one rank).
class LinearSolver {
 public:
  explicit LinearSolver(SolverOptions options = {}, MatrixTraits traits = {})
      : options_(std::move(options)), traits_(std::move(traits)) {}

  const SolverOptions& options() const { return options_; }
  void set_traits(MatrixTraits traits) { traits_ = std::move(traits); }

  /// Solves A x = b for this rank's entries (n_owned each). With an iterative solver x is the initial guess.
  /// `keep`: A has not changed since the last call, or an old factorisation may serve as the preconditioner.
  /// Collective.
  SolveReport solve(const SystemMatrix& matrix, std::span<const double> b, std::span<double> x,
                    bool keep = false);
  /// Between local dense arrays (n_local x components): `rhs` is complete on owners, `solution` also on
  /// ghosts.
  SolveReport solve(const SystemMatrix& matrix, const DofMap& dofs, const Halo& halo,
                    std::span<const double> rhs, std::span<double> solution, bool keep = false);

  /// How to number a system of `n_unknowns` for this solver: without the fixed unknowns for a direct solver,
  /// in whole blocks for multigrid.
  FixedUnknowns numbering(int n_unknowns) const;
  /// Whether the last set-up chose a direct solver.
  bool direct() const { return direct_; }
  /// Frees the factorisation.
  void reset();

 private:
  SolveReport solve_once(const SystemMatrix& matrix, std::span<const double> b, std::span<double> x,
                         bool keep);
  bool goes_direct(int n_unknowns) const;
  bool takes_as_symmetric(const SystemMatrix& matrix) const;
  void set_up(const SystemMatrix& matrix);
  void choose_direct(KSP ksp);
  void choose_iterative(KSP ksp, ::Mat mat);
  double residual(::Mat mat, ::Vec b, ::Vec x) const;

  SolverOptions options_;
  MatrixTraits traits_;
  bool direct_ = false;
  bool symmetric_ = false;  // of the factorisation
  bool iteration_failed_ = false;
  std::int64_t structure_ = 0;
  OwnedKsp ksp_;
  std::vector<double> b_, x_;
};

}  // namespace wisp
