#include "linear/spectrum.h"

#include <slepceps.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace wisp {
namespace {

using OwnedEps = PetscOwner<EPS, EPSDestroy>;

PetscInt size_of(::Mat a) {
  PetscInt n = 0;
  petsc(MatGetSize(a, &n, nullptr));
  return n;
}

MPI_Comm comm_of(::Mat a) { return PetscObjectComm(reinterpret_cast<PetscObject>(a)); }

/// Whether to form the dense matrix.
bool is_small(::Mat a, int largest_dense) {
  int ranks = 1;
  MPI_Comm_size(comm_of(a), &ranks);
  return ranks == 1 && size_of(a) <= largest_dense;
}

/// The symmetric part: entries of an assembled matrix are symmetric to rounding only.
Eigen::MatrixXd dense(::Mat a) {
  const PetscInt n = size_of(a);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  for (PetscInt i = 0; i < n; ++i) {
    PetscInt count = 0;
    const PetscInt* columns = nullptr;
    const PetscScalar* values = nullptr;
    petsc(MatGetRow(a, i, &count, &columns, &values));
    for (PetscInt k = 0; k < count; ++k) {
      result(i, columns[k]) += 0.5 * values[k];
      result(columns[k], i) += 0.5 * values[k];
    }
    petsc(MatRestoreRow(a, i, &count, &columns, &values));
  }
  return result;
}

/// One extreme eigenvalue of K v = lambda M v (m may be null: M = I) by Krylov–Schur.
double iterate(::Mat k, ::Mat m, bool least, double target = 0.0) {
  PetscBool started = PETSC_FALSE;
  petsc(SlepcInitialized(&started));
  if (!started) petsc(SlepcInitializeNoArguments());
  OwnedEps eps;
  petsc(EPSCreate(comm_of(k), eps.renew()));
  petsc(EPSSetOperators(eps.get(), k, m));
  petsc(EPSSetProblemType(eps.get(), m ? EPS_GHEP : EPS_HEP));
  petsc(EPSSetType(eps.get(), EPSKRYLOVSCHUR));
  petsc(EPSSetDimensions(eps.get(), 1, PETSC_DEFAULT, PETSC_DEFAULT));
  petsc(EPSSetTolerances(eps.get(), 1e-10, 2000));
  if (m || least) {
    ST st = nullptr;
    KSP ksp = nullptr;
    PC pc = nullptr;
    petsc(EPSGetST(eps.get(), &st));
    if (least) {
      petsc(STSetType(st, STSINVERT));
      petsc(EPSSetTarget(eps.get(), target));
    }
    petsc(STGetKSP(st, &ksp));
    petsc(KSPSetType(ksp, KSPPREONLY));
    petsc(KSPGetPC(ksp, &pc));
    petsc(PCSetType(pc, least ? PCLU : PCCHOLESKY));
    petsc(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  }
  petsc(EPSSetWhichEigenpairs(eps.get(), least ? EPS_TARGET_MAGNITUDE : EPS_LARGEST_MAGNITUDE));
  petsc(EPSSetOptionsPrefix(eps.get(), "wisp_"));
  petsc(EPSSetFromOptions(eps.get()));
  petsc(EPSSolve(eps.get()));
  PetscInt converged = 0;
  petsc(EPSGetConverged(eps.get(), &converged));
  if (converged < 1)
    run_error("the {} eigenvalue of a matrix of {} unknowns did not converge", least ? "least" : "greatest",
              size_of(k));
  double value = 0.0, imaginary = 0.0;
  petsc(EPSGetEigenvalue(eps.get(), 0, &value, &imaginary));
  return value;
}

/// Rotates columns i and j of a to be orthogonal; false if they already are.
bool rotate(Eigen::MatrixXd& a, Eigen::Index i, Eigen::Index j, double tolerance) {
  const double alpha = a.col(i).squaredNorm(), beta = a.col(j).squaredNorm();
  const double gamma = a.col(i).dot(a.col(j));
  if (std::abs(gamma) <= tolerance * std::sqrt(alpha) * std::sqrt(beta)) return false;
  const double zeta = (beta - alpha) / (2.0 * gamma);
  const double t = std::copysign(1.0, zeta) / (std::abs(zeta) + std::hypot(1.0, zeta));
  const double c = 1.0 / std::hypot(1.0, t), s = c * t;
  for (Eigen::Index k = 0; k < a.rows(); ++k) {
    const double x = a(k, i), y = a(k, j);
    a(k, i) = c * x - s * y;
    a(k, j) = s * x + c * y;
  }
  return true;
}

}  // namespace

Extremes eigenvalue_extremes(const Eigen::MatrixXd& a) {
  if (a.rows() == 0) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a, Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success)
    run_error(
        "the eigenvalues of a matrix of {} unknowns did not converge: it has entries that are not finite",
        a.rows());
  const Eigen::VectorXd magnitudes = solver.eigenvalues().cwiseAbs();
  return {magnitudes.minCoeff(), magnitudes.maxCoeff()};
}

Extremes eigenvalue_extremes(const SystemMatrix& a, int largest_dense) {
  if (is_small(a.mat(), largest_dense)) return eigenvalue_extremes(dense(a.mat()));
  // The shift lies below a semidefinite spectrum by less than the accuracy, so a singular matrix can be
  // factorised.
  const double greatest = std::abs(iterate(a.mat(), nullptr, false));
  return {std::abs(iterate(a.mat(), nullptr, true, -1e-15 * greatest)), greatest};
}

Eigen::VectorXd graded_singular_values(const Eigen::MatrixXd& factor) {
  const Eigen::Index n = factor.cols();
  if (!factor.allFinite()) run_error("a factor of {} x {} has entries that are not finite", factor.rows(), n);
  // Large rows first: with column pivoting, Householder's QR is then accurate row by row as well as column by
  // column.
  std::vector<Eigen::Index> order(static_cast<std::size_t>(factor.rows()));
  std::iota(order.begin(), order.end(), 0);
  const Eigen::VectorXd sizes = factor.cwiseAbs().rowwise().maxCoeff();
  std::stable_sort(order.begin(), order.end(), [&](auto i, auto j) { return sizes[i] > sizes[j]; });
  Eigen::MatrixXd sorted = Eigen::MatrixXd::Zero(std::max(factor.rows(), n), n);
  for (std::size_t i = 0; i < order.size(); ++i)
    sorted.row(static_cast<Eigen::Index>(i)) = factor.row(order[i]);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(sorted);
  // The columns of the lower triangle Rᵀ are nearly orthogonal and ordered by size: few rotations are left.
  Eigen::MatrixXd lower = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>().transpose();
  const double tolerance = 1e-15 * std::sqrt(static_cast<double>(std::max<Eigen::Index>(n, 1)));
  constexpr int most_sweeps = 60;
  for (int sweep = 0;; ++sweep) {
    if (sweep == most_sweeps) run_error("the singular values of a factor of {} columns did not converge", n);
    bool rotated = false;
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = i + 1; j < n; ++j) rotated = rotate(lower, i, j, tolerance) || rotated;
    if (!rotated) break;
  }
  Eigen::VectorXd values = lower.colwise().norm();
  std::sort(values.begin(), values.end(), std::greater<>());
  return values;
}

Extremes factor_extremes(const Eigen::MatrixXd& factor) {
  if (factor.cols() == 0) return {};
  const Eigen::VectorXd values = graded_singular_values(factor);
  const double least = values[values.size() - 1], greatest = values[0];
  return {least * least, greatest * greatest};
}

double greatest_pencil_eigenvalue(const SystemMatrix& k, const SystemMatrix& m, int largest_dense) {
  if (size_of(k.mat()) != size_of(m.mat()))
    run_error("stiffness and mass have {} and {} unknowns", size_of(k.mat()), size_of(m.mat()));
  if (size_of(k.mat()) == 0) return 0.0;
  if (!is_small(k.mat(), largest_dense)) return iterate(k.mat(), m.mat(), false);
  const Eigen::MatrixXd mass = dense(m.mat());
  if (mass.llt().info() != Eigen::Success)
    run_error("a mass matrix of {} unknowns is not positive definite: its critical time step is zero",
              mass.rows());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(dense(k.mat()), mass,
                                                                         Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success)
    run_error("the eigenvalues of a pencil of {} unknowns did not converge", mass.rows());
  return solver.eigenvalues().maxCoeff();
}

double greatest_pencil_eigenvalue(const SystemMatrix& k, std::span<const double> lumped, int largest_dense) {
  if (size_of(k.mat()) == 0) return 0.0;
  if (!std::all_of(lumped.begin(), lumped.end(), [](double mass) { return mass > 0.0; }))
    run_error("a lumped mass of {} unknowns is not positive: its critical time step is zero", lumped.size());
  // D^-1/2 K D^-1/2 has the eigenvalues of the pencil.
  OwnedVec scale;
  petsc(
      VecCreateMPI(comm_of(k.mat()), static_cast<PetscInt>(lumped.size()), size_of(k.mat()), scale.renew()));
  double* values = nullptr;
  petsc(VecGetArray(scale.get(), &values));
  for (std::size_t i = 0; i < lumped.size(); ++i) values[i] = 1.0 / std::sqrt(lumped[i]);
  petsc(VecRestoreArray(scale.get(), &values));
  OwnedMat scaled;
  petsc(MatDuplicate(k.mat(), MAT_COPY_VALUES, scaled.renew()));
  petsc(MatDiagonalScale(scaled.get(), scale.get(), scale.get()));
  if (!is_small(scaled.get(), largest_dense)) return iterate(scaled.get(), nullptr, false);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(dense(scaled.get()), Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success)
    run_error("the eigenvalues of a matrix of {} unknowns did not converge", size_of(scaled.get()));
  return solver.eigenvalues().maxCoeff();
}

double greatest_product_eigenvalue(const LinearMap& k, const LinearMap& b, const InnerProduct& dot,
                                   std::vector<double> start) {
  constexpr int most_steps = 400;
  constexpr double tolerance = 1e-9;
  std::vector<double> q = std::move(start), before(q.size(), 0.0), bq(q.size()), w(q.size());
  b(q, bq);
  double length = std::sqrt(std::max(0.0, dot(q, bq)));
  std::vector<double> diagonal, beside;
  double greatest = 0.0;
  for (int step = 0; step < most_steps && length > 0.0; ++step) {
    for (std::size_t i = 0; i < q.size(); ++i) q[i] /= length, bq[i] /= length;
    k(bq, w);
    diagonal.push_back(dot(w, bq));
    const double alpha = diagonal.back(), beta = step > 0 ? beside.back() : 0.0;
    for (std::size_t i = 0; i < q.size(); ++i) w[i] -= alpha * q[i] + beta * before[i];
    before.swap(q), q.swap(w);
    b(q, bq);
    length = std::sqrt(std::max(0.0, dot(q, bq)));
    const auto n = static_cast<Eigen::Index>(diagonal.size());
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
    ritz.computeFromTridiagonal(Eigen::Map<const Eigen::VectorXd>(diagonal.data(), n),
                                Eigen::Map<const Eigen::VectorXd>(beside.data(), n - 1));
    greatest = ritz.eigenvalues()[n - 1];
    // Residual of the Ritz pair: the next coefficient times the last component of its vector.
    if (length * std::abs(ritz.eigenvectors()(n - 1, n - 1)) <= tolerance * std::abs(greatest))
      return std::max(greatest, 0.0);
    beside.push_back(length);
  }
  if (length > 0.0) run_error("the greatest eigenvalue of a product of matrices did not converge");
  return std::max(greatest, 0.0);
}

double greatest_magnitude(const LinearMap& a, const InnerProduct& dot, std::vector<double> start) {
  constexpr Eigen::Index most_steps = 200;
  constexpr double tolerance = 1e-8;
  std::vector<std::vector<double>> q;
  std::vector<double> w = std::move(start);
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(most_steps + 1, most_steps);
  double length = std::sqrt(dot(w, w)), greatest = 0.0;
  for (Eigen::Index n = 1; n <= most_steps && length > 0.0; ++n) {
    q.push_back(w);
    for (double& x : q.back()) x /= length;
    a(q.back(), w);
    for (int pass = 0; pass < 2; ++pass)  // twice is enough
      for (std::size_t j = 0; j < q.size(); ++j) {
        const double share = dot(q[j], w);
        h(static_cast<Eigen::Index>(j), n - 1) += share;
        for (std::size_t i = 0; i < w.size(); ++i) w[i] -= share * q[j][i];
      }
    length = std::sqrt(dot(w, w));
    h(n, n - 1) = length;
    const Eigen::EigenSolver<Eigen::MatrixXd> ritz(h.topLeftCorner(n, n));
    Eigen::Index most = 0;
    greatest = ritz.eigenvalues().cwiseAbs().maxCoeff(&most);
    if (length * std::abs(ritz.eigenvectors()(n - 1, most)) <= tolerance * greatest) return greatest;
  }
  if (length > 0.0) run_error("the greatest eigenvalue of a product of matrices did not converge");
  return greatest;
}

}  // namespace wisp
