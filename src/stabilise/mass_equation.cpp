#include "stabilise/mass_equation.h"

#include <algorithm>
#include <cmath>

namespace wisp {

namespace {
std::size_t at(int i) { return static_cast<std::size_t>(i); }
}  // namespace

template <int dim>
std::vector<char> boundary_functions(const Space<dim>& space, const ActiveCells& cells) {
  ActiveCells empty = cells;
  for (int& bits : empty.bits) bits = bits == 0;
  std::vector<char> of_active = active_functions(space, cells);
  const std::vector<char> of_empty = active_functions(space, empty);
  for (std::size_t i = 0; i < of_active.size(); ++i) of_active[i] = of_active[i] && of_empty[i];
  return of_active;
}

void MassEquation::set_matrix(const BlockMatrix& mass, const Halo& halo, int columns,
                              std::vector<char> active, std::span<const char> fixed,
                              std::vector<double> lumped, std::span<const char> boundary) {
  mass_ = &mass, halo_ = halo, columns_ = columns;
  active_ = std::move(active), lumped_ = std::move(lumped);
  if (treatment_.deactivate_below > 0) {
    std::vector<double> diagonal(active_.size());
    mass.diagonal(diagonal);
    halo.add_update(diagonal.data(), 1);
    for (std::size_t i = 0; i < active_.size(); ++i)
      if (diagonal[i] < treatment_.deactivate_below) active_[i] = 0;
  }
  given_.assign(active_.size() * at(columns), 0);
  std::copy(fixed.begin(), fixed.end(), given_.begin());
  held_ = given_;
  if (treatment_.mass == Mass::partial)
    for (std::size_t i = 0; i < boundary.size(); ++i)
      if (boundary[i]) std::fill_n(held_.begin() + static_cast<std::ptrdiff_t>(i * at(columns)), columns, 1);
  if (treatment_.mass != Mass::fmpm) solver_.set_matrix(mass, halo, columns, active_, held_);
}

SolveReport MassEquation::solve(std::span<const double> b, std::span<double> x) {
  if (treatment_.mass == Mass::fmpm) return sum_series(b, x);
  if (treatment_.mass == Mass::partial) {
    for (std::size_t k = 0; k < held_.size(); ++k)
      if (held_[k] && !given_[k]) {
        const double m = lumped_[k / at(columns_)];
        x[k] = active_[k / at(columns_)] && m > 0 ? b[k] / m : 0.0;
      }
    halo_.update(x.data(), columns_);  // b is complete on owners only
  }
  return solver_.solve(b, x);
}

/// The series as the Richardson iteration that it is: k steps of x += L^-1 (b - M x) from zero.
SolveReport MassEquation::sum_series(std::span<const double> b, std::span<double> x) {
  const std::size_t m = at(columns_);
  const auto free = [&](std::size_t k) {
    return active_[k / m] && !given_[k] && lumped_[k / m] > 0 && halo_.owns(static_cast<int>(k / m));
  };
  for (std::size_t k = 0; k < x.size(); ++k)
    if (!given_[k] || !active_[k / m]) x[k] = 0.0;
  product_.resize(x.size());
  SolveReport report;
  double load = 0.0, rest = 0.0;
  for (report.iterations = 0; report.iterations < treatment_.fmpm_order; ++report.iterations) {
    mass_->multiply_columns(x, product_, columns_);
    halo_.add(product_.data(), columns_);
    load = rest = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k)
      if (free(k)) {
        const double change = (b[k] - product_[k]) / lumped_[k / m];
        x[k] += change;
        load += b[k] * b[k] / lumped_[k / m], rest += change * change * lumped_[k / m];
      }
    halo_.update(x.data(), columns_);
  }
  double sums[2] = {load, rest};
  if (!halo_.serial()) MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, halo_.comm());
  report.residual = sums[0] > 0 ? std::sqrt(sums[1] / sums[0]) : 0.0;
  report.solved = std::isfinite(sums[1]);
  if (!report.solved) report.cause = "the series of the mass is not finite";
  return report;
}

template std::vector<char> boundary_functions<2>(const Space<2>&, const ActiveCells&);
template std::vector<char> boundary_functions<3>(const Space<3>&, const ActiveCells&);

}  // namespace wisp
