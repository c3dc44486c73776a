// The consistent mass of an explicit step: many small systems, several right-hand sides, little time.
#pragma once
#include <memory>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/describe.h"
#include "linear/solver.h"

namespace wisp {

/// How systems with a consistent mass matrix are solved.
struct MassSolverOptions {
  static constexpr std::string_view name = "mass-solver";
  static constexpr std::string_view summary = "how systems with a consistent mass matrix are solved";
  static constexpr std::string_view source = "";

  SolverKind solver = SolverKind::automatic;
  double tolerance = 1e-12;
  int max_iterations = 500;

  static constexpr auto keys() {
    return std::tuple{
        key("solver", &MassSolverOptions::solver, "",
            "auto: conjugate gradients, and a sparse factorisation where they do not converge (then for a "
            "number of solves at once)"),
        key("tolerance", &MassSolverOptions::tolerance, "-",
            "residual relative to the right-hand side, in the norm of the inverse of the diagonal")
            .positive()
            .below(1.0),
        key("max_iterations", &MassSolverOptions::max_iterations, "-",
            "most iterations of conjugate gradients")
            .at_least(1)};
  }
};

/// Solves (M ⊗ I) x = b for a scalar symmetric positive definite M, 1 to 4 columns at once. All columns share
/// each pass over the matrix: on grids of 100 to 10000 functions these conjugate gradients (Jacobi, started
/// from the caller's x) cost less than a sparse factorisation of M, and they need no matrix assembled over
/// ranks.
class MassSolver {
 public:
  explicit MassSolver(MassSolverOptions options = {}) : options_(options) {}

  /// Takes the matrix of the following solves; `mass` (block size 1) must stay alive and unchanged until they
  /// are done. `active`: n_local flags; `fixed`: n_local x columns flags, or empty; both agree on owners and
  /// ghosts. Collective.
  void set_matrix(const BlockMatrix& mass, const Halo& halo, int columns, std::span<const char> active,
                  std::span<const char> fixed = {});

  /// Local dense arrays n_local x columns. `b` is complete on owners. `x` holds the initial guess with
  /// current ghosts; fixed unknowns keep their values in it (their rows are dropped), functions that are
  /// inactive become zero. Ghosts are current afterwards. If the report says not `solved`, x is unusable.
  /// Collective.
  SolveReport solve(std::span<const double> b, std::span<double> x);

 private:
  // The direct path keeps one system per column; columns with the same free unknowns share theirs.
  struct Factor {
    std::vector<char> free;
    DofMap dofs;
    SystemMatrix matrix;
    LinearSolver solver;
    bool current = false;
  };
  // Conjugate gradients, m columns at once, each with its own scalars.
  template <int m>
  double start(std::span<const double> b, std::span<const double> x, double* rho);
  template <int m>
  void turn(const double* beta, double* curvature);
  template <int m>
  void advance(const double* alpha, double* rho);
  template <int m>
  SolveReport iterate(std::span<const double> b, std::span<double> x);
  template <int m>
  void apply(const std::vector<double>& p, std::vector<double>& ap);
  void take_flags(std::span<const char> active, std::span<const char> fixed);
  void take_diagonal();
  void make_compact(std::span<const char> active);
  void to_compact(std::span<const double> local, std::vector<double>& compact) const;
  void from_compact(const std::vector<double>& compact, std::span<double> local) const;
  void sum_over_ranks(double* values, int count) const;
  Factor& factor_for(std::size_t column);
  SolveReport factorise_and_solve(std::span<const double> b, std::span<double> x);

  MassSolverOptions options_;
  const BlockMatrix* mass_ = nullptr;
  Halo halo_;
  int columns_ = 0;
  // Functions with entries, numbered without gaps ("compact"): a body fills a small part of its grid.
  std::int64_t pattern_id_ = 0;
  std::vector<int> functions_;  // compact -> local
  std::vector<char> listed_;    // local: whether it is in the compact list
  std::vector<int> starts_;     // rows of the compact matrix
  std::vector<int>
      compact_columns_;          // its columns; its values are those of the block matrix, in the same order
  std::vector<char> active_;     // n_local
  std::vector<char> fixed_;      // n_local x columns
  std::vector<double> mask_;     // compact x columns: 1 at free unknowns that this rank owns
  std::vector<double> inverse_;  // compact: inverse of the diagonal
  // Where conjugate gradients failed they mostly fail again: the next solves go direct at once, twice as many
  // after each failure in a row.
  int direct_left_ = 0, direct_next_ = 1;
  std::vector<double> guess_, b_, x_, r_, p_, ap_, local_;
  std::vector<std::unique_ptr<Factor>> factors_;
};

}  // namespace wisp
