#include "verification/powell_sabin/ulfem.h"

#include <algorithm>
#include <cmath>

namespace wisp::powell_sabin {

Ulfem::Ulfem(const UlfemCase& bar) : bar_(bar), h_(bar.length / bar.elements) {
  const auto n = static_cast<std::size_t>(bar.elements) + 1;
  stable_step_ = 0.5 * h_ / std::sqrt(bar.young_modulus / bar.density);
  mass_.assign(n, bar.density * h_);
  mass_.front() = mass_.back() = 0.5 * bar.density * h_;
  displacement_.assign(n, 0.0), velocity_.assign(n, 0.0), acceleration_.assign(n, 0.0);
  if (bar.velocity)
    for (std::size_t i = 1; i < n; ++i) velocity_[i] = bar.velocity(h_ * static_cast<double>(i));
  if (bar.end_held) velocity_.back() = 0.0;
  find_acceleration();
}

void Ulfem::find_acceleration() {
  const std::size_t n = mass_.size();
  std::fill(acceleration_.begin(), acceleration_.end(), 0.0);
  for (std::size_t e = 0; e + 1 < n; ++e) {
    const double stretch = 1.0 + (displacement_[e + 1] - displacement_[e]) / h_;
    // The section keeps its area, so the force is the Cauchy stress.
    const double force =
        bar_.young_modulus * (bar_.hencky ? std::log(stretch) / stretch : 1.0 - 1.0 / stretch);
    acceleration_[e] += force, acceleration_[e + 1] -= force;
  }
  for (std::size_t i = 1; i < n; ++i) acceleration_[i] = acceleration_[i] / mass_[i] + bar_.acceleration;
  acceleration_.front() = 0.0;
  if (bar_.end_held) acceleration_.back() = 0.0;
}

void Ulfem::advance_to(double t) {
  // Waves in a compressed bar cross an element sooner: at 20 % by 20 %, which the half leaves room for.
  const int steps = static_cast<int>(std::ceil((t - time_) / stable_step_ - 1e-9));
  if (steps < 1) return;
  const double dt = (t - time_) / steps;
  for (int s = 0; s < steps; ++s) {
    for (std::size_t i = 0; i < mass_.size(); ++i) {
      velocity_[i] += 0.5 * dt * acceleration_[i];
      displacement_[i] += dt * velocity_[i];
    }
    find_acceleration();
    for (std::size_t i = 0; i < mass_.size(); ++i) velocity_[i] += 0.5 * dt * acceleration_[i];
  }
  time_ = t;
}

double Ulfem::at(const std::vector<double>& field, double x) const {
  const double s = std::clamp(x / h_, 0.0, static_cast<double>(bar_.elements));
  const auto e = std::min(static_cast<std::size_t>(s), field.size() - 2);
  const double r = s - static_cast<double>(e);
  return (1.0 - r) * field[e] + r * field[e + 1];
}

double Ulfem::energy() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < mass_.size(); ++i)
    sum += mass_[i] * (0.5 * velocity_[i] * velocity_[i] - bar_.acceleration * displacement_[i]);
  for (std::size_t e = 0; e + 1 < mass_.size(); ++e) {
    const double stretch = 1.0 + (displacement_[e + 1] - displacement_[e]) / h_;
    // integral of E (1 - 1/s) ds, or of E ln(s)/s ds, from 1
    const double log = std::log(stretch);
    sum += h_ * bar_.young_modulus * (bar_.hencky ? 0.5 * log * log : stretch - 1.0 - log);
  }
  return sum;
}

}  // namespace wisp::powell_sabin
