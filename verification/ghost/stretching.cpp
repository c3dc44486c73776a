// Section 5.1.2: a ghost without stiffness that expands evenly to twice its size.
#include <algorithm>
#include <cmath>

#include "analysis/explicit.h"
#include "core/error.h"
#include "verification/ghost/ghost_body.h"
#include "verification/ghost/list.h"
#include "verification/published.h"

namespace wisp {

namespace {

using namespace ghost_paper;

struct Stretch {
  FigureColumn x{"x [m]", {}}, y{"y [m]", {}}, error{"displacement error [m]", {}};
  double greatest = 0.0;     ///< displacement error at the end, m
  double whenever = 0.0;     ///< the same over all steps
  double deformation = 0.0;  ///< greatest entry of F - 2 I at the end
};

Stretch stretch(Mass mass, VelocityUpdate update) {
  constexpr int steps = 1000;
  Hencky law;
  law.density = 1000.0, law.young_modulus = 0.0, law.poisson_ratio = 0.0;
  ModelOptions options;
  options.grid = unit_grid(10);
  options.basis = GimpOptions{};
  options.bodies = {ghost_body("ghost", resolution("coarse"), 0.3, 0.3, law)};
  options.bodies[0].velocity_gradient = {{1.0, 0.0}, {0.0, 1.0}};
  options.bodies[0].velocity_centre = {0.5, 0.5};
  if (mass == Mass::consistent) options.stabilisation = mass_stabilisation(law.density);
  // The error wanted is that of the method: a direct solve leaves only rounding.
  options.solver.solver = SolverKind::direct;
  Model<2> model(options);
  ExplicitOptions run;
  run.duration = 1.0, run.steps = steps, run.mass = mass, run.velocity_update = update;
  const auto& points = model.bodies[0].points;
  // Points change their order in the run, so the exact displacement is found by their ids.
  std::vector<Vec<2>> start(points.position.size());
  for (std::size_t p = 0; p < start.size(); ++p)
    start[static_cast<std::size_t>(points.id[p])] = points.velocity[p];
  Explicit<2> analysis(model, run);
  Stretch result;
  const auto error = [&](std::size_t p) {
    return (points.displacement[p] - model.time * start[static_cast<std::size_t>(points.id[p])]).norm();
  };
  for (int i = 0; i < steps; ++i) {
    analysis.step(run.duration / steps);
    for (std::size_t p = 0; p < start.size(); ++p) result.whenever = std::max(result.whenever, error(p));
  }
  for (std::size_t p = 0; p < start.size(); ++p) {
    result.x.values.push_back(points.position[p][0]), result.y.values.push_back(points.position[p][1]);
    result.error.values.push_back(error(p));
    result.greatest = std::max(result.greatest, error(p));
    const Mat<2> rest = points.deformation_gradient[p] - 2.0 * Mat<2>::Identity();
    result.deformation = std::max(result.deformation, rest.cwiseAbs().maxCoeff());
  }
  return result;
}

std::vector<VerificationRow> figure_11(const VerificationRequest& request) {
  struct Case {
    const char *mass_name, *update_name, *file;
    Mass mass;
    VelocityUpdate update;
  };
  const Case cases[] = {{"Ghost", "FLIP", "b-flip", Mass::consistent, VelocityUpdate::flip},
                        {"Ghost", "PIC", "b-pic", Mass::consistent, VelocityUpdate::pic},
                        {"lumped", "FLIP", "c", Mass::lumped, VelocityUpdate::flip},
                        {"lumped", "PIC", "d", Mass::lumped, VelocityUpdate::pic}};
  const Published published("ghost-figure-11");
  std::vector<VerificationRow> rows;
  for (const Case& c : cases) {
    const Stretch s = stretch(c.mass, c.update);
    const std::string name = std::string(c.mass_name) + ", " + c.update_name;
    write_points(request.folder, std::string("ghost.figure-11") + c.file, "Stretched ghost: " + name,
                 {s.x, s.y, s.error});
    // Printed are the ends of the colour bars.
    VerificationRow row{name, "greatest displacement error, m",
                        published.at({c.mass_name, c.update_name}, "error"), s.greatest};
    if (c.mass == Mass::consistent) {
      row.quantity += ", all steps", row.computed = s.whenever;
      row.reference = "exact", row.expected = 0.0, row.tolerance = 1e-12, row.gated = true;
      rows.push_back(row);
      VerificationRow f{name, "greatest entry of F - 2 I", std::nullopt, s.deformation};
      f.reference = "exact", f.expected = 0.0;
      rows.push_back(f);
    } else {
      if (row.published)
        row.gated = true, row.verdict = s.greatest > *row.published / 3 && s.greatest < *row.published * 3;
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace

std::vector<VerificationTable> stretching_tables() {
  return {{"ghost.figure-11", "Stretching ghost: displacement error after doubling its size", figure_11}};
}

}  // namespace wisp
