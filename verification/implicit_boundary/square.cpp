#include "verification/implicit_boundary/square.h"

#include <cmath>
#include <numbers>

namespace wisp::implicit_boundary_paper {

Mat<2> turn(double degrees) {
  const double quarters = degrees / 90.0;
  const double c = quarters == std::round(quarters) ? std::round(std::cos(degrees * std::numbers::pi / 180.0))
                                                    : std::cos(degrees * std::numbers::pi / 180.0);
  const double s = quarters == std::round(quarters) ? std::round(std::sin(degrees * std::numbers::pi / 180.0))
                                                    : std::sin(degrees * std::numbers::pi / 180.0);
  Mat<2> r;
  r << c, -s, s, c;
  return r;
}

Vec<2> placed(const SquareCase& square, const Vec<2>& own) {
  const Vec<2> centre = Vec<2>::Constant(0.5 * side);
  return centre + turn(square.angle) * (own - centre);
}

ModelOptions square_options(const SquareCase& square) {
  const double h = square.h;
  const int margin = static_cast<int>(std::ceil(0.5 * (std::sqrt(2.0) - 1.0) * side / h)) + 2;
  const int cells = static_cast<int>(std::lround(side / h)) + 2 * margin;
  ModelOptions o;
  o.grid.lower = {-margin * h, -margin * h};
  o.grid.upper = {(cells - margin) * h, (cells - margin) * h};
  o.grid.cells = {cells, cells};
  if (square.gimp)
    o.basis = GimpOptions{};
  else
    o.basis = LinearOptions{};
  BodyOptions body;
  body.label = "square";
  Polygon outline;
  for (const Vec<2>& own : {Vec<2>(0, 0), Vec<2>(side, 0), Vec<2>(side, side), Vec<2>(0, side)}) {
    const Vec<2> x = placed(square, own);
    outline.vertices.push_back({x[0], x[1]});
  }
  body.shape = outline;
  body.sampling.points_per_cell = square.points, body.sampling.clip = true;
  if (square.finite) {
    Hencky law;
    law.young_modulus = young_modulus, law.poisson_ratio = poisson_ratio, law.density = 1.0;
    body.material = law;
  } else {
    LinearElastic law;
    law.young_modulus = young_modulus, law.poisson_ratio = poisson_ratio, law.density = 1.0;
    body.material = law;
  }
  o.bodies = {body};
  o.solver.solver = SolverKind::direct;
  return o;
}

WallOptions& add_wall(ModelOptions& options, const SquareCase& square, const char* name, const Vec<2>& a,
                      const Vec<2>& b, WallKind kind) {
  WallOptions wall;
  wall.label = name, wall.kind = kind, wall.mode = square.mode, wall.delta = square.delta;
  wall.ghost = square.ghost;
  PolylineWall line;
  for (const Vec<2>& own : {a, b}) {
    const Vec<2> x = placed(square, own);
    line.vertices.push_back({x[0], x[1]});
  }
  wall.shape = line;
  return std::get<WallOptions>(options.boundaries.emplace_back(wall));
}

Solved solve(const ModelOptions& options, int steps) {
  Solved solved;
  solved.model = std::make_unique<Model<2>>(options);
  QuasiStaticOptions stage;
  stage.steps = steps;
  solved.analysis = std::make_unique<Implicit<2>>(*solved.model, stage);
  for (int step = 0; step < steps; ++step)
    solved.record = solved.analysis->step(solved.analysis->time_step());
  return solved;
}

Vec<2> at_node(const Solved& solved, int i, int j) {
  const int function = solved.model->space->window().node_index({i, j});
  return Eigen::Map<const Vec<2>>(solved.analysis->displacement().data() + 2 * function);
}

}  // namespace wisp::implicit_boundary_paper
