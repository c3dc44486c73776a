#include "verification/ghost/collision.h"

#include <cmath>
#include <limits>

#include "core/error.h"
#include "transfer/explicit_transfer.h"
#include "verification/ghost/ghost_body.h"

namespace wisp::ghost_paper {

namespace {

template <class Law>
Law rubber() {
  Law law;
  law.density = 1000.0, law.young_modulus = 1000.0, law.poisson_ratio = 0.3;
  return law;
}

ModelOptions collision_options(const CollisionCase& collision) {
  AnyLaw law = rubber<Hencky>();
  if (collision.plastic) {
    VonMises plastic = rubber<VonMises>();
    plastic.yield_stress = 100.0;
    law = plastic;
  }
  const Resolution& points = resolution(collision.points);
  ModelOptions options;
  options.grid = unit_grid(collision.cells);
  options.basis = GimpOptions{};
  options.bodies = {ghost_body("lower", points, 0.0, 0.0, law), ghost_body("upper", points, 0.6, 0.6, law)};
  options.bodies[0].velocity = {0.1, 0.1}, options.bodies[1].velocity = {-0.1, -0.1};
  if (collision.mass == Mass::consistent) options.stabilisation = mass_stabilisation(density(law));
  return options;
}

}  // namespace

double CollisionRun::mean_error(bool of_grid) const {
  if (!failure.empty()) return std::numeric_limits<double>::infinity();
  const std::vector<double>& moving = of_grid ? grid_kinetic : kinetic;
  double sum = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i) sum += std::abs(moving[i] + strain[i] - initial);
  return sum / (static_cast<double>(time.size()) * initial);
}

CollisionRun run_collision(const CollisionCase& collision,
                           const std::function<void(const Model<2>&)>& watch) {
  Model<2> model(collision_options(collision));
  ExplicitOptions options;
  options.duration = collision_duration, options.steps = collision.steps;
  options.mass = collision.mass, options.stress_update = collision.update;
  // The paper, below its eq. 2: derivatives in the updated coordinates.
  options.updated_gradients = collision.update == StressUpdate::usf;
  Explicit<2> analysis(model, options);
  CollisionRun run;
  for (const auto& body : model.bodies) run.initial += energy(body).kinetic;
  try {
    for (int i = 0; i < collision.steps; ++i) {
      EnergyRecord record;
      const double now = model.time;
      analysis.step(collision_duration / collision.steps, &record);
      run.time.push_back(now);
      run.kinetic.push_back(record.kinetic), run.grid_kinetic.push_back(record.grid_kinetic);
      run.strain.push_back(record.strain);
      run.dissipation.push_back(record.dissipation);
      if (watch) watch(model);
    }
  } catch (const RunError& error) {
    run.failure = error.what();
  }
  return run;
}

}  // namespace wisp::ghost_paper
