// Sections 5.1 and 5.2 of Cortis, Coombs and Augarde 2018 in 3D: a cube of 100 mm turned about two axes.
#include <fmt/format.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

#include "verification/implicit_boundary/list.h"
#include "verification/implicit_boundary/square.h"
#include "verification/published.h"

namespace wisp {

namespace {
using namespace implicit_boundary_paper;

/// Turned by `tilt` about x, then by `turn` about z, about the cube's centre (degrees).
struct Cube {
  double turn = 0.0, tilt = 0.0;
  int cells = 5;
  int points = 2;
};

Mat<3> rotation(const Cube& cube) {
  const double per_degree = std::numbers::pi / 180.0;
  return (Eigen::AngleAxisd(cube.turn * per_degree, Vec<3>::UnitZ()) *
          Eigen::AngleAxisd(cube.tilt * per_degree, Vec<3>::UnitX()))
      .toRotationMatrix();
}

std::vector<double> list(const Vec<3>& x) { return {x[0], x[1], x[2]}; }

/// The body, cut out of a larger box by six planes.
ModelOptions options(const Cube& cube) {
  const double h = side / cube.cells;
  const Mat<3> r = rotation(cube);
  const Vec<3> reach = 0.5 * side * r.cwiseAbs().rowwise().sum();
  ModelOptions o;
  Box box;
  for (int d = 0; d < 3; ++d) {
    const int n = static_cast<int>(std::ceil(reach[d] / h - 1e-9)) + 1;
    o.grid.lower.push_back(-n * h), o.grid.upper.push_back(n * h), o.grid.cells.push_back(2 * n);
    box.lower.push_back(-(n - 1) * h), box.upper.push_back((n - 1) * h);
  }
  o.basis = LinearOptions{};
  BodyOptions body;
  body.label = "cube", body.shape = box, body.sampling.points_per_cell = cube.points;
  for (int d = 0; d < 3; ++d)
    for (const double sign : {1.0, -1.0}) {
      const Vec<3> n = sign * r.col(d), at = -0.5 * side * n;
      std::vector<double> row = list(at);
      for (const double c : list(n)) row.push_back(c);
      body.sampling.cuts.push_back(row);
    }
  LinearElastic law;
  law.young_modulus = young_modulus, law.poisson_ratio = poisson_ratio, law.density = 1.0;
  body.material = law;
  o.bodies = {body};
  o.solver.solver = SolverKind::direct;
  return o;
}

/// The face of the cube whose inward normal is `sign` times its own axis d.
WallOptions& add_face(ModelOptions& o, const Cube& cube, const char* name, int d, double sign,
                      WallKind kind) {
  const Mat<3> r = rotation(cube);
  const Vec<3> n = sign * r.col(d), a = r.col((d + 1) % 3), b = r.col((d + 2) % 3);
  WallOptions wall;
  wall.label = name, wall.kind = kind;
  PlaneWall plane;
  plane.normal = list(n);
  plane.point = list(-0.5 * side * (n + a + b));
  plane.edges = {list(side * a), list(side * b)};
  wall.shape = plane;
  return std::get<WallOptions>(o.boundaries.emplace_back(wall));
}

struct Solved3 {
  Model<3> model;
  Implicit<3> analysis;
  explicit Solved3(const ModelOptions& o) : model(o), analysis(model, QuasiStaticOptions{.steps = 1}) {
    analysis.step(1.0);
  }
};

/// Volume error and, of the contained cube, the stress error along the push.
std::vector<double> contained(const Cube& cube) {
  ModelOptions o = options(cube);
  add_face(o, cube, "left", 0, 1.0, WallKind::roller);
  add_face(o, cube, "front", 1, 1.0, WallKind::roller);
  add_face(o, cube, "back", 1, -1.0, WallKind::roller);
  add_face(o, cube, "base", 2, 1.0, WallKind::roller);
  add_face(o, cube, "top", 2, -1.0, WallKind::roller);
  WallOptions& press = add_face(o, cube, "press", 0, -1.0, WallKind::roller);
  Curve push;
  push.times = {0.0, 1.0}, push.values = {0.0, 1.0};
  press.displacement = {push, Curve(0.0), Curve(0.0)};
  const Solved3 s(o);
  const double exact = -Elasticity::from(young_modulus, poisson_ratio).p_wave_modulus() / side;
  const Mat<3> r = rotation(cube);
  double volume = 0.0, error = 0.0;
  const auto& body = s.model.bodies.front();
  for_each_state<3>(body, [&](int p, const auto&, const auto& state) {
    const double v = body.points.volume[static_cast<std::size_t>(p)];
    const double sigma = r.col(0).dot(matrix<3>(state.stress) * r.col(0));
    volume += v, error += v * std::abs((sigma - exact) / exact);
  });
  return {volume / (side * side * side) - 1.0, error / volume};
}

double sag(const Cube& cube) {
  ModelOptions o = options(cube);
  GravityOptions weight;
  const Mat<3> r = rotation(cube);
  weight.acceleration = list(-r.col(2));
  o.gravity = weight;
  add_face(o, cube, "support", 0, 1.0, WallKind::fixed);
  const Solved3 s(o);
  double mean = 0.0, volume = 0.0;
  const auto& points = s.model.bodies.front().points;
  for (std::size_t p = 0; p < points.volume.size(); ++p)
    mean += points.volume[p] * points.displacement[p].dot(r.col(2)), volume += points.volume[p];
  return mean / volume;
}

std::vector<VerificationRow> cubes(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  const auto add = [&](const std::string& name, const char* quantity, double value, double tolerance) {
    VerificationRow row;
    row.case_name = name, row.quantity = quantity, row.computed = value;
    row.reference = "exact", row.expected = 0.0, row.tolerance = tolerance, row.gated = true;
    rows.push_back(row);
  };
  for (const Cube& cube : {Cube{0, 0, 5, 2}, Cube{30, 0, 5, 2}, Cube{30, 20, 5, 2}, Cube{45, 35, 5, 2}}) {
    const std::string name = fmt::format("contained cube, {:g} and {:g} degrees", cube.turn, cube.tilt);
    const auto result = contained(cube);
    add(name, "volume", result[0], 1e-12);
    add(name, "stress error", result[1], cube.turn == 0.0 ? 1e-9 : 0.01);
  }
  const int cells = request.full ? 8 : 5;
  const double upright = sag({0, 0, cells, 2});
  for (const Cube& cube : {Cube{30, 0, cells, 2}, Cube{30, 20, cells, 2}, Cube{45, 35, cells, 2}})
    add(fmt::format("clamped cube, {:g} and {:g} degrees, h = {:g} mm", cube.turn, cube.tilt, side / cells),
        "change of the mean sag", sag(cube) / upright - 1.0, 0.02);
  return rows;
}

}  // namespace

std::vector<VerificationTable> spatial_tables() {
  return {{"implicit-boundary.cubes", "Contained and clamped cube, turned about two axes", cubes, false}};
}

}  // namespace wisp
