// A scalar that changes in time.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace wisp {

/// Piecewise linear function of time: constant before the first and after the last point. In a case file it
/// is a number (constant) or a list of [time, value] pairs. Times in s, values in the unit of the key that
/// holds it.
struct Curve {
  std::vector<double> times{0.0};
  std::vector<double> values{0.0};

  Curve() = default;
  explicit Curve(double constant) : times{0.0}, values{constant} {}

  double operator()(double t) const {
    if (t <= times.front()) return values.front();
    if (t >= times.back()) return values.back();
    const auto i = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), t) - times.begin());
    const double s = (t - times[i - 1]) / (times[i] - times[i - 1]);
    return (1.0 - s) * values[i - 1] + s * values[i];
  }
};

}  // namespace wisp
