// The state in which a body starts: velocities and stresses of its points from its description.
#pragma once
#include "particle/body.h"
#include "particle/body_options.h"

namespace wisp {

/// Makes a body point by point. Errors (InputError) of the constructor: lists of the wrong length, both
/// initial_stress and k0.
template <int dim>
class InitialState {
 public:
  explicit InitialState(const BodyOptions& options);

  /// Adds a point: position (m), volume (m3), velocity besides that of the description (m/s).
  void add(std::int64_t id, const Vec<dim>& x, double volume, const Vec<dim>& velocity = Vec<dim>::Zero());
  int size() const { return body_.points.size(); }
  Body<dim> take() { return std::move(body_); }

 private:
  Sym<dim> stress_at(const Vec<dim>& x) const;

  const BodyOptions& options_;
  Body<dim> body_;
  Vec<dim> velocity_, centre_;
  Mat<dim> gradient_;
};

}  // namespace wisp
