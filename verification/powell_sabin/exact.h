// Exact motions of the thesis's benchmarks in small deformation.
#pragma once

namespace wisp::powell_sabin {

/// A bar held at both ends that starts with v0 sin(pi x/L) (thesis, eq. 4.2, 4.3).
struct VibratingBar {
  double density = 1.0, young_modulus = 100.0, length = 25.0, speed = 0.1;

  double frequency() const;  ///< omega, 1/s
  double displacement(double x, double t) const;
  double velocity(double x, double t) const;
};

/// A column held at its base, free at its top, under gravity that starts at t = 0 (thesis, eq. 4.6, with the
/// sign of its second term corrected: u(y, 0) = 0 wants minus).
struct SoilColumn {
  double density = 1.0, young_modulus = 5e4, gravity = 9.81, height = 25.0;

  double period() const;  ///< of the lowest vibration, s
  double displacement(double y, double t) const;
  double velocity(double y, double t) const;
};

}  // namespace wisp::powell_sabin
