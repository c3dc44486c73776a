#include "verification/powell_sabin/disc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "transfer/explicit_transfer.h"

namespace wisp::powell_sabin {

namespace {

Vec<2> momentum(const Particles<2>& points) {
  Vec<2> sum = Vec<2>::Zero();
  for (std::size_t p = 0; p < points.mass.size(); ++p) sum += points.mass[p] * points.velocity[p];
  return sum;
}

double angular_momentum(const Particles<2>& points) {
  double sum = 0.0;
  for (std::size_t p = 0; p < points.mass.size(); ++p)
    sum += points.mass[p] *
           (points.position[p][0] * points.velocity[p][1] - points.position[p][1] * points.velocity[p][0]);
  return sum;
}

}  // namespace

ModelOptions disc_options(const DiscCase& d) {
  ModelOptions o;
  DelaunayOptions random;
  random.outline.vertices = {{-0.6, -0.6}, {1.4, -0.6}, {1.4, 0.9}, {-0.6, 0.9}};
  random.spacing = d.spacing, random.irregularity = 0.3, random.seed = d.seed;
  o.triangulation = random;
  o.basis = PowellSabinOptions{};
  BodyOptions body;
  body.label = "disc";
  body.shape = Ball{{0.0, 0.0}, disc_radius};
  body.sampling.method = SamplingMethod::divisions;
  body.sampling.divisions = {d.points_across, d.points_across};
  body.material = disc_law();
  body.velocity = {disc_velocity[0], disc_velocity[1]};
  const double turn = 2.0 * std::numbers::pi * 0.25, expansion = 0.5;
  if (d.turns) body.velocity_gradient = {{expansion, -turn}, {turn, expansion}};
  o.bodies = {body};
  o.stabilisation = d.ghost;
  return o;
}

ExplicitOptions disc_step(const DiscCase& d) {
  ExplicitOptions options;
  options.duration = d.duration, options.dt = d.dt;
  options.stress_update = StressUpdate::projected;
  options.mass = d.mass, options.fmpm_order = d.fmpm_order, options.deactivate_below = d.deactivate_below;
  return options;
}

DiscRun run_disc(const DiscCase& d) {
  Model<2> model(disc_options(d));
  Explicit<2> analysis(model, disc_step(d));
  const Body<2>& body = model.bodies.front();
  const Vec<2> p = momentum(body.points);
  const double l = angular_momentum(body.points);
  const BodyEnergy first = energy(body);
  DiscRun run;
  try {
    const auto steps = static_cast<int>(std::lround(d.duration / d.dt));
    for (int i = 0; i < steps; ++i) {
      analysis.step(d.dt);
      run.end = model.time;
      run.momentum = std::max(run.momentum, (momentum(body.points) - p).norm() / p.norm());
      run.angular_momentum =
          std::max(run.angular_momentum, std::abs(angular_momentum(body.points) / l - 1.0));
      const BodyEnergy e = energy(body);
      run.energy =
          std::max(run.energy, std::abs((e.kinetic + e.strain) / (first.kinetic + first.strain) - 1.0));
    }
  } catch (const RunError& error) {
    run.failure = error.what();
  }
  return run;
}

}  // namespace wisp::powell_sabin
