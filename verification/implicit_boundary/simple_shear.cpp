// Section 5.3 of Cortis, Coombs and Augarde 2018: a block sheared over two cells, its support anywhere in
// them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/spectra.h"
#include "verification/implicit_boundary/list.h"
#include "verification/implicit_boundary/square.h"
#include "verification/published.h"

namespace wisp {

namespace {
using namespace implicit_boundary_paper;

struct Shear {
  double error = 0.0;  ///< of the shear stress, eq. 30
  double condition = 0.0;
};

/// Cells of `h` mm; the block is 100 mm wide and high with its support at x = a; 20 x 20 points over two
/// cells of the paper, so 10 a direction. Sheared by 10 mm at the free end; top and base keep u_x = 0.
Shear shear(double a, double h, WallMode mode, std::optional<double> delta, bool condition,
            const SolverOptions& solver = {SolverKind::direct}) {
  ModelOptions o;
  const int cells = static_cast<int>(std::lround(side / h));
  o.grid.lower = {-2.0 * h, -h}, o.grid.upper = {2.0 * side + 2.0 * h, side + h};
  o.grid.cells = {2 * cells + 4, cells + 2};
  o.basis = LinearOptions{};
  BodyOptions body;
  body.label = "block";
  body.shape = Box{{a, 0.0}, {a + side, side}};
  body.sampling.points_per_cell = std::max(1, static_cast<int>(std::lround(20.0 * h / side)));
  body.sampling.clip = true;
  LinearElastic law;
  law.young_modulus = young_modulus, law.poisson_ratio = poisson_ratio, law.density = 1.0;
  body.material = law;
  o.bodies = {body};
  o.solver = solver;
  const auto wall = [&](const char* name, Vec<2> from, Vec<2> to, WallKind kind, double push) {
    WallOptions w;
    w.label = name, w.kind = kind, w.mode = mode, w.delta = delta;
    PolylineWall line;
    line.vertices = {{from[0], from[1]}, {to[0], to[1]}};
    w.shape = line;
    if (push != 0.0) {
      Curve along;
      along.times = {0.0, 1.0}, along.values = {0.0, push};
      w.motion = RigidMotionOptions{};
      w.motion->displacement = {Curve(0.0), along};
    }
    o.boundaries.push_back(w);
  };
  wall("support", {a, side}, {a, 0.0}, WallKind::fixed, 0.0);
  wall("free end", {a + side, 0.0}, {a + side, side}, WallKind::fixed, 10.0);
  wall("base", {a, 0.0}, {a + side, 0.0}, WallKind::tangential, 0.0);
  wall("top", {a + side, side}, {a, side}, WallKind::tangential, 0.0);
  const Solved solved = solve(o);
  const double exact = Elasticity::from(young_modulus, poisson_ratio).mu * 10.0 / side;
  Shear result;
  double volume = 0.0;
  const auto& points = solved.model->bodies.front().points;
  for_each_state<2>(solved.model->bodies.front(), [&](int p, const auto&, const auto& state) {
    const double v = points.volume[static_cast<std::size_t>(p)];
    result.error += v * std::abs((state.stress[3] - exact) / exact), volume += v;
  });
  result.error /= volume;
  if (condition)
    result.condition = condition_number(solved.analysis->stiffness(), solved.analysis->unknowns());
  return result;
}

/// The error does not depend on where in its cell the support lies, as long as what the support cuts off a
/// cell is wider than the band. The consistent form has none beyond rounding.
std::vector<VerificationRow> figure_16(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  FigureColumn place{"position of the support [mm]", {}};
  for (const double a :
       {0.0, 0.01, 1.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0, 99.0, 99.99, 100.0})
    place.values.push_back(a);
  struct Form {
    const char* name;
    WallMode mode;
    double delta;
  };
  std::vector<FigureColumn> columns{place};
  for (const Form& form : {Form{"literal, delta = 1e-3 h", WallMode::literal, 1e-3},
                           Form{"literal, delta = 1e-6 h", WallMode::literal, 1e-6},
                           Form{"consistent", WallMode::consistent, 1e-2}}) {
    FigureColumn column{form.name, {}};
    for (const double a : place.values)
      column.values.push_back(shear(a, side, form.mode, form.delta, false).error);
    const auto [least, most] = std::minmax_element(column.values.begin(), column.values.end());
    VerificationRow row;
    row.case_name = form.name;
    row.quantity = "greatest error of the shear stress";
    row.computed = *most;
    row.verdict = form.mode == WallMode::consistent ? *most < 1e-9 : *most < 2.0 * *least;
    row.gated = form.delta != 1e-3;
    rows.push_back(row);
    columns.push_back(column);
  }
  write_curves(request.folder, "implicit-boundary.figure-16",
               "Simple shear: error over the support's position", columns);
  return rows;
}

/// With the defaults the stiffness stays well conditioned wherever the support cuts its cells.
std::vector<VerificationRow> condition(const VerificationRequest&) {
  std::vector<VerificationRow> rows;
  double worst = 0.0;
  for (const double a : {0.0, 1e-5, 1e-3, 0.1, 1.0, 2.5, 5.0, 7.5, 9.0, 9.9, 9.999, 9.99999})
    worst = std::max(worst, shear(a, 10.0, WallMode::consistent, {}, true).condition);
  VerificationRow row;
  row.case_name = "h = 10 mm, consistent, 12 positions";
  row.quantity = "greatest condition number";
  row.computed = worst, row.gated = true, row.verdict = worst < 1e6;
  rows.push_back(row);
  // Plain conjugate gradients, which would fail on a matrix that is not positive definite.
  SolverOptions cg;
  cg.solver = SolverKind::iterative, cg.tolerance = 1e-12, cg.max_iterations = 5000;
  cg.petsc_options = "-ksp_type cg -pc_type jacobi";
  double error = 0.0;
  for (const double a : {0.0, 1e-3, 5.0, 9.999})
    error = std::max(error, shear(a, 10.0, WallMode::consistent, {}, false, cg).error);
  row = {};
  row.case_name = "h = 10 mm, consistent, conjugate gradients, 4 positions";
  row.quantity = "greatest error of the shear stress";
  row.reference = "exact", row.expected = 0.0, row.computed = error;
  row.tolerance = 1e-6, row.gated = true;
  rows.push_back(row);
  return rows;
}

}  // namespace

std::vector<VerificationTable> simple_shear_tables() {
  return {
      {"implicit-boundary.figure-16", "Simple shear: error over the support's position", figure_16, false},
      {"implicit-boundary.condition", "Condition numbers over the support's position", condition, false}};
}

}  // namespace wisp
