// Numbers that carry derivatives along, so that a polynomial is written once.
#pragma once
#include <array>
#include <cstddef>

#include "tensor/tensor.h"

namespace wisp {

/// A value with its gradient in the plane.
struct ValueAndGradient {
  double value = 0.0, x = 0.0, y = 0.0;

  ValueAndGradient() = default;
  ValueAndGradient(double value_, const Vec<2>& gradient) : value(value_), x(gradient[0]), y(gradient[1]) {}
  ValueAndGradient(double value_, double x_, double y_) : value(value_), x(x_), y(y_) {}

  friend ValueAndGradient operator+(const ValueAndGradient& a, const ValueAndGradient& b) {
    return {a.value + b.value, a.x + b.x, a.y + b.y};
  }
  friend ValueAndGradient operator*(const ValueAndGradient& a, const ValueAndGradient& b) {
    return {a.value * b.value, a.value * b.x + a.x * b.value, a.value * b.y + a.y * b.value};
  }
  friend ValueAndGradient operator*(double a, const ValueAndGradient& b) {
    return {a * b.value, a * b.x, a * b.y};
  }
};

/// Taylor coefficients along a line: value, first derivative, second / 2, third / 6.
template <int order>
struct Taylor {
  std::array<double, order + 1> c{};

  Taylor() = default;
  Taylor(double value, double slope) {
    c[0] = value;
    if constexpr (order > 0) c[1] = slope;
  }

  friend Taylor operator+(const Taylor& a, const Taylor& b) {
    Taylor sum;
    for (std::size_t i = 0; i <= order; ++i) sum.c[i] = a.c[i] + b.c[i];
    return sum;
  }
  friend Taylor operator*(const Taylor& a, const Taylor& b) {
    Taylor product;
    for (std::size_t i = 0; i <= order; ++i)
      for (std::size_t j = 0; i + j <= order; ++j) product.c[i + j] += a.c[i] * b.c[j];
    return product;
  }
  friend Taylor operator*(double a, const Taylor& b) {
    Taylor product;
    for (std::size_t i = 0; i <= order; ++i) product.c[i] = a * b.c[i];
    return product;
  }
};

}  // namespace wisp
