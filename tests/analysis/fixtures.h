// Cases in a few words for the tests of analyses.
#pragma once
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/explicit.h"
#include "analysis/implicit.h"

namespace wisp::analysis_test {

/// A grid between two corners.
template <int dim>
ModelOptions on_grid(const Vec<dim>& lower, const Vec<dim>& upper, const MultiIndex<dim>& cells, bool gimp) {
  ModelOptions o;
  o.grid.lower.assign(lower.data(), lower.data() + dim);
  o.grid.upper.assign(upper.data(), upper.data() + dim);
  o.grid.cells.assign(cells.data(), cells.data() + dim);
  if (gimp) o.basis = GimpOptions{};
  return o;
}

/// Adds a box-shaped body.
template <int dim>
BodyOptions& add_box(ModelOptions& o, const Vec<dim>& lower, const Vec<dim>& upper, const AnyLaw& law,
                     int points = 2) {
  BodyOptions body;
  body.label = "body " + std::to_string(o.bodies.size());
  body.shape = Box{std::vector<double>(lower.data(), lower.data() + dim),
                   std::vector<double>(upper.data(), upper.data() + dim)};
  body.sampling.points_per_cell = points;
  body.material = law;
  return o.bodies.emplace_back(body);
}

/// Fixes directions ("x", "xy", ...) on the grid line or plane `normal` = at.
inline ConformingOptions& hold(ModelOptions& o, const char* normal, double at,
                               const std::string& directions) {
  ConformingOptions c;
  c.label = std::string(normal) + " = " + std::to_string(at), c.normal = normal, c.at = at;
  for (const char d : directions) c.directions.emplace_back(1, d);
  return std::get<ConformingOptions>(o.boundaries.emplace_back(c));
}

/// Fixes directions at a node.
inline void pin(ModelOptions& o, std::vector<double> node, const std::string& directions) {
  ConformingOptions c;
  c.label = "pin", c.node = std::move(node);
  for (const char d : directions) c.directions.emplace_back(1, d);
  o.boundaries.push_back(c);
}

inline void add_gravity(ModelOptions& o, std::vector<double> acceleration, Curve factor = Curve(1.0)) {
  o.gravity = GravityOptions{std::move(acceleration), std::move(factor)};
}

/// From 0 at time 0 to 1 at time 1.
inline Curve ramp(double end = 1.0) {
  Curve c;
  c.times = {0.0, 1.0}, c.values = {0.0, end};
  return c;
}

/// Calls f(body, p) for every point on this rank.
template <int dim, class F>
void for_each_point(const Model<dim>& model, F&& f) {
  for (const auto& body : model.bodies)
    for (std::size_t p = 0; p < body.points.position.size(); ++p) f(body, p);
}

template <int dim>
Vec<dim> momentum(const Model<dim>& model) {
  Vec<dim> sum = Vec<dim>::Zero();
  for_each_point(
      model, [&](const auto& body, std::size_t p) { sum += body.points.mass[p] * body.points.velocity[p]; });
  return sum;
}
/// About the origin; the antisymmetric matrix x ^ m v.
template <int dim>
Mat<dim> angular_momentum(const Model<dim>& model) {
  Mat<dim> sum = Mat<dim>::Zero();
  for_each_point(model, [&](const auto& body, std::size_t p) {
    const Mat<dim> b = body.points.mass[p] * body.points.position[p] * body.points.velocity[p].transpose();
    sum += b - b.transpose();
  });
  return sum;
}
template <int dim>
double total_mass(const Model<dim>& model) {
  double sum = 0.0;
  for_each_point(model, [&](const auto& body, std::size_t p) { sum += body.points.mass[p]; });
  return sum;
}
/// Kirchhoff stress of point p of a body.
template <int dim>
Sym<dim> stress_of(const Body<dim>& body, std::size_t p) {
  return std::visit([&](const auto& group) { return Sym<dim>(group.old[p].stress); }, body.material);
}
/// Largest norm of a stress minus a reference f(body, p).
template <int dim, class F>
double stress_error(const Model<dim>& model, F&& reference) {
  double worst = 0.0;
  for_each_point(model, [&](const auto& body, std::size_t p) {
    worst = std::max(worst, (stress_of(body, p) - reference(body, p)).norm());
  });
  return worst;
}

/// Explicit options with a given step.
inline ExplicitOptions explicit_steps(double dt, Mass mass = Mass::lumped,
                                      StressUpdate stress = StressUpdate::usl,
                                      VelocityUpdate velocity = VelocityUpdate::flip) {
  ExplicitOptions e;
  e.dt = dt, e.duration = 1e9, e.mass = mass, e.stress_update = stress, e.velocity_update = velocity;
  return e;
}

constexpr StressUpdate all_schemes[] = {StressUpdate::usf, StressUpdate::usl, StressUpdate::musl,
                                        StressUpdate::projected};

/// What the mass is in an explicit run.
enum class MassKind { lumped, consistent, ghost };
constexpr MassKind all_masses[] = {MassKind::lumped, MassKind::consistent, MassKind::ghost};

/// The consistent mass alone is only solvable while no function hangs on the tip of a domain (Coombs 2023,
/// section 2.3): with linear functions and points that stay in their cells.
inline bool solvable(MassKind kind, bool gimp) { return kind != MassKind::consistent || !gimp; }

inline Mass apply(MassKind kind, ModelOptions& o) {
  o.stabilisation.reset();
  if (kind == MassKind::ghost) o.stabilisation = GhostOptions{};
  return kind == MassKind::lumped ? Mass::lumped : Mass::consistent;
}

/// Times at which a signal changes its sign, linearly interpolated.
inline std::vector<double> sign_changes(const std::vector<double>& times, const std::vector<double>& values) {
  std::vector<double> list;
  for (std::size_t k = 1; k < values.size(); ++k)
    if (values[k - 1] * values[k] < 0 || (values[k] == 0.0 && values[k - 1] != 0.0))
      list.push_back(times[k - 1] + (times[k] - times[k - 1]) * values[k - 1] / (values[k - 1] - values[k]));
  return list;
}

/// log2 of the ratio of two errors on grids of which the second has half the spacing.
inline double order(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace wisp::analysis_test
