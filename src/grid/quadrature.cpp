#include "grid/quadrature.h"

#include <cmath>
#include <numbers>

#include "core/error.h"

namespace wisp {

IntervalRule gauss_legendre(int n) {
  if (n < 1) input_error("a quadrature rule needs at least one point, not {}", n);
  IntervalRule rule;
  for (int i = 0; i < n; ++i) {
    // Newton's method on the Legendre polynomial, from a root of its Chebyshev relative.
    double x = -std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1.0;
    for (int iteration = 0; iteration < 100; ++iteration) {
      double value = 1.0, before = 0.0;
      for (int k = 0; k < n; ++k) {
        const double next = ((2 * k + 1) * x * value - k * before) / (k + 1);
        before = value, value = next;
      }
      slope = n * (x * value - before) / (x * x - 1.0);
      const double step = value / slope;
      x -= step;
      if (std::abs(step) < 1e-16) break;
    }
    rule.place.push_back(0.5 * (1.0 + x));
    rule.weight.push_back(1.0 / ((1.0 - x * x) * slope * slope));
  }
  return rule;
}

TriangleRule triangle_rule(int n) {
  const IntervalRule line = gauss_legendre(n);
  TriangleRule rule;
  for (std::size_t i = 0; i < line.place.size(); ++i)
    for (std::size_t j = 0; j < line.place.size(); ++j) {
      const double a = line.place[i], b = line.place[j];
      rule.place.push_back({1.0 - a, a * (1.0 - b), a * b});
      rule.weight.push_back(2.0 * a * line.weight[i] * line.weight[j]);
    }
  return rule;
}

}  // namespace wisp
