#include "linear/mass_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wisp {
namespace {
std::size_t at(int i) { return static_cast<std::size_t>(i); }
}  // namespace

void MassSolver::set_matrix(const BlockMatrix& mass, const Halo& halo, int columns,
                            std::span<const char> active, std::span<const char> fixed) {
  if (mass.block() != 1) run_error("a mass matrix is scalar, this one has blocks of {}", mass.block());
  if (columns < 1 || columns > 4)
    run_error("a mass matrix is solved for 1 to 4 columns at once, not {}", columns);
  const auto n = at(mass.n_local());
  if (halo.n_local() != mass.n_local() || active.size() != n ||
      (!fixed.empty() && fixed.size() != n * at(columns)))
    run_error("the flags of {} functions have {} active and {} fixed entries", n, active.size(),
              fixed.size());
  mass_ = &mass;
  halo_ = halo;
  columns_ = columns;
  // A rank may own active functions that only the points of its neighbours reach: no entry here, but solved
  // here.
  bool known = pattern_id_ == mass.pattern_id();
  for (std::size_t f = 0; known && f < n; ++f) known = !active[f] || listed_[f];
  if (!known) make_compact(active);
  take_flags(active, fixed);
  take_diagonal();
  for (auto& factor : factors_) factor->current = false;
}

void MassSolver::make_compact(std::span<const char> active) {
  const Sparsity& pattern = mass_->pattern();
  const auto starts = pattern.starts();
  std::vector<int> compact(at(pattern.n_local()), -1);
  functions_.clear();
  listed_.assign(at(pattern.n_local()), 0);
  starts_.assign(1, 0);
  for (int f = 0; f < pattern.n_local(); ++f) {
    if (starts[at(f)] == starts[at(f) + 1] && !active[at(f)]) continue;
    listed_[at(f)] = 1;
    compact[at(f)] = static_cast<int>(functions_.size());
    functions_.push_back(f);
    starts_.push_back(starts[at(f) + 1]);
  }
  compact_columns_.resize(pattern.columns().size());
  std::transform(pattern.columns().begin(), pattern.columns().end(), compact_columns_.begin(),
                 [&](int f) { return compact[at(f)]; });
  pattern_id_ = mass_->pattern_id();
}

void MassSolver::take_flags(std::span<const char> active, std::span<const char> fixed) {
  active_.assign(active.begin(), active.end());
  fixed_.assign(active.size() * at(columns_), 0);
  std::copy(fixed.begin(), fixed.end(), fixed_.begin());
  mask_.resize(functions_.size() * at(columns_));
  for (std::size_t k = 0; k < functions_.size(); ++k) {
    const int f = functions_[k];
    const bool used = active[at(f)] && halo_.owns(f);
    for (std::size_t c = 0; c < at(columns_); ++c)
      mask_[k * at(columns_) + c] = used && !fixed_[at(f) * at(columns_) + c] ? 1.0 : 0.0;
  }
}

void MassSolver::take_diagonal() {
  local_.resize(at(mass_->n_local()));
  mass_->diagonal(local_);
  halo_.add(local_.data(), 1);
  inverse_.resize(functions_.size());
  for (std::size_t k = 0; k < functions_.size(); ++k) {
    const double d = local_[at(functions_[k])];
    const auto* mask = mask_.data() + k * at(columns_);
    const bool solved_for = std::any_of(mask, mask + columns_, [](double v) { return v != 0.0; });
    // A free unknown without mass makes the residual NaN, which ends the iteration at its start, on all
    // ranks.
    inverse_[k] = !solved_for ? 0.0 : d > 0.0 ? 1.0 / d : std::numeric_limits<double>::quiet_NaN();
  }
}

void MassSolver::to_compact(std::span<const double> local, std::vector<double>& compact) const {
  const auto m = at(columns_);
  compact.resize(functions_.size() * m);
  for (std::size_t k = 0; k < functions_.size(); ++k)
    for (std::size_t c = 0; c < m; ++c) compact[k * m + c] = local[at(functions_[k]) * m + c];
}

void MassSolver::from_compact(const std::vector<double>& compact, std::span<double> local) const {
  const auto m = at(columns_);
  for (std::size_t k = 0; k < functions_.size(); ++k)
    for (std::size_t c = 0; c < m; ++c) local[at(functions_[k]) * m + c] = compact[k * m + c];
}

void MassSolver::sum_over_ranks(double* values, int count) const {
  if (!halo_.serial()) MPI_Allreduce(MPI_IN_PLACE, values, count, MPI_DOUBLE, MPI_SUM, halo_.comm());
}

template <int m>
void MassSolver::apply(const std::vector<double>& p, std::vector<double>& ap) {
  const double* values = mass_->values().data();
  const int* columns = compact_columns_.data();
  const double* in = p.data();
  for (std::size_t f = 0; f < functions_.size(); ++f) {
    double sum[m] = {};
    for (int k = starts_[f]; k < starts_[f + 1]; ++k) {
      const double a = values[k];
      const double* x = in + at(columns[k]) * m;
      for (int c = 0; c < m; ++c) sum[c] += a * x[c];
    }
    for (int c = 0; c < m; ++c) ap[f * m + at(c)] = sum[c];
  }
  if (halo_.serial()) return;
  local_.assign(at(mass_->n_local()) * m, 0.0);
  from_compact(ap, local_);
  halo_.add(local_.data(), m);
  to_compact(local_, ap);
}

template <int m>
double MassSolver::start(std::span<const double> b, std::span<const double> x, double* rho) {
  to_compact(b, b_);
  to_compact(x, x_);
  for (std::size_t k = 0; k < functions_.size(); ++k)  // an inactive function contributes to nothing
    if (!active_[at(functions_[k])]) std::fill_n(x_.begin() + static_cast<std::ptrdiff_t>(k * m), m, 0.0);
  r_.resize(x_.size());
  ap_.resize(x_.size());
  p_.assign(x_.size(), 0.0);
  apply<m>(x_, r_);
  double sums[2 * m] = {};  // b . inv(D) b and r . inv(D) r of each column
  for (std::size_t k = 0; k < functions_.size(); ++k)
    for (int c = 0; c < m; ++c) {
      const std::size_t i = k * m + at(c);
      r_[i] = mask_[i] * (b_[i] - r_[i]);
      sums[c] += mask_[i] * inverse_[k] * b_[i] * b_[i];
      sums[m + c] += inverse_[k] * r_[i] * r_[i];
    }
  sum_over_ranks(sums, 2 * m);
  std::copy(sums + m, sums + 2 * m, rho);
  // One measure for all columns: a motion along x must not iterate on the rounding of its y. Without a load,
  // the load that fixed values make.
  const double load = *std::max_element(sums, sums + m);
  return load > 0.0 ? load : *std::max_element(rho, rho + m);
}

template <int m>
void MassSolver::turn(const double* beta, double* curvature) {
  for (std::size_t k = 0; k < functions_.size(); ++k)
    for (int c = 0; c < m; ++c) {
      const std::size_t i = k * m + at(c);
      p_[i] = inverse_[k] * r_[i] + beta[c] * p_[i];
    }
  if (!halo_.serial()) {
    local_.assign(at(mass_->n_local()) * m, 0.0);
    from_compact(p_, local_);
    halo_.update(local_.data(), m);
    to_compact(local_, p_);
  }
  apply<m>(p_, ap_);
  std::fill(curvature, curvature + m, 0.0);
  for (std::size_t i = 0; i < p_.size(); i += m)
    for (int c = 0; c < m; ++c) curvature[c] += mask_[i + at(c)] * p_[i + at(c)] * ap_[i + at(c)];
  sum_over_ranks(curvature, m);
}

template <int m>
void MassSolver::advance(const double* alpha, double* rho) {
  std::fill(rho, rho + m, 0.0);
  for (std::size_t k = 0; k < functions_.size(); ++k)
    for (int c = 0; c < m; ++c) {
      const std::size_t i = k * m + at(c);
      x_[i] += alpha[c] * p_[i];
      r_[i] -= alpha[c] * mask_[i] * ap_[i];
      rho[c] += inverse_[k] * r_[i] * r_[i];
    }
  sum_over_ranks(rho, m);
}

template <int m>
SolveReport MassSolver::iterate(std::span<const double> b, std::span<double> x) {
  SolveReport report;
  double rho[m], before[m], curvature[m], alpha[m], beta[m] = {};
  const double size = start<m>(b, x, rho);
  const double goal = options_.tolerance * options_.tolerance * size;
  for (;; ++report.iterations) {
    const double worst = *std::max_element(rho, rho + m);
    report.residual = size > 0.0 ? std::sqrt(worst / size) : 0.0;
    if (!std::isfinite(worst) || !std::isfinite(size)) {
      report.cause = "an active function has no mass, or the mass or its right-hand side is not finite";
      break;
    }
    if (worst <= goal) break;
    if (report.iterations == options_.max_iterations) {
      report.cause = "the conjugate gradients of the mass matrix did not converge within their limit";
      break;
    }
    turn<m>(beta, curvature);
    for (int c = 0; c < m; ++c) {
      before[c] = rho[c];
      if (rho[c] > goal && !(curvature[c] > 0.0)) report.cause = "the mass matrix is not positive definite";
      // A finished column rests: its numbers would only be rounding.
      alpha[c] = rho[c] > 1e-4 * goal && curvature[c] > 0.0 ? rho[c] / curvature[c] : 0.0;
    }
    if (!report.cause.empty()) break;
    advance<m>(alpha, rho);
    for (int c = 0; c < m; ++c) beta[c] = before[c] > 0.0 ? rho[c] / before[c] : 0.0;
  }
  report.solved = report.cause.empty();
  std::fill(x.begin(), x.end(), 0.0);
  from_compact(x_, x);
  halo_.update(x.data(), m);
  return report;
}

MassSolver::Factor& MassSolver::factor_for(std::size_t column) {
  const std::size_t m = at(columns_);
  std::vector<char> free(active_.size()), fixed(active_.size());
  for (std::size_t f = 0; f < free.size(); ++f) {
    fixed[f] = fixed_[f * m + column];
    free[f] = active_[f] && !fixed[f];
  }
  for (auto& factor : factors_) {
    int same = factor->free == free;
    if (!halo_.serial()) MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_INT, MPI_MIN, halo_.comm());
    if (same) return *factor;
  }
  SolverOptions options;
  options.solver = SolverKind::direct;
  MatrixTraits traits;
  traits.symmetric = true;
  auto made = std::make_unique<Factor>();
  made->free = std::move(free);
  made->dofs = DofMap(halo_, 1, active_, fixed);
  made->solver = LinearSolver(options, traits);
  if (factors_.size() >= m) factors_.erase(factors_.begin());  // of an earlier set of active functions
  factors_.push_back(std::move(made));
  return *factors_.back();
}

SolveReport MassSolver::factorise_and_solve(std::span<const double> b, std::span<double> x) {
  const std::size_t m = at(columns_), n = active_.size();
  std::vector<double> rhs(n), values(n), product(n);
  SolveReport worst;
  for (std::size_t c = 0; c < m; ++c) {
    Factor& factor = factor_for(c);
    // The right-hand side without what the fixed values already take.
    for (std::size_t f = 0; f < n; ++f) values[f] = active_[f] && !factor.free[f] ? x[f * m + c] : 0.0;
    mass_->multiply(values, product);
    halo_.add(product.data(), 1);
    for (std::size_t f = 0; f < n; ++f) rhs[f] = b[f * m + c] - product[f];
    if (!factor.current) factor.matrix.assign(*mass_, factor.dofs);
    std::fill(product.begin(), product.end(), 0.0);
    const SolveReport report =
        factor.solver.solve(factor.matrix, factor.dofs, halo_, rhs, product, factor.current);
    factor.current = report.solved;
    for (std::size_t f = 0; f < n; ++f) x[f * m + c] = factor.free[f] ? product[f] : values[f];
    worst.residual = std::max(worst.residual, report.residual);
    worst.iterations = std::max(worst.iterations, report.iterations);
    if (!report.solved && worst.solved) {
      worst.solved = false;
      worst.cause = report.cause;
    }
  }
  return worst;
}

SolveReport MassSolver::solve(std::span<const double> b, std::span<double> x) {
  if (!mass_) run_error("a mass solver was used before it was given a matrix");
  if (options_.solver == SolverKind::direct) return factorise_and_solve(b, x);
  if (direct_left_ > 0) {
    --direct_left_;
    return factorise_and_solve(b, x);
  }
  guess_.assign(x.begin(), x.end());
  SolveReport report;
  switch (columns_) {
    case 1:
      report = iterate<1>(b, x);
      break;
    case 2:
      report = iterate<2>(b, x);
      break;
    case 3:
      report = iterate<3>(b, x);
      break;
    default:
      report = iterate<4>(b, x);
      break;
  }
  if (report.solved) direct_next_ = 1;
  if (report.solved || options_.solver == SolverKind::iterative) return report;
  constexpr int most = 64;
  direct_left_ = direct_next_;
  direct_next_ = std::min(2 * direct_next_, most);
  std::copy(guess_.begin(), guess_.end(), x.begin());
  return factorise_and_solve(b, x);
}

}  // namespace wisp
