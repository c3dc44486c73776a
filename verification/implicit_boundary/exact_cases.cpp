#include "verification/implicit_boundary/exact_cases.h"

#include <cmath>
#include <numbers>

namespace wisp::implicit_boundary_paper {

using std::numbers::pi;

double manufactured_error(ModelOptions o, const SquareCase& square) {
  add_wall(o, square, "left", {0, side}, {0, 0}, WallKind::fixed);
  add_wall(o, square, "base", {0, 0}, {side, 0}, WallKind::fixed);
  add_wall(o, square, "right", {side, 0}, {side, side}, WallKind::fixed);
  add_wall(o, square, "top", {side, side}, {0, side}, WallKind::fixed);
  const Elasticity c = Elasticity::from(young_modulus, poisson_ratio);
  const Mat<2> r = turn(square.angle);
  const double k = pi / side, a = 0.1;
  const Vec<2> direction(1.0, 0.5);
  Solved solved;
  solved.model = std::make_unique<Model<2>>(o);
  solved.model->body_acceleration = [&](const Vec<2>& start, double t) {
    const Vec<2> x = r.transpose() * start;
    const double ss = std::sin(k * x[0]) * std::sin(k * x[1]), cc = std::cos(k * x[0]) * std::cos(k * x[1]);
    // div sigma = mu lap u + (lambda + mu) grad div u
    const Vec<2> laplacian = -2.0 * k * k * ss * direction;
    const Vec<2> grad_div(k * k * (-direction[0] * ss + direction[1] * cc),
                          k * k * (direction[0] * cc - direction[1] * ss));
    return Vec<2>(-a * (t > 0.0 ? 1.0 : 0.0) * (r * (c.mu * laplacian + (c.lambda + c.mu) * grad_div)));
  };
  solved.analysis = std::make_unique<Implicit<2>>(*solved.model, QuasiStaticOptions{.steps = 1});
  solved.analysis->step(1.0);
  double error = 0.0, norm = 0.0;
  const auto& points = solved.model->bodies.front().points;
  for (std::size_t p = 0; p < points.volume.size(); ++p) {
    const Vec<2> x = r.transpose() * (points.position[p] - points.displacement[p]);
    const Vec<2> exact = a * std::sin(k * x[0]) * std::sin(k * x[1]) * direction;
    error += points.volume[p] * (r.transpose() * points.displacement[p] - exact).squaredNorm();
    norm += points.volume[p] * exact.squaredNorm();
  }
  return std::sqrt(error / norm);
}

Cylinder solve_cylinder(ModelOptions o, const Sampling& sampling) {
  const double a = inner_radius, b = outer_radius, push = 1.0;
  Polygon outline;
  constexpr int n = 720;
  for (int k = 0; k <= n; ++k) {
    const double t = 0.5 * pi * k / n;
    outline.vertices.push_back({b * std::cos(t), b * std::sin(t)});
  }
  for (int k = n; k >= 0; --k) {
    const double t = 0.5 * pi * k / n;
    outline.vertices.push_back({a * std::cos(t), a * std::sin(t)});
  }
  BodyOptions body;
  body.label = "cylinder", body.shape = outline;
  body.sampling = sampling;
  LinearElastic law;
  law.young_modulus = young_modulus, law.poisson_ratio = poisson_ratio, law.density = 1.0;
  body.material = law;
  o.bodies = {body};
  o.solver.solver = SolverKind::direct;
  const auto roller = [&](const char* name, std::vector<std::vector<double>> vertices) {
    WallOptions wall;
    wall.label = name, wall.kind = WallKind::roller;
    PolylineWall line;
    line.vertices = std::move(vertices);
    wall.shape = line;
    o.boundaries.push_back(wall);
  };
  roller("base", {{a, 0.0}, {b, 0.0}});
  roller("side", {{0.0, b}, {0.0, a}});
  WallOptions inner;
  inner.label = "inner", inner.kind = WallKind::prescribed;
  ArcWall arc;
  arc.centre = {0.0, 0.0}, arc.radius = a, arc.from = 0.0, arc.to = 90.0, arc.solid = SolidSide::outside;
  inner.shape = arc;
  Curve out;
  out.times = {0.0, 1.0}, out.values = {0.0, push};
  inner.displacement = {out, Curve(0.0)};
  o.boundaries.push_back(inner);
  const Solved solved = solve(o);

  // u = A r + B/r without radial stress at b (Lame 1852)
  const Elasticity c = Elasticity::from(young_modulus, poisson_ratio);
  const double ratio = (c.lambda + c.mu) / c.mu * b * b;  // B = ratio A
  const double A = push / (a + ratio / a), B = ratio * A;
  const double pressure = -(2.0 * (c.lambda + c.mu) * A - 2.0 * c.mu * B / (a * a));
  Cylinder result;
  double error = 0.0, norm = 0.0;
  const auto& points = solved.model->bodies.front().points;
  for (std::size_t p = 0; p < points.volume.size(); ++p) {
    const Vec<2> x = points.position[p] - points.displacement[p];
    const double r = x.norm();
    const Vec<2> exact = (A * r + B / r) * x / r;
    error += points.volume[p] * (points.displacement[p] - exact).squaredNorm();
    norm += points.volume[p] * exact.squaredNorm();
  }
  result.displacement = std::sqrt(error / norm);
  result.pressure = solved.model->reactions.back()[0] / (pressure * a);
  return result;
}

}  // namespace wisp::implicit_boundary_paper
