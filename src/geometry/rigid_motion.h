// A rigid motion prescribed in time.
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/curve.h"
#include "core/describe.h"

namespace wisp {

/// Translation, and rotation about a centre that moves along; in 3D about an axis through it.
struct RigidMotionOptions {
  std::vector<Curve> displacement{};
  std::vector<Curve> velocity{};
  std::optional<Curve> rotation{};
  std::optional<Curve> angular_velocity{};
  std::vector<double> centre{};
  std::vector<double> axis{};

  static constexpr std::string_view name = "motion";
  static constexpr std::string_view summary = "Rigid motion prescribed in time";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = RigidMotionOptions;
    return std::tuple{
        key("displacement", &O::displacement, "m",
            "displacement in time, from the place that the shape gives")
            .per_direction(),
        key("velocity", &O::velocity, "m/s", "velocity in time (instead of displacement)").per_direction(),
        key("rotation", &O::rotation, "rad",
            "angle in time, counter-clockwise (3D: right-handed about `axis`)"),
        key("angular_velocity", &O::angular_velocity, "rad/s",
            "angular velocity in time (instead of rotation)"),
        key("centre", &O::centre, "m",
            "centre of the rotation, which the translation moves along (default the origin)")
            .per_direction(),
        key("axis", &O::axis, "-", "direction of the axis of the rotation (3D)").entries(3)};
  }
};

/// x(t) = centre + u(t) + R(t) (X - centre) of the body's point that rests at X. Velocities given in time are
/// integrated exactly from t = 0.
template <int dim>
class RigidMotion {
 public:
  using Vector = Eigen::Matrix<double, dim, 1>;
  using Matrix = Eigen::Matrix<double, dim, dim>;

  /// At rest.
  RigidMotion() = default;
  /// Throws InputError for a quantity given twice, wrong numbers of values, a rotation in 3D without axis or
  /// about one without length, and an axis or centre without rotation.
  explicit RigidMotion(const RigidMotionOptions& options);

  bool moves() const { return moves_; }
  Vector translation(double t) const;  ///< m
  double angle(double t) const;        ///< rad
  Matrix rotation(double t) const;

  /// Where the point that rests at `X` is at time t, and back.
  Vector position(const Vector& X, double t) const {
    return centre_ + translation(t) + rotation(t) * (X - centre_);
  }
  Vector rest(const Vector& x, double t) const {
    return centre_ + rotation(t).transpose() * (x - centre_ - translation(t));
  }
  /// How far the body's point that is at x at time t moves until t + dt (m).
  Vector increment(const Vector& x, double t, double dt) const {
    const Vector r = x - centre_ - translation(t);
    return translation(t + dt) - translation(t) + rotation(t + dt) * (rotation(t).transpose() * r) - r;
  }
  /// Velocity (m/s) of the body's point that is at x at time t: that of the instant, of curves with corners
  /// the one that follows.
  Vector velocity(const Vector& x, double t) const;
  /// Centre of the rotation at time t, about which moments are taken.
  Vector centre(double t) const { return centre_ + translation(t); }

 private:
  std::array<Curve, dim> translation_{};
  Curve angle_{0.0};
  bool translation_is_rate_ = false, angle_is_rate_ = false, moves_ = false;
  Vector centre_ = Vector::Zero(), axis_ = Vector::Zero();
};

/// Integral of a curve from a to b, exact.
double integral(const Curve& curve, double a, double b);
/// Slope of a curve at t, at corners that of the part that follows.
double slope(const Curve& curve, double t);

extern template class RigidMotion<2>;
extern template class RigidMotion<3>;

}  // namespace wisp
