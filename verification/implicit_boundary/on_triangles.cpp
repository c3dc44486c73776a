// The consistent form on triangulations, with linear functions and quadratic Powell-Sabin splines: the
// contained block of section 5.1 of Cortis, Coombs and Augarde 2018, rates of convergence, a thick cylinder,
// condition numbers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/spectra.h"
#include "core/error.h"
#include "verification/implicit_boundary/exact_cases.h"
#include "verification/implicit_boundary/list.h"
#include "verification/published.h"

namespace wisp {

namespace {
using namespace implicit_boundary_paper;

enum class Mesh { blocks, delaunay };
const char* name_of(Mesh mesh) { return mesh == Mesh::blocks ? "blocks of four" : "Delaunay"; }
const char* name_of(bool splines) { return splines ? "Powell-Sabin" : "linear"; }

/// Triangles instead of a structured grid: blocks of its cells, or irregular ones with the edges' length h.
/// Points integrate products of gradients exactly on what the walls leave of the triangles.
void triangulate(ModelOptions& o, Mesh mesh, bool splines, double h) {
  const auto &low = o.grid.lower, &high = o.grid.upper;
  if (mesh == Mesh::blocks) {
    TriangleBlocksOptions blocks;
    blocks.lower = low, blocks.upper = high, blocks.cells = o.grid.cells;
    o.triangulation = blocks;
  } else {
    DelaunayOptions delaunay;
    delaunay.outline.vertices = {low, {high[0], low[1]}, high, {low[0], high[1]}};
    delaunay.spacing = h, delaunay.irregularity = 0.2;
    o.triangulation = delaunay;
  }
  if (splines)
    o.basis = PowellSabinOptions{};
  else
    o.basis = LinearOptions{};
}

Sampling cut_points(bool splines) {
  Sampling s;
  s.method = splines ? SamplingMethod::gauss : SamplingMethod::cells;
  s.points_per_cell = splines ? 1 : 2, s.clip = true;
  return s;
}

ModelOptions block_options(const SquareCase& square, Mesh mesh, bool splines) {
  ModelOptions o = square_options(square);
  triangulate(o, mesh, splines, square.h);
  o.bodies.front().sampling = cut_points(splines);
  return o;
}

/// Section 5.1: stresses and the greatest errors over the points.
std::vector<VerificationRow> contained_block(const VerificationRequest&) {
  std::vector<VerificationRow> rows;
  const Elasticity c = Elasticity::from(young_modulus, poisson_ratio);
  const Vec<3> exact(-c.p_wave_modulus() / side, -c.lambda / side, 0.0);
  for (const bool splines : {false, true})
    for (const double angle : {0.0, 30.0, 45.0, 90.0}) {
      SquareCase square;
      square.angle = angle, square.h = 20.0;
      ModelOptions o = block_options(square, angle == 30.0 ? Mesh::delaunay : Mesh::blocks, splines);
      add_wall(o, square, "left", {0, side}, {0, 0}, WallKind::roller);
      add_wall(o, square, "base", {0, 0}, {side, 0}, WallKind::roller);
      add_wall(o, square, "top", {side, side}, {0, side}, WallKind::roller);
      WallOptions& press = add_wall(o, square, "press", {side, 0}, {side, side}, WallKind::roller);
      Curve push;
      push.times = {0.0, 1.0}, push.values = {0.0, 1.0};
      press.displacement = {push, Curve(0.0)};
      const Solved solved = solve(o);
      const Mat<2> back = turn(angle).transpose();
      Vec<3> mean = Vec<3>::Zero();
      double volume = 0.0, stress_error = 0.0, displacement_error = 0.0;
      const auto& body = solved.model->bodies.front();
      for_each_state<2>(body, [&](int p, const auto&, const auto& state) {
        const auto k = static_cast<std::size_t>(p);
        const Vec<2> start = body.points.position[k] - body.points.displacement[k];
        const Vec<2> own = back * start, u = back * body.points.displacement[k];
        const Mat<2> sigma = back * matrix<2>(state.stress) * back.transpose();
        const Vec<3> normal(sigma(0, 0), sigma(1, 1), sigma(0, 1));
        mean += body.points.volume[k] * normal, volume += body.points.volume[k];
        stress_error = std::max(stress_error, (normal - exact).norm() / exact.norm());
        displacement_error = std::max(displacement_error, (u - Vec<2>(-own[0] / side, 0.0)).norm());
      });
      const char* names[3] = {"sigma_xx [MPa]", "sigma_yy [MPa]", "sigma_xy [MPa]"};
      VerificationRow row;
      row.case_name = fmt::format("{:g} degrees, {}", angle, name_of(splines));
      row.reference = "exact", row.tolerance = 1e-9, row.gated = true;
      for (int k = 0; k < 3; ++k) {
        row.quantity = names[k];
        row.published = k == 0 ? -13.46 : k == 1 ? -5.77 : 0.0;
        row.expected = exact[k], row.computed = mean[k] / volume;
        rows.push_back(row);
      }
      row.published = {}, row.expected = 0.0;
      row.quantity = "greatest stress error", row.computed = stress_error;
      rows.push_back(row);
      row.quantity = "greatest displacement error [mm]", row.computed = displacement_error;
      rows.push_back(row);
    }
  return rows;
}

/// Rates of the manufactured solution: 2 of linear functions, 2.5 or better of splines, at three halvings.
std::vector<VerificationRow> rates(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  FigureColumn size{"h [mm]", {20.0, 10.0, 5.0}};
  std::vector<FigureColumn> columns{size};
  for (const bool splines : {false, true})
    for (const Mesh mesh : {Mesh::blocks, Mesh::delaunay}) {
      FigureColumn column{fmt::format("{}, {}", name_of(splines), name_of(mesh)), {}};
      for (const double h : size.values) {
        SquareCase square;
        square.angle = 20.0, square.h = h;
        column.values.push_back(manufactured_error(block_options(square, mesh, splines), square));
      }
      for (std::size_t k = 0; k < size.values.size(); ++k) {
        VerificationRow row;
        row.case_name = fmt::format("{}, h = {:g} mm", column.title, size.values[k]);
        row.quantity = "displacement error";
        row.computed = column.values[k];
        rows.push_back(row);
        if (k == 0) continue;
        row.case_name =
            fmt::format("{}, h = {:g} to {:g} mm", column.title, size.values[k - 1], size.values[k]);
        row.quantity = "rate of convergence of the displacement";
        row.reference = "exact", row.expected = splines ? 3.0 : 2.0;
        row.computed = std::log2(column.values[k - 1] / column.values[k]);
        if (k + 1 == size.values.size()) row.gated = true, row.verdict = row.computed > (splines ? 2.5 : 1.9);
        rows.push_back(row);
      }
      columns.push_back(column);
    }
  write_curves(request.folder, "implicit-boundary.triangle-rates",
               "Manufactured solution on an inclined square, triangulations", columns);
  return rows;
}

/// Gated like the linear functions of the structured grid; splines at twice the size.
std::vector<VerificationRow> cylinders(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  for (const bool splines : {false, true}) {
    FigureColumn size{"h [mm]", {}}, error{"displacement error", {}};
    for (const double k : {4.0, 2.0, 1.0}) {
      const double h = k * (splines ? 5.0 : 2.5);
      ModelOptions o;
      o.grid.lower = {-0.8 * h, -0.8 * h}, o.grid.upper = {outer_radius + h, outer_radius + h};
      triangulate(o, Mesh::delaunay, splines, h);
      const Cylinder c = solve_cylinder(o, cut_points(splines));
      VerificationRow row;
      row.case_name = fmt::format("{}, h = {:g} mm", name_of(splines), h);
      row.quantity = "pressure inside over Lame's";
      row.reference = "exact", row.expected = 1.0, row.computed = c.pressure;
      row.gated = k == 1.0;
      if (row.gated) row.tolerance = 0.01;
      rows.push_back(row);
      row.quantity = "displacement error";
      row.expected = 0.0, row.computed = c.displacement;
      if (row.gated) row.tolerance = 1e-3;
      rows.push_back(row);
      size.values.push_back(h), error.values.push_back(c.displacement);
    }
    VerificationRow rate;
    rate.case_name = fmt::format("{}, h = {:g} to {:g} mm", name_of(splines), size.values[0], size.values[2]);
    rate.quantity = "rate of convergence of the displacement";
    rate.computed = 0.5 * std::log2(error.values[0] / error.values[2]);
    rate.gated = true, rate.verdict = rate.computed > (splines ? 2.5 : 1.8);
    rows.push_back(rate);
    write_curves(
        request.folder, fmt::format("implicit-boundary.triangle-cylinder-{}", splines ? "splines" : "linear"),
        fmt::format("Thick cylinder, {}, Delaunay triangulation: displacement error", name_of(splines)),
        {size, error});
  }
  return rows;
}

struct Sheared {
  double condition = 0.0;
  double error = 0.0;  ///< greatest of the shear stress over the points
};

/// The block of section 5.3 at an angle: sheared by 10 mm between a fixed support, which lies at `place` in
/// units of h beyond a grid line, a moving end, and two sides that keep their length.
Sheared shear(Mesh mesh, double angle, double place, bool splines, const SolverOptions& solver,
              bool condition, std::optional<double> ghost = {}) {
  SquareCase square;
  square.angle = angle, square.h = 20.0, square.ghost = ghost;
  ModelOptions o = square_options(square);
  for (std::size_t d = 0; d < 2; ++d)
    o.grid.lower[d] -= place * square.h, o.grid.upper[d] -= place * square.h;
  triangulate(o, mesh, splines, square.h);
  o.bodies.front().sampling = cut_points(splines);
  o.solver = solver;
  add_wall(o, square, "support", {0, side}, {0, 0}, WallKind::fixed);
  add_wall(o, square, "base", {0, 0}, {side, 0}, WallKind::tangential);
  add_wall(o, square, "top", {side, side}, {0, side}, WallKind::tangential);
  Curve along;  // the tangent is the normal turned by 90 degrees, so against the block's own second axis
  along.times = {0.0, 1.0}, along.values = {0.0, -10.0};
  add_wall(o, square, "free end", {side, 0}, {side, side}, WallKind::prescribed).displacement = {Curve(0.0),
                                                                                                 along};
  const Solved solved = solve(o);
  const double exact = Elasticity::from(young_modulus, poisson_ratio).mu * 10.0 / side;
  const Mat<2> r = turn(angle);
  Sheared result;
  for_each_state<2>(solved.model->bodies.front(), [&](int, const auto&, const auto& state) {
    const double tau = r.col(0).dot(matrix<2>(state.stress) * r.col(1));
    result.error = std::max(result.error, std::abs(tau / exact - 1.0));
  });
  if (condition)
    result.condition = condition_number(solved.analysis->stiffness(), solved.analysis->unknowns());
  return result;
}

/// Which stop where they meet a direction of negative energy.
SolverOptions conjugate_gradients() {
  SolverOptions o;
  o.solver = SolverKind::iterative, o.max_iterations = 5000, o.tolerance = 1e-12;
  o.petsc_options = "-ksp_type cg -pc_type jacobi";
  return o;
}

/// With the defaults the stiffness stays well conditioned wherever walls and the outline cut the triangles,
/// and plain conjugate gradients find what the direct solver finds.
std::vector<VerificationRow> condition(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  SolverOptions direct;
  direct.solver = SolverKind::direct;
  FigureColumn place{
      "position of the support [h]",
      {0.0, 1e-6, 1e-4, 1e-3, 0.01, 0.05, 0.2, 0.35, 0.49, 0.499, 0.5, 0.65, 0.8, 0.95, 0.999}};
  std::vector<FigureColumn> columns{place};
  for (const bool splines : {false, true})
    for (const auto& [mesh, angle] :
         {std::pair{Mesh::blocks, 0.0}, {Mesh::blocks, 30.0}, {Mesh::delaunay, 30.0}}) {
      FigureColumn column{fmt::format("{}, {}, {:g} degrees", name_of(splines), name_of(mesh), angle), {}};
      double worst = 0.0, worst_of_cg = 0.0;
      for (const double x : place.values) {
        const Sheared s = shear(mesh, angle, x, splines, direct, true);
        column.values.push_back(s.condition), worst = std::max(worst, s.error);
        if (x == 0.0 || x == 1e-4 || x == 0.2 || x == 0.499 || x == 0.999)
          worst_of_cg =
              std::max(worst_of_cg, shear(mesh, angle, x, splines, conjugate_gradients(), false).error);
      }
      VerificationRow row;
      row.case_name = fmt::format("{}, {} positions", column.title, place.values.size());
      row.quantity = "greatest condition number";
      row.computed = *std::max_element(column.values.begin(), column.values.end());
      row.gated = true, row.verdict = row.computed < 1e6;
      rows.push_back(row);
      row = {};
      row.case_name = fmt::format("{}, {} positions", column.title, place.values.size());
      row.quantity = "greatest error of the shear stress";
      row.reference = "exact", row.expected = 0.0, row.computed = worst;
      row.tolerance = 1e-9, row.gated = true;
      rows.push_back(row);
      row.case_name = column.title + ", conjugate gradients, 5 positions";
      row.computed = worst_of_cg, row.tolerance = 1e-6;
      rows.push_back(row);
      columns.push_back(column);
    }
  write_curves(request.folder, "implicit-boundary.triangle-condition",
               "Sheared block on triangles: condition number over the support's position", columns);
  return rows;
}

/// Whether conjugate gradients find the stiffness positive at positions of a wall around the worst ones.
bool positive(bool splines, double ghost) {
  try {
    for (const double x : {1e-6, 1e-4, 1e-3, 0.005, 0.01, 0.02, 0.03, 0.0375, 0.05, 0.07, 0.1})
      shear(Mesh::blocks, 0.0, x, splines, conjugate_gradients(), false, ghost);
  } catch (const RunError&) {
    return false;
  }
  return true;
}

/// The least Ghost that keeps a wall's stiffness positive definite, as docs/theory/implicit-boundaries.md
/// derives it for the sliver that a wall leaves beside an edge: enough, and a twentieth of it is not.
std::vector<VerificationRow> ghost_bounds(const VerificationRequest&) {
  std::vector<VerificationRow> rows;
  constexpr double height = 10.0, edge = 20.0;  // mm, of triangles of a block of 20 mm
  for (const bool splines : {false, true}) {
    const double bound = splines ? 45.0 / 4.0 * std::pow(5e-2 * height / edge, 3) : 9.0 / 4.0 * 1e-2;
    for (const double share : {1.0, 0.05}) {
      VerificationRow row;
      row.case_name = fmt::format("{}, Ghost of {:g} times {:.3g}", name_of(splines), share, bound);
      row.quantity = "positive definite at 11 positions (1) or not (0)";
      row.reference = "exact", row.expected = share == 1.0 ? 1.0 : 0.0;
      row.computed = positive(splines, share * bound) ? 1.0 : 0.0;
      row.tolerance = 0.0, row.gated = true;
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace

std::vector<VerificationTable> triangle_wall_tables() {
  return {
      {"implicit-boundary.triangle-block", "Contained block on triangulations", contained_block, false},
      {"implicit-boundary.triangle-rates", "Manufactured solution on triangulations: rates", rates, false},
      {"implicit-boundary.triangle-cylinder", "Thick cylinder on a triangulation", cylinders, false},
      {"implicit-boundary.triangle-condition", "Condition numbers on triangulations", condition, false},
      {"implicit-boundary.triangle-ghost", "Least Ghost of walls on triangulations", ghost_bounds, false}};
}

}  // namespace wisp
