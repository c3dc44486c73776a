// Section 5.4 of Cortis, Coombs and Augarde 2018: a slender cantilever of 100 mm x 20 mm, clamped by a wall,
// along the grid, across it and at 45 degrees.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "verification/implicit_boundary/list.h"
#include "verification/implicit_boundary/square.h"
#include "verification/published.h"

namespace wisp {

namespace {
using namespace implicit_boundary_paper;

constexpr double length = 100.0, depth = 20.0, full_load = 0.2;  // mm, mm, N/mm2

struct Path {
  std::vector<double> load, tip;  ///< N/mm2, mm across the beam
  Solved solved;
};

/// Load steps up to the full body force; the tip is the point nearest to the middle of the free end.
Path bend(SquareCase square, int steps) {
  square.width = length, square.height = depth, square.room = 75.0;
  ModelOptions o = square_options(square);
  GravityOptions weight;
  const Vec<2> g = turn(square.angle) * Vec<2>(0.0, -full_load);
  weight.acceleration = {g[0], g[1]};
  weight.factor.times = {0.0, 1.0}, weight.factor.values = {0.0, 1.0};
  o.gravity = weight;
  add_wall(o, square, "support", {0, depth}, {0, 0}, WallKind::fixed);
  Path path;
  path.solved.model = std::make_unique<Model<2>>(o);
  QuasiStaticOptions stage;
  stage.steps = steps;
  path.solved.analysis = std::make_unique<Implicit<2>>(*path.solved.model, stage);
  const auto& points = path.solved.model->bodies.front().points;
  const Vec<2> free_end = placed(square, {length, 0.5 * depth});
  std::int64_t id = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < points.id.size(); ++p)
    if (const double d = (points.position[p] - free_end).norm(); d < nearest) nearest = d, id = points.id[p];
  try {
    for (int step = 1; step <= steps; ++step) {
      path.solved.analysis->step(path.solved.analysis->time_step());
      for (std::size_t p = 0; p < points.id.size(); ++p)
        if (points.id[p] == id)
          path.tip.push_back(-(turn(square.angle).transpose() * points.displacement[p])[1]);
      path.load.push_back(full_load * step / steps);
    }
  } catch (const RunError&) {
  }
  return path;
}

/// Without Ghost a cell that holds a corner of the body alone may carry nothing.
std::vector<VerificationRow> figure_18(const VerificationRequest& request) {
  constexpr int steps = 10;
  std::vector<VerificationRow> rows;
  std::vector<FigureColumn> columns(1, {"body force [N/mm2]", {}});
  for (int k = 1; k <= steps; ++k) columns[0].values.push_back(full_load * k / steps);
  double upright = 0.0;
  for (const double ghost : {3e-2, 0.0})
    for (const double angle : {0.0, 45.0, 90.0}) {
      SquareCase square;
      square.angle = angle, square.h = 2.0, square.points = request.full ? 10 : 5, square.ghost = ghost;
      Path path = bend(square, steps);
      VerificationRow row;
      row.case_name = fmt::format("{:g} degrees, {}", angle, ghost > 0 ? "Ghost" : "no Ghost");
      row.quantity = "deflection at full load [mm]";
      row.computed = path.tip.size() == steps ? path.tip.back() : std::numeric_limits<double>::quiet_NaN();
      if (ghost > 0 && angle == 0.0) upright = row.computed;
      if (ghost > 0 && angle != 0.0) {
        row.reference = "converged", row.expected = upright;
        // The edges cut their cells elsewhere at every angle, so only discretisation makes a difference.
        row.tolerance = 0.01, row.gated = true;
      }
      rows.push_back(row);
      path.tip.resize(steps, std::numeric_limits<double>::quiet_NaN());
      columns.push_back({row.case_name, path.tip});
    }
  write_curves(request.folder, "implicit-boundary.figure-18", "Cantilever: deflection of the tip [mm]",
               columns);
  return rows;
}

std::vector<VerificationRow> figure_19(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  FigureColumn ratio{"depth over h", {}}, off{"difference of 45 and 90 degrees", {}};
  for (const double h : {5.0, 2.5, 1.25}) {
    SquareCase square;
    square.h = h, square.points = 4, square.angle = 90.0;
    const double upright = bend(square, 5).tip.back();
    square.angle = 45.0;
    ratio.values.push_back(depth / h);
    off.values.push_back(std::abs(bend(square, 5).tip.back() / upright - 1.0));
    VerificationRow row;
    row.case_name = fmt::format("h = {:g} mm", h);
    row.quantity = off.title;
    row.computed = off.values.back();
    if (off.values.size() > 1)
      row.gated = true, row.verdict = off.values.back() < off.values[off.values.size() - 2];
    rows.push_back(row);
  }
  write_curves(request.folder, "implicit-boundary.figure-19", "Cantilever: 45 against 90 degrees",
               {ratio, off});
  return rows;
}

/// Stresses near the support in the beam's axes; data and one picture a component.
std::vector<VerificationRow> figure_21(const VerificationRequest& request) {
  SquareCase square;
  square.angle = 90.0, square.h = 1.0, square.points = request.full ? 5 : 3;
  const Path path = bend(square, 5);
  const auto& body = path.solved.model->bodies.front();
  FigureColumn x{"along [mm]", {}}, y{"across [mm]", {}};
  std::vector<FigureColumn> stress{{"sigma_xx [MPa]", {}}, {"sigma_yy [MPa]", {}}, {"sigma_xy [MPa]", {}}};
  const Mat<2> back = turn(square.angle).transpose();
  for_each_state<2>(body, [&](int p, const auto&, const auto& state) {
    const auto k = static_cast<std::size_t>(p);
    const Vec<2> own = back * (body.points.position[k] - body.points.displacement[k]);
    const Mat<2> sigma = back * matrix<2>(state.stress) * back.transpose();
    if (own[0] > 20.0) return;
    x.values.push_back(own[0]), y.values.push_back(own[1]);
    stress[0].values.push_back(sigma(0, 0)), stress[1].values.push_back(sigma(1, 1));
    stress[2].values.push_back(sigma(0, 1));
  });
  const char* names[] = {"xx", "yy", "xy"};
  for (std::size_t k = 0; k < 3; ++k)
    write_points(request.folder, std::string("implicit-boundary.figure-21-") + names[k],
                 "Cantilever: stress near the support", {x, y, stress[k]});
  VerificationRow row;
  row.case_name = "90 degrees, h = 1 mm";
  row.quantity = "wall's force across the beam [N/mm]";
  row.reference = "exact", row.expected = full_load * length * depth;
  row.computed = (back * path.solved.model->reactions.front())[1];
  row.tolerance = 1e-5, row.gated = true;
  return {row};
}

}  // namespace

std::vector<VerificationTable> cantilever_tables() {
  return {
      {"implicit-boundary.figure-18", "Cantilever: load and deflection at three angles", figure_18, false},
      {"implicit-boundary.figure-19", "Cantilever: 45 against 90 degrees over the grid", figure_19, false},
      {"implicit-boundary.figure-21", "Cantilever: stresses near the support", figure_21, false}};
}

}  // namespace wisp
