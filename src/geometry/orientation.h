// On which side of a line a point lies, without rounding errors.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>

namespace wisp {

/// Sign of twice the signed area of the triangle a, b, c: 1 counter-clockwise (c left of a -> b), -1
/// clockwise, 0 on one line. Exact for coordinates whose products neither overflow nor underflow: a
/// rounding-error bound decides nearly every call, else the six products are summed exactly as an expansion
/// of doubles that do not overlap (Shewchuk 1997, Grow-Expansion).
inline int orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const double left = (a.x() - c.x()) * (b.y() - c.y()), right = (a.y() - c.y()) * (b.x() - c.x());
  const double estimate = left - right;
  // Shewchuk's bound (3 + 16 eps) eps with eps = 2^-53, a little enlarged.
  const double bound = 3.4e-16 * (std::abs(left) + std::abs(right));
  if (estimate > bound) return 1;
  if (estimate < -bound) return -1;
  const std::array<std::array<double, 2>, 6> products{
      {{a.x(), b.y()}, {-a.x(), c.y()}, {-c.x(), b.y()}, {-a.y(), b.x()}, {a.y(), c.x()}, {c.y(), b.x()}}};
  std::array<double, 12> expansion{};  // from the smallest part to the largest
  std::size_t n = 0;
  const auto add = [&](double q) {
    for (std::size_t i = 0; i < n; ++i) {
      const double e = expansion[i], sum = q + e, virtual_e = sum - q;
      expansion[i] = (q - (sum - virtual_e)) + (e - virtual_e);
      q = sum;
    }
    expansion[n++] = q;
  };
  for (const auto& [u, v] : products) {
    const double product = u * v;
    add(std::fma(u, v, -product));
    add(product);
  }
  for (std::size_t i = n; i-- > 0;)
    if (expansion[i] != 0.0) return expansion[i] > 0.0 ? 1 : -1;
  return 0;
}

}  // namespace wisp
