#include "verification/powell_sabin/strip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/spectra.h"
#include "core/error.h"
#include "verification/powell_sabin/ulfem.h"

namespace wisp::powell_sabin {

StripCase small_bar() {
  StripCase s;
  s.density = 1.0, s.young_modulus = 100.0, s.length = 25.0, s.width = 2.0, s.speed = 0.1;
  return s;
}
StripCase large_bar() {
  StripCase s = small_bar();
  s.density = 25.0, s.young_modulus = 50.0;
  return s;
}
StripCase small_column() {
  StripCase s;
  s.column = true;
  s.density = 1.0, s.young_modulus = 5e4, s.length = 25.0, s.width = 2.0, s.gravity = 9.81;
  return s;
}
StripCase large_column() {
  StripCase s = small_column();
  s.density = 1e3, s.young_modulus = 1e5, s.length = 1.0, s.width = 0.1;
  return s;
}

namespace {

ConformingOptions hold(const char* label, const char* normal, double at,
                       std::vector<std::string> directions) {
  ConformingOptions c;
  c.label = label, c.normal = normal, c.at = at, c.directions = std::move(directions);
  return c;
}

void set_grid(const StripCase& s, ModelOptions& o) {
  const double block = s.length / s.blocks;
  const double reach = s.length + s.empty_blocks * block;
  if (!s.delaunay_seed) {
    TriangleBlocksOptions blocks;
    blocks.lower = {0.0, 0.0};
    blocks.upper = s.column ? std::vector{s.width, reach} : std::vector{reach, s.width};
    const int along = s.blocks + s.empty_blocks;
    blocks.cells = s.column ? std::vector{s.blocks_across, along} : std::vector{along, s.blocks_across};
    o.triangulation = blocks;
    return;
  }
  DelaunayOptions random;
  const double x = s.column ? s.width : reach, y = s.column ? reach : s.width;
  random.outline.vertices = {{0.0, 0.0}, {x, 0.0}, {x, y}, {0.0, y}};
  // Triangles of the area of a quarter block.
  random.spacing = std::sqrt(block * s.width / s.blocks_across / std::sqrt(3.0));
  random.irregularity = 0.3, random.seed = *s.delaunay_seed;
  o.triangulation = random;
}

ModelOptions strip_options(const StripCase& s) {
  ModelOptions o;
  set_grid(s, o);
  if (!s.splines)
    o.basis = LinearOptions{};
  else if (s.cubic)
    o.basis = PowellSabinCubicOptions{};
  else
    o.basis = PowellSabinOptions{};
  BodyOptions body;
  body.label = s.column ? "column" : "bar";
  Box box;
  box.lower = {0.0, 0.0};
  box.upper = s.column ? std::vector{s.width, s.length} : std::vector{s.length, s.width};
  body.shape = box;
  if (s.hencky)
    body.material = Hencky{s.density, s.young_modulus, 0.0};
  else
    body.material = JaumannElastic{s.density, s.young_modulus, 0.0};
  body.sampling.method = SamplingMethod::divisions;
  const int along = s.blocks * s.points, across = s.blocks_across * s.points_across;
  body.sampling.divisions = s.column ? std::vector{across, along} : std::vector{along, across};
  o.bodies = {body};
  if (s.column) {
    o.boundaries = {hold("base", "y", 0.0, {"x", "y"}), hold("left", "x", 0.0, {"x"}),
                    hold("right", "x", s.width, {"x"})};
    GravityOptions weight;
    weight.acceleration = {0.0, -s.gravity};
    o.gravity = weight;
  } else {
    o.boundaries = {hold("left", "x", 0.0, {"x", "y"}), hold("right", "x", s.length, {"x", "y"}),
                    hold("below", "y", 0.0, {"y"}), hold("above", "y", s.width, {"y"})};
  }
  o.stabilisation = s.ghost;
  return o;
}

std::size_t middle_point(const Particles<2>& points, const Vec<2>& middle) {
  std::size_t best = 0;
  for (std::size_t p = 1; p < points.position.size(); ++p)
    if ((points.position[p] - middle).norm() < (points.position[best] - middle).norm() - 1e-9) best = p;
  return best;
}

/// Kinetic energy, and strain energy minus the work of gravity, J. In uniaxial strain the thesis's law has
/// the energy E (s - 1 - ln s) of a stretch s (see Ulfem), which its own estimate from the stress only nears.
std::pair<double, double> energies(const StripCase& s, const Particles<2>& points) {
  double kinetic = 0.0, potential = 0.0;
  const int axis = s.column ? 1 : 0;
  for (std::size_t q = 0; q < points.mass.size(); ++q) {
    const double stretch = points.deformation_gradient[q](axis, axis);
    kinetic += 0.5 * points.mass[q] * points.velocity[q].squaredNorm();
    const double log = std::log(stretch);
    potential += points.volume[q] * s.young_modulus * (s.hencky ? 0.5 * log * log : stretch - 1.0 - log) +
                 s.gravity * points.mass[q] * points.displacement[q][1];
  }
  return {kinetic, potential};
}

}  // namespace

StripRun run_strip(const StripCase& s) {
  Model<2> model(strip_options(s));
  ExplicitOptions options;
  options.duration = s.duration, options.dt = s.dt;
  options.stress_update = StressUpdate::projected;
  options.integration = s.integration;
  options.mass = s.mass, options.fmpm_order = s.fmpm_order, options.deactivate_below = s.deactivate_below;
  Explicit<2> analysis(model, options);
  StripRun run;
  run.axis = s.column ? 1 : 0;
  Particles<2>& points = model.bodies.front().points;
  for (std::size_t p = 0; p < points.position.size(); ++p)
    points.velocity[p] =
        s.column ? Vec<2>(0.0, s.staggered ? 0.5 * s.dt * s.gravity : 0.0)
                 : Vec<2>(s.speed * std::sin(std::numbers::pi * points.position[p][0] / s.length), 0.0);
  const Vec<2> middle =
      s.column ? Vec<2>(0.5 * s.width, 0.5 * s.length) : Vec<2>(0.5 * s.length, 0.5 * s.width);
  const std::size_t first = middle_point(points, middle);
  const std::int64_t id = points.id[first];
  run.middle = points.position[first][run.axis];
  const auto steps = static_cast<int>(std::lround(s.duration / s.dt));
  try {
    for (int i = 1; i <= steps; ++i) {
      analysis.step(s.dt);
      run.end = model.time;
      if (i % s.record_every != 0 && i != steps) continue;
      const auto p =
          static_cast<std::size_t>(std::find(points.id.begin(), points.id.end(), id) - points.id.begin());
      run.time.push_back(model.time);
      run.displacement.push_back(points.displacement[p][run.axis]);
      run.velocity.push_back(points.velocity[p][run.axis]);
      const auto [kinetic, potential] = energies(s, points);
      run.energy.push_back(kinetic + potential);
      run.kinetic_scale = std::max(run.kinetic_scale, kinetic);
      if (s.with_conditions && run.time.size() % 50 == 1) {
        const ExplicitSpectrum<2> spectrum(model, options);
        run.condition.push_back(spectrum.condition());
      }
      // A point that has moved by the length of the strip has left the problem, if not yet the grid.
      if (!(std::abs(run.displacement.back()) < s.length)) run_error("the middle point has left the strip");
    }
  } catch (const RunError& error) {
    run.failure = error.what();
  }
  for (std::size_t q = 0; q < points.mass.size(); ++q) {
    run.start.push_back(points.position[q] - points.displacement[q]);
    run.moved.push_back(points.displacement[q]);
    run.point_velocity.push_back(points.velocity[q]);
    run.volume.push_back(points.volume[q]);
  }
  return run;
}

double StripRun::largest_error(const std::function<double(double x, double t)>& reference) const {
  if (!stable()) return std::numeric_limits<double>::infinity();
  double worst = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i)
    worst = std::max(worst, std::abs(displacement[i] - reference(middle, time[i])));
  return worst;
}

double StripRun::rms_error(const std::function<double(double x, double t)>& reference) const {
  if (!stable()) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i)
    sum += std::pow(displacement[i] - reference(middle, time[i]), 2);
  return std::sqrt(sum / static_cast<double>(time.size()));
}

double StripRun::rms_velocity_error(const std::function<double(double x, double t)>& reference) const {
  if (!stable()) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i) sum += std::pow(velocity[i] - reference(middle, time[i]), 2);
  return std::sqrt(sum / static_cast<double>(time.size()));
}

double StripRun::field_error(const std::function<double(double x)>& reference) const {
  if (!stable()) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (std::size_t p = 0; p < start.size(); ++p)
    sum += volume[p] * std::pow(moved[p][axis] - reference(start[p][axis]), 2);
  return std::sqrt(sum);
}

Reference ulfem_reference(const StripCase& s, double middle, const std::vector<double>& times) {
  UlfemCase c;
  c.length = s.length, c.density = s.density, c.young_modulus = s.young_modulus;
  c.acceleration = -s.gravity, c.end_held = !s.column, c.elements = 2000, c.hencky = s.hencky;
  if (!s.column) c.velocity = [&](double x) { return s.speed * std::sin(std::numbers::pi * x / s.length); };
  Ulfem ulfem(c);
  Reference r;
  for (const double t : times) {
    ulfem.advance_to(t);
    r.time.push_back(t);
    r.displacement.push_back(ulfem.displacement(middle)), r.velocity.push_back(ulfem.velocity(middle));
  }
  return r;
}

namespace {
double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return a.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(a.size()));
}
}  // namespace

double largest_error(const StripRun& run, const Reference& reference) {
  if (!run.stable()) return std::numeric_limits<double>::infinity();
  double worst = 0.0;
  for (std::size_t i = 0; i < run.time.size(); ++i)
    worst = std::max(worst, std::abs(run.displacement[i] - reference.displacement[i]));
  return worst;
}
double rms_error(const StripRun& run, const Reference& reference) {
  return run.stable() ? rms(run.displacement, reference.displacement)
                      : std::numeric_limits<double>::infinity();
}
double rms_velocity_error(const StripRun& run, const Reference& reference) {
  return run.stable() ? rms(run.velocity, reference.velocity) : std::numeric_limits<double>::infinity();
}

}  // namespace wisp::powell_sabin
