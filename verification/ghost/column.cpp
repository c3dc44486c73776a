#include "verification/ghost/column.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace wisp::ghost_paper {

namespace {
constexpr double young_modulus = 10e3, density = 80.0, gravity = 10.0;
}

ModelOptions column_options(const ColumnCase& column) {
  const double h = column_height / column.cells;
  ModelOptions o;
  o.grid.lower = {0.0, 0.0};
  o.grid.upper = {h, column_height + h};  // an empty cell above
  o.grid.cells = {1, column.cells + 1};
  o.basis = GimpOptions{};
  BodyOptions body;
  body.label = "column";
  Box box;
  box.lower = {0.0, 0.0}, box.upper = {h, column_height};
  body.shape = box;
  Hencky law;
  law.density = density, law.young_modulus = young_modulus, law.poisson_ratio = 0.0;
  body.material = law;
  o.bodies = {body};
  for (const auto& [name, normal, at] :
       {std::tuple{"base", "y", 0.0}, std::tuple{"left", "x", 0.0}, std::tuple{"right", "x", h}}) {
    ConformingOptions roller;
    roller.label = name, roller.normal = normal, roller.at = at, roller.directions = {normal};
    o.boundaries.push_back(roller);
  }
  GravityOptions weight;
  weight.acceleration = {0.0, -gravity};
  weight.factor.times = {0.0, 1.0}, weight.factor.values = {0.0, 1.0};
  o.gravity = weight;
  o.stabilisation = column.ghost;
  o.solver.solver = SolverKind::direct;
  return o;
}

ColumnRun run_column(const ColumnCase& column) {
  Model<2> model(column_options(column));
  QuasiStaticOptions stage;
  stage.steps = 40;
  Implicit<2> analysis(model, stage);
  ColumnRun run;
  for (int step = 0; step < stage.steps; ++step)
    run.iterations += analysis.step(analysis.time_step()).iterations;

  const Body<2>& body = model.bodies.front();
  const auto& points = body.points;
  double volume = 0.0, highest = -1.0;
  for_each_state<2>(body, [&](int p, const auto&, const auto& state) {
    const auto k = static_cast<std::size_t>(p);
    const double initial_y = points.position[k][1] - points.displacement[k][1];
    const double sigma = state.stress[1] / points.deformation_gradient[k].determinant();
    const double exact = -density * gravity * (column_height - initial_y);
    run.error += std::abs(sigma - exact) * points.volume[k] / (gravity * density * column_height);
    volume += points.volume[k];
    if (initial_y > highest) {
      highest = initial_y;
      run.top = points.position[k][1] + points.half_length[k][1] - column_height;
    }
  });
  run.error /= volume;
  return run;
}

}  // namespace wisp::ghost_paper
