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
  return square.pivot + turn(square.angle) * (own - square.pivot);
}

ModelOptions square_options(const SquareCase& square) {
  const double h = square.h;
  const double w = square.width, l = square.height;
  const Vec<2> corners[] = {placed(square, {0, 0}), placed(square, {w, 0}), placed(square, {w, l}),
                            placed(square, {0, l})};
  ModelOptions o;
  for (int d = 0; d < 2; ++d) {
    double low = corners[0][d], high = low;
    for (const Vec<2>& x : corners) low = std::min(low, x[d]), high = std::max(high, x[d]);
    const double first = std::floor((low - square.room) / h + 1e-9) - 2.0;
    const double last = std::ceil((high + square.room) / h - 1e-9) + 2.0;
    o.grid.lower.push_back(first * h), o.grid.upper.push_back(last * h);
    o.grid.cells.push_back(static_cast<int>(std::lround(last - first)));
  }
  if (square.gimp)
    o.basis = GimpOptions{};
  else
    o.basis = LinearOptions{};
  BodyOptions body;
  body.label = "square";
  Polygon outline;
  for (const Vec<2>& x : corners) outline.vertices.push_back({x[0], x[1]});
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

Vec<2> mean_displacement(const Solved& solved, const SquareCase& square) {
  Vec<2> mean = Vec<2>::Zero();
  double volume = 0.0;
  const auto& points = solved.model->bodies.front().points;
  for (std::size_t p = 0; p < points.volume.size(); ++p)
    mean += points.volume[p] * points.displacement[p], volume += points.volume[p];
  return turn(square.angle).transpose() * mean / volume;
}

Vec<2> at_node(const Solved& solved, int i, int j) {
  const int function = solved.model->space->window().node_index({i, j});
  return Eigen::Map<const Vec<2>>(solved.analysis->displacement().data() + 2 * function);
}

}  // namespace wisp::implicit_boundary_paper
