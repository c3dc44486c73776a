#include "verification/powell_sabin/exact.h"

#include <cmath>
#include <numbers>

namespace wisp::powell_sabin {

namespace {
constexpr double pi = std::numbers::pi;
/// The terms fall as 1/n^3 (displacement) and alternate or cancel in pairs; 20000 leave less than 1e-9 of the
/// first.
constexpr int terms = 20000;
}  // namespace

double VibratingBar::frequency() const { return pi * std::sqrt(young_modulus / density) / length; }
double VibratingBar::displacement(double x, double t) const {
  return speed / frequency() * std::sin(frequency() * t) * std::sin(pi * x / length);
}
double VibratingBar::velocity(double x, double t) const {
  return speed * std::cos(frequency() * t) * std::sin(pi * x / length);
}

double SoilColumn::period() const { return 4.0 * height / std::sqrt(young_modulus / density); }

double SoilColumn::displacement(double y, double t) const {
  const double wave = std::sqrt(young_modulus / density);
  double u = density * gravity * y * (0.5 * y - height) / young_modulus;
  for (int n = 1; n <= terms; ++n) {
    const double m = 2 * n - 1, k = m * pi / (2.0 * height);
    u += 16.0 * density * gravity * height * height / (m * m * m * pi * pi * pi * young_modulus) *
         std::cos(wave * k * t) * std::sin(k * y);
  }
  return u;
}

double SoilColumn::velocity(double y, double t) const {
  const double wave = std::sqrt(young_modulus / density);
  double v = 0.0;
  for (int n = 1; n <= terms; ++n) {
    const double m = 2 * n - 1, k = m * pi / (2.0 * height);
    v -= 16.0 * density * gravity * height * height / (m * m * m * pi * pi * pi * young_modulus) * wave * k *
         std::sin(wave * k * t) * std::sin(k * y);
  }
  return v;
}

}  // namespace wisp::powell_sabin
