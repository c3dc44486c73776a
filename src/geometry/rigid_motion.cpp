#include "geometry/rigid_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace wisp {
namespace {

template <int dim>
Eigen::Matrix<double, dim, 1> vector(const std::vector<double>& values, std::string_view key) {
  if (values.size() != static_cast<std::size_t>(dim))
    input_error("motion: '{}' has {} values, expected {} in {}D", key, values.size(), dim, dim);
  return Eigen::Map<const Eigen::Matrix<double, dim, 1>>(values.data());
}

/// Integral from the first time of a curve to t.
double integral_from_start(const Curve& curve, double t) {
  const auto& x = curve.times;
  const auto& y = curve.values;
  if (t <= x.front()) return y.front() * (t - x.front());
  double sum = 0.0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (t <= x[i]) return sum + 0.5 * (y[i - 1] + curve(t)) * (t - x[i - 1]);
    sum += 0.5 * (y[i - 1] + y[i]) * (x[i] - x[i - 1]);
  }
  return sum + y.back() * (t - x.back());
}

}  // namespace

double integral(const Curve& curve, double a, double b) {
  return integral_from_start(curve, b) - integral_from_start(curve, a);
}

double slope(const Curve& curve, double t) {
  if (t < curve.times.front() || t >= curve.times.back()) return 0.0;
  const auto i = static_cast<std::size_t>(std::upper_bound(curve.times.begin(), curve.times.end(), t) -
                                          curve.times.begin());
  return (curve.values[i] - curve.values[i - 1]) / (curve.times[i] - curve.times[i - 1]);
}

template <int dim>
RigidMotion<dim>::RigidMotion(const RigidMotionOptions& options) {
  if (!options.displacement.empty() && !options.velocity.empty())
    input_error("motion: give either 'displacement' or 'velocity'");
  if (options.rotation && options.angular_velocity)
    input_error("motion: give either 'rotation' or 'angular_velocity'");
  translation_is_rate_ = !options.velocity.empty();
  const auto& curves = translation_is_rate_ ? options.velocity : options.displacement;
  if (!curves.empty()) {
    if (curves.size() != dim)
      input_error("motion: '{}' has {} entries, expected {} in {}D",
                  translation_is_rate_ ? "velocity" : "displacement", curves.size(), dim, dim);
    std::copy(curves.begin(), curves.end(), translation_.begin());
    moves_ = true;
  }
  const bool turns = options.rotation || options.angular_velocity;
  if (!turns && !(options.centre.empty() && options.axis.empty()))
    input_error("motion: '{}' without 'rotation' or 'angular_velocity'",
                options.axis.empty() ? "centre" : "axis");
  if (!turns) return;
  moves_ = true;
  angle_is_rate_ = options.angular_velocity.has_value();
  angle_ = angle_is_rate_ ? *options.angular_velocity : *options.rotation;
  if (!options.centre.empty()) centre_ = vector<dim>(options.centre, "centre");
  if constexpr (dim == 2) {
    if (!options.axis.empty())
      input_error("motion: 'axis' is for 3D; in 2D bodies turn about the z direction");
  } else {
    if (options.axis.empty()) input_error("motion: a rotation in 3D needs 'axis'");
    axis_ = vector<dim>(options.axis, "axis");
    if (!(axis_.norm() > 0.0)) input_error("motion: 'axis' has no length");
    axis_.normalize();
  }
}

template <int dim>
typename RigidMotion<dim>::Vector RigidMotion<dim>::translation(double t) const {
  Vector u;
  for (int d = 0; d < dim; ++d) {
    const Curve& curve = translation_[static_cast<std::size_t>(d)];
    u[d] = translation_is_rate_ ? integral(curve, 0.0, t) : curve(t);
  }
  return u;
}

template <int dim>
double RigidMotion<dim>::angle(double t) const {
  return angle_is_rate_ ? integral(angle_, 0.0, t) : angle_(t);
}

template <int dim>
typename RigidMotion<dim>::Matrix RigidMotion<dim>::rotation(double t) const {
  const double a = angle(t);
  if (a == 0.0) return Matrix::Identity();
  if constexpr (dim == 2) {
    return Eigen::Rotation2Dd(a).toRotationMatrix();
  } else {
    return Eigen::AngleAxisd(a, axis_).toRotationMatrix();
  }
}

template <int dim>
typename RigidMotion<dim>::Vector RigidMotion<dim>::velocity(const Vector& x, double t) const {
  Vector v;
  for (int d = 0; d < dim; ++d) {
    const Curve& curve = translation_[static_cast<std::size_t>(d)];
    v[d] = translation_is_rate_ ? curve(t) : slope(curve, t);
  }
  const double rate = angle_is_rate_ ? angle_(t) : slope(angle_, t);
  const Vector r = x - centre(t);
  if constexpr (dim == 2) {
    v += rate * Vector(-r.y(), r.x());
  } else {
    v += rate * axis_.cross(r);
  }
  return v;
}

template class RigidMotion<2>;
template class RigidMotion<3>;

}  // namespace wisp
