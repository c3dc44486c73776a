#include "boundary/wall_system.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace wisp {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double tolerance = 1e-10;  // of the largest change that the first sweep asks for
constexpr int max_rounds = 12;       // of two sweeps and a solve
constexpr int last_sweeps = 50;      // where the rounds do not settle
constexpr double most_work = 2e7;    // multiplications of a factorisation
constexpr double cg_tolerance = 1e-8;
constexpr int cg_iterations = 300;

}  // namespace

template <int dim>
void WallSystem<dim>::clear() {
  first_.assign(1, 0);
  entries_.clear();
  diagonal_.clear();
  ordered_ = false;
}

template <int dim>
void WallSystem<dim>::add(int other, const Vec<dim>& a) {
  entries_.push_back({other, a});
}

template <int dim>
void WallSystem<dim>::end_row() {
  const int r = n_rows();
  diagonal_.push_back(Vec<dim>::Zero());
  for (std::size_t k = at(first_.back()); k < entries_.size(); ++k)
    if (entries_[k].row == r) diagonal_.back() = entries_[k].a;
  first_.push_back(static_cast<int>(entries_.size()));
}

/// What a unit of impulse along a direction takes to be borne without a change of the row's velocity.
template <int dim>
double WallSystem<dim>::yielding(int r, const Vec<dim>& along) const {
  return yield * diagonal_[at(r)].dot(along.cwiseAbs2());
}

template <int dim>
void WallSystem<dim>::push(int r, const Vec<dim>& impulse) {
  for (int k = first_[at(r)]; k < first_[at(r) + 1]; ++k)
    velocity_[at(entries_[at(k)].row)] += entries_[at(k)].a.cwiseProduct(impulse);
}

template <int dim>
double WallSystem<dim>::solve_normal(RowState<dim>& row, int r) {
  const double a = diagonal_[at(r)].dot(row.normal.cwiseAbs2());
  if (!row.normal_held || !(a > 0.0)) return 0.0;
  const double u = (velocity_[at(r)] - row.target).dot(row.normal);
  double lambda = row.lambda_n - (u - row.bias + yield * a * row.lambda_n) / (a * (1.0 + yield));
  if (row.pushes) lambda = std::max(0.0, lambda);
  const double step = lambda - row.lambda_n;
  if (step == 0.0) return 0.0;
  row.lambda_n = lambda;
  push(r, step * row.normal);
  return std::abs(step) * a;
}

template <int dim>
double WallSystem<dim>::solve_tangent(RowState<dim>& row, int r) {
  const double a = diagonal_[at(r)].maxCoeff();
  if (!row.tangent_held || !(a > 0.0)) return 0.0;
  const Vec<dim> u = velocity_[at(r)] - row.target;
  Vec<dim> lambda =
      row.lambda_t - (u - u.dot(row.normal) * row.normal + yield * a * row.lambda_t) / (a * (1.0 + yield));
  row.sticks = true;
  if (row.slips) {  // Coulomb
    const double most = row.friction * std::abs(row.lambda_n), size = lambda.norm();
    if (size > most) lambda *= most / size, row.sticks = false;
  } else if (row.normal_held && row.pushes && row.lambda_n == 0.0) {
    lambda.setZero(), row.sticks = false;
  }
  const Vec<dim> step = lambda - row.lambda_t;
  if (step.isZero(0.0)) return 0.0;
  row.lambda_t = lambda;
  push(r, step);
  return step.norm() * a;
}

template <int dim>
double WallSystem<dim>::sweep(std::span<RowState<dim>> rows, bool back) {
  double change = 0.0;
  const int n = n_rows();
  for (int k = 0; k < n; ++k) {
    const int r = back ? n - 1 - k : k;
    change = std::max(change, solve_normal(rows[at(r)], r));
    change = std::max(change, solve_tangent(rows[at(r)], r));
  }
  ++sweeps_;
  return change;
}

template <int dim>
void WallSystem<dim>::find(std::span<RowState<dim>> rows) {
  sweeps_ = solves_ = 0;
  double first = 0.0;
  for (int round = 0; round < max_rounds; ++round) {
    double change = sweep(rows, false);
    first = std::max(first, change);
    if (change <= tolerance * first) return;
    change = sweep(rows, true);
    if (change <= tolerance * first) return;
    solve_active(rows);
  }
  for (int k = 0; k < last_sweeps; ++k)
    if (sweep(rows, k % 2 == 1) <= tolerance * first) return;
}

/// Unknowns of all rows, in the order of the factor; `add(row)` adds those of one.
template <int dim>
template <class Add>
void WallSystem<dim>::list_unknowns(Add&& add) {
  unknowns_.clear();
  unknowns_of_.assign(at(n_rows()), {0, 0});
  if (!ordered_) order_rows();
  for (const int r : order_) {
    const auto from = static_cast<int>(unknowns_.size());
    add(r);
    unknowns_of_[at(r)] = {from, static_cast<int>(unknowns_.size()) - from};
  }
}

/// The equations of the rows that hold, those that slip with the impulse that they have.
template <int dim>
void WallSystem<dim>::solve_active(std::span<RowState<dim>> rows) {
  list_unknowns([&](int r) {
    const RowState<dim>& row = rows[at(r)];
    const Vec<dim> u = velocity_[at(r)] - row.target;
    if (row.normal_held && (!row.pushes || row.lambda_n > 0.0))
      add_unknown(r, row.normal, row.bias - u.dot(row.normal) - yielding(r, row.normal) * row.lambda_n, true);
    if (row.tangent_held && row.sticks)
      add_tangents(r, row.normal, -u - yield * diagonal_[at(r)].cwiseProduct(row.lambda_t));
  });
  solve_unknowns();
  ++solves_;
  for (const int r : order_) {
    RowState<dim>& row = rows[at(r)];
    const auto [from, n] = unknowns_of_[at(r)];
    if (n == 0) continue;
    const Vec<dim> before = row.impulse();
    for (int k = from; k < from + n; ++k) {
      const Unknown& x = unknowns_[at(k)];
      if (x.normal)
        row.lambda_n += change_[at(k)];
      else
        row.lambda_t += change_[at(k)] * x.along;
    }
    if (row.pushes) row.lambda_n = std::max(0.0, row.lambda_n);
    if (row.slips && row.tangent_held)
      if (const double most = row.friction * std::abs(row.lambda_n), size = row.lambda_t.norm(); size > most)
        row.lambda_t *= most / size;
    push(r, row.impulse() - before);
  }
}

template <int dim>
void WallSystem<dim>::add_unknown(int r, const Vec<dim>& along, double lack, bool normal) {
  if (diagonal_[at(r)].dot(along.cwiseAbs2()) > 0.0) unknowns_.push_back({r, along, lack, normal});
}

template <int dim>
void WallSystem<dim>::add_tangents(int r, const Vec<dim>& n, const Vec<dim>& lack) {
  if constexpr (dim == 2) {
    const Vec<2> t(-n[1], n[0]);
    add_unknown(r, t, lack.dot(t), false);
  } else {
    const Vec<3> t = n.unitOrthogonal(), s = n.cross(t);
    add_unknown(r, t, lack.dot(t), false);
    add_unknown(r, s, lack.dot(s), false);
  }
}

template <int dim>
void WallSystem<dim>::project(std::span<const RowState<dim>> rows, std::span<Vec<dim>> impulse) {
  list_unknowns([&](int r) {
    const RowState<dim>& row = rows[at(r)];
    if (!row.loaded()) return;
    const Vec<dim> u = velocity_[at(r)] - row.target;
    if (row.normal_held) add_unknown(r, row.normal, row.bias - u.dot(row.normal), true);
    if (row.tangent_held && row.sticks) add_tangents(r, row.normal, -u);
  });
  solve_unknowns();
  for (std::size_t k = 0; k < unknowns_.size(); ++k) {
    const Vec<dim> step = change_[k] * unknowns_[k].along;
    impulse[at(unknowns_[k].row)] += step;
    push(unknowns_[k].row, step);
  }
}

/// Breadth first from row to row, each part from one of its ends (Cuthill and McKee 1969): rows along a wall
/// then have their neighbours close by, whatever the order of their cells.
template <int dim>
void WallSystem<dim>::order_rows() {
  const int n = n_rows();
  const auto reach = [&](int start, std::vector<int>& visited) {
    const std::size_t begin = visited.size();
    visited.push_back(start);
    place_[at(start)] = 0;
    for (std::size_t k = begin; k < visited.size(); ++k)
      for (int e = first_[at(visited[k])]; e < first_[at(visited[k]) + 1]; ++e)
        if (const int other = entries_[at(e)].row; place_[at(other)] < 0)
          place_[at(other)] = 0, visited.push_back(other);
  };
  place_.assign(at(n), -1);
  order_.clear();
  for (int r = 0; r < n; ++r) {
    if (place_[at(r)] >= 0) continue;
    queue_.clear();
    reach(r, queue_);
    const int end = queue_.back();
    for (const int q : queue_) place_[at(q)] = -1;
    reach(end, order_);
  }
  for (std::size_t k = 0; k < order_.size(); ++k) place_[at(order_[k])] = static_cast<int>(k);
  ordered_ = true;
}

template <int dim>
void WallSystem<dim>::solve_unknowns() {
  change_.resize(unknowns_.size());
  for (std::size_t k = 0; k < unknowns_.size(); ++k) change_[k] = unknowns_[k].lack;
  if (measure() > most_work) return iterate();
  assemble();
  factor();
  back_substitute();
}

/// First columns of the rows of the factor, and the multiplications that it takes.
template <int dim>
double WallSystem<dim>::measure() {
  const std::size_t n = unknowns_.size();
  low_.resize(n), start_.resize(n + 1), pivot_.resize(n);
  std::size_t size = 0;
  double work = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const int r = unknowns_[k].row;
    int low = static_cast<int>(k);
    for (int e = first_[at(r)]; e < first_[at(r) + 1]; ++e)
      if (const auto [from, m] = unknowns_of_[at(entries_[at(e)].row)]; m > 0) low = std::min(low, from);
    low_[k] = low, start_[k] = size;
    const auto width = static_cast<double>(k - at(low));
    work += 0.5 * width * width;
    size += k - at(low) + 1;
  }
  start_[n] = size;
  return work;
}

template <int dim>
void WallSystem<dim>::apply(const std::vector<double>& x, std::vector<double>& y) {
  pushed_.assign(at(n_rows()), Vec<dim>::Zero());
  for (std::size_t k = 0; k < unknowns_.size(); ++k)
    pushed_[at(unknowns_[k].row)] += x[k] * unknowns_[k].along;
  for (std::size_t k = 0; k < unknowns_.size(); ++k) {
    const Unknown& of = unknowns_[k];
    Vec<dim> v = Vec<dim>::Zero();
    for (int e = first_[at(of.row)]; e < first_[at(of.row) + 1]; ++e)
      v += entries_[at(e)].a.cwiseProduct(pushed_[at(entries_[at(e)].row)]);
    y[k] = of.along.dot(v) + yielding(of.row, of.along) * x[k];
  }
}

/// Conjugate gradients, scaled by the diagonal.
template <int dim>
void WallSystem<dim>::iterate() {
  const std::size_t n = unknowns_.size();
  rest_ = change_;
  change_.assign(n, 0.0), search_.assign(n, 0.0), image_.assign(n, 0.0);
  for (std::size_t k = 0; k < n; ++k) pivot_[k] = yielding(unknowns_[k].row, unknowns_[k].along) / yield;
  double last = 0.0, first = 0.0;
  for (int it = 0; it < cg_iterations; ++it) {
    double size = 0.0;
    for (std::size_t k = 0; k < n; ++k) size += rest_[k] * rest_[k] / pivot_[k];
    if (it == 0) first = size;
    if (size <= cg_tolerance * cg_tolerance * first) return;
    const double beta = it > 0 ? size / last : 0.0;
    for (std::size_t k = 0; k < n; ++k) search_[k] = rest_[k] / pivot_[k] + beta * search_[k];
    apply(search_, image_);
    double curvature = 0.0;
    for (std::size_t k = 0; k < n; ++k) curvature += search_[k] * image_[k];
    const double step = size / curvature;
    for (std::size_t k = 0; k < n; ++k) change_[k] += step * search_[k], rest_[k] -= step * image_[k];
    last = size;
  }
}

/// The lower half between the first entry of each row and its diagonal.
template <int dim>
void WallSystem<dim>::assemble() {
  const std::size_t n = unknowns_.size(), size = start_[n];
  factor_.assign(size, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    const Unknown& x = unknowns_[k];
    for (int e = first_[at(x.row)]; e < first_[at(x.row) + 1]; ++e) {
      const auto [from, m] = unknowns_of_[at(entries_[at(e)].row)];
      for (int j = from; j < from + m && at(j) <= k; ++j)
        factor_[start_[k] + at(j - low_[k])] +=
            x.along.cwiseProduct(entries_[at(e)].a).dot(unknowns_[at(j)].along);
    }
    factor_[start_[k] + k - at(low_[k])] += yielding(x.row, x.along);
  }
}

/// L D L^T of a matrix stored between its first entries and the diagonal (Jennings 1977).
template <int dim>
void WallSystem<dim>::factor() {
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    double* const row = factor_.data() + start_[i];
    const int low = low_[i];
    for (int j = low; j < static_cast<int>(i); ++j) {
      const double* const other = factor_.data() + start_[at(j)];
      double sum = row[j - low];
      for (int k = std::max(low, low_[at(j)]); k < j; ++k) sum -= row[k - low] * other[k - low_[at(j)]];
      row[j - low] = sum;
    }
    double pivot = row[static_cast<int>(i) - low];
    for (int j = low; j < static_cast<int>(i); ++j) {
      const double scaled = row[j - low] / pivot_[at(j)];
      pivot -= scaled * row[j - low];
      row[j - low] = scaled;
    }
    pivot_[i] = pivot;
  }
}

template <int dim>
void WallSystem<dim>::back_substitute() {
  const auto n = static_cast<int>(unknowns_.size());
  for (int i = 0; i < n; ++i)
    for (int j = low_[at(i)]; j < i; ++j)
      change_[at(i)] -= factor_[start_[at(i)] + at(j - low_[at(i)])] * change_[at(j)];
  for (int i = 0; i < n; ++i) change_[at(i)] /= pivot_[at(i)];
  for (int i = n - 1; i >= 0; --i)
    for (int j = low_[at(i)]; j < i; ++j)
      change_[at(j)] -= factor_[start_[at(i)] + at(j - low_[at(i)])] * change_[at(i)];
}

template class WallSystem<2>;
template class WallSystem<3>;

}  // namespace wisp
