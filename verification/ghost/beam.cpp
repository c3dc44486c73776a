#include "verification/ghost/beam.h"

#include <algorithm>
#include <limits>

#include "core/error.h"

namespace wisp::ghost_paper {

/// u_x = 0 along x = 0, u_y = 0 at the mid-depth node only; P/2 on each of the two end points next to
/// mid-depth; an empty row of cells below and, for the deflection (upwards here), many above.
ModelOptions beam_options(const BeamCase& beam) {
  const double h = beam.h, length = 10.0, depth = 1.0, middle = h + 0.5 * depth;
  ModelOptions o;
  o.grid.lower = {0.0, 0.0};
  o.grid.upper = {11.0, 12.0};
  o.grid.cells = {static_cast<int>(std::lround(11.0 / h)), static_cast<int>(std::lround(12.0 / h))};
  o.basis = GimpOptions{};
  BodyOptions body;
  body.label = "beam";
  Box box;
  box.lower = {0.0, h}, box.upper = {length, h + depth};
  body.shape = box;
  body.sampling.points_per_cell = beam.points;
  Hencky law;
  law.density = 0.0, law.young_modulus = 12e6, law.poisson_ratio = 0.2;
  body.material = law;
  o.bodies = {body};
  ConformingOptions wall;
  wall.label = "wall", wall.normal = "x", wall.at = 0.0, wall.directions = {"x"};
  ConformingOptions pin;
  pin.label = "pin", pin.node = {0.0, middle}, pin.directions = {"y"};
  o.boundaries = {wall, pin};
  const double half = 0.5 * h / beam.points;
  PointLoadOptions load;
  load.label = "end", load.body = "beam", load.force = {0.0, 100e3};
  load.nearest = {{length - half, middle - half}, {length - half, middle + half}};
  load.factor.times = {0.0, 1.0}, load.factor.values = {0.0, 1.0};
  o.loads = {load};
  o.stabilisation = beam.ghost;
  o.solver.solver = SolverKind::direct;
  return o;
}

BeamRun run_beam(const BeamCase& beam) {
  BeamRun run;
  run.model = std::make_unique<Model<2>>(beam_options(beam));
  QuasiStaticOptions stage;
  stage.steps = beam_steps, stage.tolerance = 1e-6, stage.max_iterations = 10;
  Implicit<2> analysis(*run.model, stage);
  const auto& ids = std::get<PointLoad<2>>(run.model->loads.front()).ids();
  run.margin = std::numeric_limits<double>::infinity();
  try {
    for (int step = 1; step <= beam_steps; ++step) {
      const ImplicitRecord record = analysis.step(analysis.time_step());
      run.finished = step;
      run.iterations += record.iterations, run.most = std::max(run.most, record.iterations);
      run.margin = std::min(run.margin, record.margin);
      Vec<2> tip = Vec<2>::Zero();
      const auto& points = run.model->bodies.front().points;
      for (std::size_t p = 0; p < points.id.size(); ++p)
        if (std::find(ids.begin(), ids.end(), points.id[p]) != ids.end())
          tip += points.displacement[p] / static_cast<double>(ids.size());
      run.load.push_back(100e3 * step / beam_steps);
      run.tip.push_back(tip);
    }
  } catch (const RunError& error) {
    run.failure = error.what();
  }
  for (const auto& part : run.model->timers.parts())
    if (part.name.starts_with("3a") || part.name.starts_with("3b")) run.point_seconds += part.seconds;
  return run;
}

}  // namespace wisp::ghost_paper
