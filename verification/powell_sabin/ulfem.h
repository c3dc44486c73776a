// The one-dimensional updated-Lagrangian finite element method that the thesis takes as its reference in
// large deformation.
#pragma once
#include <functional>
#include <vector>

namespace wisp::powell_sabin {

/// A bar on [0, length] in uniaxial strain, nu = 0, held at 0 and, if asked, at its end.
struct UlfemCase {
  double length = 1.0;                     ///< m
  double density = 1.0;                    ///< kg/m3
  double young_modulus = 1.0;              ///< Pa
  double acceleration = 0.0;               ///< m/s2, along the axis
  bool end_held = false;                   ///< at x = length
  std::function<double(double)> velocity;  ///< m/s over the initial position; empty: at rest
  int elements = 1000;
  bool hencky = false;  ///< Hencky's law instead of the thesis's
};

/// Linear elements that move with the material, lumped mass, velocity Verlet steps at half the stable length:
/// second order in both. The law is the thesis's, d(sigma) = (E - sigma) d(eps) with d(eps) = dl/l, which in
/// uniaxial strain integrates to sigma = E (1 - l0/l); so nothing depends on how a step approximates the
/// increment. Hencky's law has sigma = E ln(s)/s of the stretch s.
class Ulfem {
 public:
  explicit Ulfem(const UlfemCase& bar);

  /// Steps of equal length up to time t (s), which must not lie before the present one.
  void advance_to(double t);
  double time() const { return time_; }
  /// At an initial position in [0, length].
  double displacement(double x) const { return at(displacement_, x); }
  double velocity(double x) const { return at(velocity_, x); }
  /// Kinetic and strain energy minus the work of the body force, J per area of the section.
  double energy() const;

 private:
  void find_acceleration();
  double at(const std::vector<double>& field, double x) const;

  UlfemCase bar_;
  double h_, stable_step_, time_ = 0.0;
  std::vector<double> mass_, displacement_, velocity_, acceleration_;  // one entry a node
};

}  // namespace wisp::powell_sabin
