// Sections 5.5 and 5.6 of Cortis, Coombs and Augarde 2018: a rough footing pushed into an elastic block, and
// an elastic block pushed through a funnel. What the figures do not give is chosen here: the footing is half
// of one 2 m wide with its axis at x = 0, on a smooth box; the funnel narrows from 48 to 36 mm over 80 mm.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "verification/implicit_boundary/list.h"
#include "verification/implicit_boundary/square.h"
#include "verification/published.h"

namespace wisp {

namespace {
using namespace implicit_boundary_paper;

/// What a run of several steps is judged by.
struct Watch {
  int steps = 0;
  int wrong = 0;         ///< points behind a wall, over all steps
  double deepest = 0.0;  ///< how far, in the body's units
  double jump = 0.0;     ///< greatest change of the increment of a reaction over the last reaction
  std::vector<double> push;
  std::string failure;
  FigureColumn x{"x", {}}, y{"y", {}}, value{"displacement", {}}, panel{"step", {}};
};

template <class AtStep>
Watch run(const ModelOptions& o, int steps, std::size_t driver, int direction, AtStep&& at_step) {
  Watch watch;
  Model<2> model(o);
  QuasiStaticOptions stage;
  stage.steps = steps, stage.max_iterations = 20;
  Implicit<2> analysis(model, stage);
  try {
    for (int step = 1; step <= steps; ++step) {
      analysis.step(analysis.time_step());
      watch.steps = step;
      watch.push.push_back(model.reactions[driver][direction]);
      const auto& points = model.bodies.front().points;
      for_each<Wall, 2>(model.boundaries, [&](const Wall<2>& wall, std::size_t) {
        for (const auto& x : points.position) {
          const auto d = wall.shape().signed_distance(wall.motion().rest(x, model.time));
          if (d.beyond || d.distance >= 0.0) continue;
          ++watch.wrong, watch.deepest = std::max(watch.deepest, -d.distance);
        }
      });
      if (!at_step(step)) continue;
      for (std::size_t p = 0; p < points.position.size(); ++p) {
        watch.x.values.push_back(points.position[p][0]), watch.y.values.push_back(points.position[p][1]);
        watch.value.values.push_back(points.displacement[p][direction]), watch.panel.values.push_back(step);
      }
    }
  } catch (const RunError& error) {
    watch.failure = error.what();
  }
  for (std::size_t k = 2; k < watch.push.size(); ++k)
    watch.jump = std::max(watch.jump, std::abs(watch.push[k] - 2.0 * watch.push[k - 1] + watch.push[k - 2]) /
                                          std::abs(watch.push.back()));
  return watch;
}

void add_line(ModelOptions& o, const char* name, std::vector<std::vector<double>> vertices, WallKind kind,
              WallMode mode) {
  WallOptions wall;
  wall.label = name, wall.kind = kind, wall.mode = mode;
  PolylineWall line;
  line.vertices = std::move(vertices);
  wall.shape = line;
  o.boundaries.push_back(wall);
}

template <class Law>
void add_body(ModelOptions& o, const Box& box, double young) {
  BodyOptions body;
  body.label = "body", body.shape = box, body.sampling.points_per_cell = 2;
  Law law;
  law.young_modulus = young, law.poisson_ratio = poisson_ratio, law.density = 1.0;
  body.material = law;
  o.bodies = {body};
  o.basis = LinearOptions{};
  o.solver.solver = SolverKind::direct;
}

void push_last(ModelOptions& o, double x, double y) {
  auto& wall = std::get<WallOptions>(o.boundaries.back());
  const auto ramp = [](double end) {
    Curve c;
    c.times = {0.0, 1.0}, c.values = {0.0, end};
    return c;
  };
  wall.motion = RigidMotionOptions{};
  wall.motion->displacement = {ramp(x), ramp(y)};
}

ModelOptions footing(bool finite, WallMode mode) {
  ModelOptions o;
  o.grid.lower = {-0.4, -0.4}, o.grid.upper = {3.4, 5.0}, o.grid.cells = {19, 27};
  const Box box{{0.0, 0.0}, {3.0, 3.0}};
  if (finite)
    add_body<Hencky>(o, box, 1e9), o.basis = GimpOptions{};
  else
    add_body<LinearElastic>(o, box, 1e9);
  add_line(o, "axis", {{0.0, 5.0}, {0.0, 0.0}}, WallKind::roller, mode);
  add_line(o, "base", {{0.0, 0.0}, {3.0, 0.0}}, WallKind::roller, mode);
  add_line(o, "side", {{3.0, 0.0}, {3.0, 5.0}}, WallKind::roller, mode);
  add_line(o, "footing", {{1.0, 4.9}, {1.0, 3.0}, {0.0, 3.0}}, WallKind::fixed, mode);
  push_last(o, 0.0, -1.0);
  return o;
}

/// Height of the funnel (mm).
double funnel_height(double x) {
  const double s = std::clamp((x - 40.0) / 80.0, 0.0, 1.0);
  return 36.0 + 12.0 * 0.5 * (1.0 - std::cos(std::numbers::pi * s));
}

/// The block is pushed to the left by 72 mm.
ModelOptions funnel(bool finite, WallMode mode) {
  ModelOptions o;
  o.grid.lower = {-24.0, -8.0}, o.grid.upper = {208.0, 64.0}, o.grid.cells = {58, 18};
  const Box box{{100.0, 0.0}, {200.0, 48.0}};
  if (finite)
    add_body<Hencky>(o, box, young_modulus);
  else
    add_body<LinearElastic>(o, box, young_modulus);
  // The part of the block that stands in the narrowing already is cut.
  std::vector<std::vector<double>> line;
  for (int k = 0; k <= 58; ++k) line.push_back({204.0 - 4.0 * k, funnel_height(204.0 - 4.0 * k)});
  Polygon outline;
  outline.vertices = {{100.0, 0.0}, {200.0, 0.0}};
  for (const auto& v : line)
    if (v[0] <= 200.0 && v[0] >= 100.0) outline.vertices.push_back(v);
  o.bodies.front().shape = outline, o.bodies.front().sampling.clip = true;
  add_line(o, "base", {{-24.0, 0.0}, {204.0, 0.0}}, WallKind::roller, mode);
  add_line(o, "roof", line, WallKind::roller, mode);
  add_line(o, "press", {{200.0, 0.0}, {200.0, 48.0}}, WallKind::roller, mode);
  push_last(o, -72.0, 0.0);
  return o;
}

void report(const std::string& name, const Watch& watch, int steps, bool gated,
            std::vector<VerificationRow>& rows) {
  const auto add = [&](const char* quantity, double value, bool verdict) {
    VerificationRow row;
    row.case_name = name, row.quantity = quantity, row.computed = value, row.gated = gated;
    row.verdict = verdict;
    rows.push_back(row);
  };
  add("steps done", watch.steps, watch.steps == steps);
  add("points behind a wall, all steps", watch.wrong, watch.wrong == 0);
  add("deepest of them, in the units of the case", watch.deepest, true);
  add("greatest jump of the push's increment over the last push", watch.jump, watch.jump < 0.2);
}

std::vector<VerificationRow> figure_22(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  struct Form {
    const char* name;
    bool finite;
    WallMode mode;
  };
  for (const Form& form : {Form{"small strain, literal", false, WallMode::literal},
                           Form{"small strain, consistent", false, WallMode::consistent},
                           Form{"finite deformation, consistent", true, WallMode::consistent}}) {
    const int steps = form.finite ? 40 : 20;
    const int scale = steps / 20;
    const Watch watch = run(footing(form.finite, form.mode), steps, 3, 1, [&](int step) {
      return step == 2 * scale || step == 10 * scale || step == 15 * scale || step == steps;
    });
    report(fmt::format("footing, {}, {} steps", form.name, steps), watch, steps,
           form.mode == WallMode::consistent, rows);
    if (form.mode == WallMode::literal) continue;
    const std::string file =
        form.finite ? "implicit-boundary.figure-22-finite" : "implicit-boundary.figure-22";
    write_points(request.folder, file, "Footing: displacement along y [m]",
                 {watch.x, watch.y, watch.value, watch.panel});
    FigureColumn depth{"penetration [m]", {}}, push{"force on the footing [N/m]", watch.push};
    for (std::size_t k = 1; k <= watch.push.size(); ++k)
      depth.values.push_back(static_cast<double>(k) / steps), push.values[k - 1] *= -1.0;
    write_curves(request.folder, file + "-force", "Footing: force over penetration", {depth, push});
  }
  return rows;
}

/// In the paper's steps, a cell each, a point or two may cross the curved roof: within a step it is its
/// chord.
std::vector<VerificationRow> figure_23(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  struct Form {
    const char* name;
    WallMode mode;
    int steps;
    bool gated, finite;
  };
  for (const Form& form : {Form{"literal", WallMode::literal, 18, false, false},
                           Form{"consistent", WallMode::consistent, 18, false, false},
                           Form{"consistent", WallMode::consistent, 36, true, false},
                           Form{"consistent, finite deformation", WallMode::consistent, 36, false, true}}) {
    const Watch watch = run(funnel(form.finite, form.mode), form.steps, 2, 0,
                            [&](int step) { return step % (form.steps / 6) == 0; });
    report(fmt::format("funnel, {}, {} steps of {:g} cell", form.name, form.steps, 18.0 / form.steps), watch,
           form.steps, form.gated, rows);
    if (!form.gated) continue;
    write_points(request.folder, "implicit-boundary.figure-23", "Funnel: displacement along x [mm]",
                 {watch.x, watch.y, watch.value, watch.panel});
  }
  return rows;
}

}  // namespace

std::vector<VerificationTable> penetration_tables() {
  return {{"implicit-boundary.figure-22", "Rough footing pushed into an elastic block", figure_22, false},
          {"implicit-boundary.figure-23", "Elastic block pushed through a funnel", figure_23, false}};
}

}  // namespace wisp
