// Extreme eigenvalues: condition numbers and critical time steps.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "linear/system_matrix.h"

namespace wisp {

/// Least and greatest absolute value of the eigenvalues of a symmetric matrix.
struct Extremes {
  double least = 0.0;
  double greatest = 0.0;
  /// Condition number in the 2-norm, infinite for a singular matrix, 1 for none.
  double condition() const {
    if (greatest == 0.0) return 1.0;
    return least > 0.0 ? greatest / least : std::numeric_limits<double>::infinity();
  }
};

/// Largest systems that are treated as dense matrices.
inline constexpr int largest_dense_spectrum = 1500;

/// Extremes of a symmetric matrix. One rank and few unknowns: all eigenvalues of the dense matrix; otherwise
/// SLEPc's Krylov–Schur iteration, the least by shift and inverse about zero. Absolute accuracy of about
/// 1e-15 of the greatest, so condition numbers beyond 1e15 mean "singular": see `graded_singular_values`.
/// Collective.
/// @throws RunError if the iteration does not converge
Extremes eigenvalue_extremes(const SystemMatrix& a, int largest_dense = largest_dense_spectrum);
Extremes eigenvalue_extremes(const Eigen::MatrixXd& a);

/// Singular values of a factor A (rows x n, any row count), greatest first, each to a relative accuracy that
/// does not depend on how widely A's rows and columns are graded: QR with column pivoting after sorting the
/// rows, then one-sided Jacobi rotations on the transposed triangle (Drmač and Veselić 2008). For a mass
/// matrix M = AᵀA with A = sqrt(m_p) N_i(x_p): its eigenvalues are the squares, and its condition number is
/// reliable far beyond 1e16. Rows of other quadratic terms of M (such as the square roots of the ghost
/// penalty's) may be stacked below.
Eigen::VectorXd graded_singular_values(const Eigen::MatrixXd& factor);
/// Extremes of AᵀA from the factor A.
Extremes factor_extremes(const Eigen::MatrixXd& factor);

/// Greatest eigenvalue of K v = lambda M v, K symmetric, M symmetric positive definite: the highest squared
/// angular frequency, so an explicit step is stable below 2/sqrt(lambda). Collective.
/// @throws RunError if M is not positive definite or the iteration does not converge
double greatest_pencil_eigenvalue(const SystemMatrix& k, const SystemMatrix& m,
                                  int largest_dense = largest_dense_spectrum);
/// The same for a lumped mass: positive diagonal entries of this rank's unknowns (n_owned).
double greatest_pencil_eigenvalue(const SystemMatrix& k, std::span<const double> lumped,
                                  int largest_dense = largest_dense_spectrum);

/// y from x, with current ghosts, and the inner product over all ranks: matrices that only their products
/// make known.
using LinearMap = std::function<void(const std::vector<double>& x, std::vector<double>& y)>;
using InnerProduct = std::function<double(const std::vector<double>&, const std::vector<double>&)>;

/// Greatest eigenvalue of K B, both symmetric, B positive semi-definite: Lanczos's iteration in the inner
/// product of B, for products of which no factor can be solved with. `start` must not be zero. Zero if K B
/// is. Collective.
/// @throws RunError if the iteration does not converge
double greatest_product_eigenvalue(const LinearMap& k, const LinearMap& b, const InnerProduct& dot,
                                   std::vector<double> start);

/// Greatest absolute value of the eigenvalues of any real square matrix, given as a function, by Arnoldi's
/// iteration without restarts, which keeps one array a step. Otherwise as above.
double greatest_magnitude(const LinearMap& a, const InnerProduct& dot, std::vector<double> start);

}  // namespace wisp
