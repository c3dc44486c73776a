#include "app/bench_bare.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "app/bench.h"
#include "core/error.h"

namespace wisp {

/// Stress: 2D xx, yy, xy; 3D xx, yy, zz, xy, yz, zx.
template <int dim>
class BareKernel<dim>::Arrays {
 public:
  explicit Arrays(int points) {
    cells_ = std::max(4, static_cast<int>(std::lround(std::pow(points, 1.0 / dim) / 2)));
    nodes_ = cells_ + 3;  // a row of empty cells around
    const int layers = dim == 3 ? cells_ : 1, z_points = dim == 3 ? 2 : 1;
    for (int cz = 0; cz < layers; ++cz)
      for (int cy = 0; cy < cells_; ++cy)
        for (int cx = 0; cx < cells_; ++cx)
          for (int k = 0; k < 4 * z_points; ++k) {
            const double r[3] = {cx + 1 + 0.25 + 0.5 * (k & 1), cy + 1 + 0.25 + 0.5 * (k >> 1 & 1),
                                 cz + 1 + 0.25 + 0.5 * (k >> 2)};
            for (int d = 0; d < dim; ++d) {
              x_.push_back(h * r[d]);
              v_.push_back(1e-3 * std::sin(3.0 * r[d] / cells_));
            }
          }
    n_ = static_cast<int>(x_.size()) / dim;
    m_.assign(static_cast<std::size_t>(n_), rho * std::pow(0.5 * h, dim));
    volume_.assign(static_cast<std::size_t>(n_), std::pow(0.5 * h, dim));
    s_.assign(static_cast<std::size_t>(n_) * stresses, 0.0);
    std::size_t all = 1;
    for (int d = 0; d < dim; ++d) all *= static_cast<std::size_t>(nodes_);
    sums_.assign(all * (1 + 2 * dim), 0.0);
    motion_.assign(all * (2 * dim), 0.0);
  }

  int size() const { return n_; }

  void step(double dt) {
    to_grid();
    solve(dt);
    to_points(dt);
  }

  double checksum() const { return x_[0] + v_[0] + s_[0]; }

 private:
  static constexpr int stresses = dim == 2 ? 3 : 6;
  static constexpr int stride = 1 + 2 * dim;
  static constexpr int corners = dim == 2 ? 4 : 8;
  static constexpr double h = 0.01, rho = 1000.0, lambda = 4e5, mu = 4e5;

  struct Corner {
    double phi, dphi[dim];
  };

  /// Node of the lowest corner, and the functions of all corners.
  inline __attribute__((always_inline)) int stencil(const double* x, Corner* corner) const {
    constexpr double per_h = 1.0 / h;
    double w[dim][2];
    int i[dim];
    for (int d = 0; d < dim; ++d) {
      const double s = x[d] * per_h;
      i[d] = static_cast<int>(s);
      w[d][1] = s - i[d];
      w[d][0] = 1.0 - w[d][1];
    }
    constexpr double g[2] = {-per_h, per_h};
    for (int k = 0; k < corners; ++k) {
      const int a = k & 1, b = k >> 1 & 1;
      if constexpr (dim == 2) {
        corner[k] = {w[0][a] * w[1][b], {g[a] * w[1][b], w[0][a] * g[b]}};
      } else {
        const int c = k >> 2;
        const double bc = w[1][b] * w[2][c];
        corner[k] = {w[0][a] * bc, {g[a] * bc, w[0][a] * g[b] * w[2][c], w[0][a] * w[1][b] * g[c]}};
      }
    }
    if constexpr (dim == 2)
      return i[0] + nodes_ * i[1];
    else
      return i[0] + nodes_ * (i[1] + nodes_ * i[2]);
  }

  inline __attribute__((always_inline)) int node(int first, int k) const {
    return first + (k & 1) + (k >> 1 & 1) * nodes_ + (dim == 3 ? (k >> 2) * nodes_ * nodes_ : 0);
  }

  void to_grid() {
    std::fill(sums_.begin(), sums_.end(), 0.0);
    const double* const __restrict x = x_.data();
    const double* const __restrict v = v_.data();
    const double* const __restrict s = s_.data();
    double* const __restrict sums = sums_.data();
    for (int p = 0; p < n_; ++p) {
      Corner corner[corners];
      const int first = stencil(x + p * dim, corner);
      const double m = m_[static_cast<std::size_t>(p)], volume = volume_[static_cast<std::size_t>(p)];
      double mv[dim], t[stresses];
      for (int d = 0; d < dim; ++d) mv[d] = m * v[p * dim + d];
      for (int a = 0; a < stresses; ++a) t[a] = volume * s[p * stresses + a];
      for (int k = 0; k < corners; ++k) {
        double* const out = sums + node(first, k) * stride;
        const auto& [phi, g] = corner[k];
        out[0] += phi * m;
        for (int d = 0; d < dim; ++d) out[1 + d] += phi * mv[d];
        if constexpr (dim == 2) {
          out[3] -= t[0] * g[0] + t[2] * g[1];
          out[4] -= t[2] * g[0] + t[1] * g[1];
        } else {
          out[4] -= t[0] * g[0] + t[3] * g[1] + t[5] * g[2];
          out[5] -= t[3] * g[0] + t[1] * g[1] + t[4] * g[2];
          out[6] -= t[5] * g[0] + t[4] * g[1] + t[2] * g[2];
        }
      }
    }
  }

  void solve(double dt) {
    const std::size_t n = motion_.size() / (2 * dim);
    const double* const __restrict sums = sums_.data();
    double* const __restrict motion = motion_.data();
    for (std::size_t i = 0; i < n; ++i) {
      const double m = sums[i * stride];
      const double per_m = m > 0 ? 1.0 / m : 0.0;
      for (std::size_t d = 0; d < dim; ++d) {
        const double a = sums[i * stride + 1 + dim + d] * per_m;
        motion[i * 2 * dim + d] = sums[i * stride + 1 + d] * per_m + dt * a;
        motion[i * 2 * dim + dim + d] = a;
      }
    }
  }

  void to_points(double dt) {
    double* const __restrict x = x_.data();
    double* const __restrict v = v_.data();
    double* const __restrict s = s_.data();
    const double* const __restrict motion = motion_.data();
    for (int p = 0; p < n_; ++p) {
      Corner corner[corners];
      const int first = stencil(x + p * dim, corner);
      double now[dim] = {}, a[dim] = {}, e[dim][dim] = {};
      for (int k = 0; k < corners; ++k) {
        const double* const in = motion + node(first, k) * 2 * dim;
        const auto& [phi, g] = corner[k];
        for (int d = 0; d < dim; ++d) {
          now[d] += phi * in[d];
          a[d] += phi * in[dim + d];
          for (int j = 0; j < dim; ++j) e[d][j] += in[d] * g[j];
        }
      }
      for (int d = 0; d < dim; ++d) {
        x[p * dim + d] += dt * now[d];
        v[p * dim + d] += dt * a[d];
      }
      double* const t = s + p * stresses;
      if constexpr (dim == 2) {
        const double pressure = dt * lambda * (e[0][0] + e[1][1]);
        for (int d = 0; d < 2; ++d) t[d] += pressure + 2 * mu * dt * e[d][d];
        t[2] += mu * dt * (e[0][1] + e[1][0]);
      } else {
        const double pressure = dt * lambda * (e[0][0] + e[1][1] + e[2][2]);
        for (int d = 0; d < 3; ++d) t[d] += pressure + 2 * mu * dt * e[d][d];
        t[3] += mu * dt * (e[0][1] + e[1][0]);
        t[4] += mu * dt * (e[1][2] + e[2][1]);
        t[5] += mu * dt * (e[2][0] + e[0][2]);
      }
    }
  }

  int cells_, nodes_, n_;
  std::vector<double> x_, v_, m_, volume_, s_, sums_, motion_;
};

template <int dim>
BareKernel<dim>::BareKernel(int points) : arrays_(std::make_unique<Arrays>(points)) {
  for (int k = 0; k < 2; ++k) arrays_->step(dt);
}
template <int dim>
BareKernel<dim>::~BareKernel() = default;

template <int dim>
int BareKernel<dim>::size() const {
  return arrays_->size();
}

template <int dim>
double BareKernel<dim>::seconds_per_step(int steps) {
  const double start = processor_seconds();
  for (int k = 0; k < steps; ++k) arrays_->step(dt);
  const double seconds = (processor_seconds() - start) / steps;
  if (!std::isfinite(arrays_->checksum())) run_error("the bare kernel has computed nonsense");
  return seconds;
}

template class BareKernel<2>;
template class BareKernel<3>;

}  // namespace wisp
