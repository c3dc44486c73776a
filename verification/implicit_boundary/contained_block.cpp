// Section 5.1 of Cortis, Coombs and Augarde 2018: a block compressed by 1 mm between rollers, inclined to the
// grid.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/spectra.h"
#include "core/error.h"
#include "verification/implicit_boundary/list.h"
#include "verification/implicit_boundary/square.h"
#include "verification/published.h"

namespace wisp {

namespace {
using namespace implicit_boundary_paper;

/// Errors over the points, eq. 29 and 30, stresses in the axes of the block.
struct Errors {
  double displacement = 0.0, stress = 0.0;
  Vec<3> mean_stress = Vec<3>::Zero();  ///< MPa: along the push, across it, shear
  double worst_displacement = 0.0;      ///< mm
  double condition = 0.0;
  FigureColumn x{"x [mm]", {}}, y{"y [mm]", {}}, off{"|u - u_exact| [mm]", {}},
      stress_off{"|sigma_xx - exact| [MPa]", {}};
};

Elasticity elastic() { return Elasticity::from(young_modulus, poisson_ratio); }

Errors compress(const SquareCase& square, bool condition = false) {
  ModelOptions o = square_options(square);
  add_wall(o, square, "left", {0, side}, {0, 0}, WallKind::roller);
  add_wall(o, square, "base", {0, 0}, {side, 0}, WallKind::roller);
  add_wall(o, square, "top", {side, side}, {0, side}, WallKind::roller);
  WallOptions& press = add_wall(o, square, "press", {side, 0}, {side, side}, WallKind::roller);
  Curve push;  // into the solid is the wall's first axis
  push.times = {0.0, 1.0}, push.values = {0.0, 1.0};
  press.displacement = {push, Curve(0.0)};
  const Solved solved = solve(o);

  Errors e;
  const Mat<2> back = turn(square.angle).transpose();
  const double exact = -elastic().p_wave_modulus() / side;
  double volume = 0.0;
  const auto& body = solved.model->bodies.front();
  for_each_state<2>(body, [&](int p, const auto&, const auto& state) {
    const auto k = static_cast<std::size_t>(p);
    const double v = body.points.volume[k];
    const Vec<2> start = body.points.position[k] - body.points.displacement[k];
    const Vec<2> own = square.pivot + back * (start - square.pivot);
    const Vec<2> u = back * body.points.displacement[k], u_exact(-own[0] / side, 0.0);
    const Mat<2> sigma = back * matrix<2>(state.stress) * back.transpose();
    e.displacement += v * (u - u_exact).norm() / u_exact.norm();
    e.stress += v * std::abs((sigma(0, 0) - exact) / exact);
    e.mean_stress += v * Vec<3>(sigma(0, 0), sigma(1, 1), sigma(0, 1));
    e.worst_displacement = std::max(e.worst_displacement, (u - u_exact).norm());
    volume += v;
    e.x.values.push_back(start[0]), e.y.values.push_back(start[1]);
    e.off.values.push_back((u - u_exact).norm());
    e.stress_off.values.push_back(std::abs(sigma(0, 0) - exact));
  });
  e.displacement /= volume, e.stress /= volume, e.mean_stress /= volume;
  if (condition) e.condition = condition_number(solved.analysis->stiffness(), solved.analysis->unknowns());
  return e;
}

constexpr double angles[] = {0.0, 45.0, 30.0, 90.0};

SquareCase literal(double angle, double h, double delta) {
  SquareCase s;
  s.angle = angle, s.h = h, s.mode = WallMode::literal, s.delta = delta;
  return s;
}

std::string at_angle(double angle) { return fmt::format("{:g} degrees", angle); }

/// Normal stresses at every inclination, both forms.
std::vector<VerificationRow> stresses(const VerificationRequest&) {
  std::vector<VerificationRow> rows;
  const Elasticity c = elastic();
  const Vec<3> exact(-c.p_wave_modulus() / side, -c.lambda / side, 0.0);
  for (const double angle : angles)
    for (const bool is_literal : {false, true}) {
      SquareCase square = literal(angle, 10.0, 1e-6);
      if (!is_literal) square.mode = WallMode::consistent, square.delta = {};
      const Errors e = compress(square);
      const char* names[3] = {"sigma_xx [MPa]", "sigma_yy [MPa]", "sigma_xy [MPa]"};
      for (int k = 0; k < 3; ++k) {
        VerificationRow row;
        row.case_name = at_angle(angle) + (is_literal ? ", literal" : ", consistent");
        row.quantity = names[k];
        row.published = k == 0 ? -13.46 : k == 1 ? -5.77 : 0.0;
        row.reference = "exact", row.expected = exact[k], row.computed = e.mean_stress[k];
        row.tolerance = is_literal ? 1e-6 : 1e-9, row.gated = true;
        rows.push_back(row);
      }
    }
  return rows;
}

/// The literal form's error follows from the band alone, r_sigma = (3/4) delta/L; the consistent form has
/// none on linear fields.
std::vector<VerificationRow> law(const VerificationRequest&) {
  std::vector<VerificationRow> rows;
  for (const double angle : angles) {
    for (const double ratio : {1e-2, 1e-3, 1e-4})
      for (const double h : {10.0, 5.0}) {
        const Errors e = compress(literal(angle, h, ratio));
        const double exact = -elastic().p_wave_modulus() / side, expected = 0.75 * ratio * h / side;
        VerificationRow row;
        row.case_name = fmt::format("{}, literal, h = {:g} mm, delta/h = {:g}", at_angle(angle), h, ratio);
        row.quantity = "error of the mean stress over the law";
        row.reference = "exact", row.expected = 1.0;
        row.computed = (1.0 - e.mean_stress[0] / exact) / expected;
        row.tolerance = 0.02, row.gated = true;
        rows.push_back(row);
        // The adjoint of the half weights loads the wall's cells by (3/16) delta/h of the stress, which does
        // not cancel point by point where cells are cut obliquely.
        row.quantity = "stress error (eq. 30) over the law";
        row.computed = e.stress / expected;
        row.gated = angle != 30.0 || (h == 10.0 && ratio < 1e-2);
        if (!row.gated) row.tolerance = {};
        rows.push_back(row);
      }
    for (const double ratio : {1e-1, 1e-2, 1e-3}) {
      SquareCase square;
      square.angle = angle, square.delta = ratio;
      const Errors e = compress(square);
      for (const bool of_stress : {true, false}) {
        VerificationRow row;
        row.case_name = fmt::format("{}, consistent, delta/h = {:g}", at_angle(angle), ratio);
        row.quantity = of_stress ? "stress error" : "displacement error";
        row.reference = "exact", row.expected = 0.0;
        row.computed = of_stress ? e.stress : e.displacement;
        row.tolerance = 1e-9, row.gated = true;
        rows.push_back(row);
      }
    }
  }
  return rows;
}

/// At the paper's delta = 1e-6 h rounding takes part: value, law and condition number beside the print.
std::vector<VerificationRow> table_1(const VerificationRequest&) {
  const Published published("ib-table-1");
  std::vector<VerificationRow> rows;
  std::optional<Errors> upright;
  for (const double angle : angles) {
    const Errors e = compress(literal(angle, 10.0, 1e-6), true);
    const std::string name = at_angle(angle) + ", literal, delta = 1e-6 h";
    const auto add = [&](const char* quantity, double value, const char* column) {
      VerificationRow row;
      row.case_name = name, row.quantity = quantity, row.computed = value;
      if (column) row.published = published.at({fmt::format("{:g}", angle)}, column);
      rows.push_back(row);
    };
    add("displacement error", e.displacement, "r_u");
    add("stress error", e.stress, "r_sigma_xx");
    add("law (3/4) delta/L", 0.75e-6 * 10.0 / side, nullptr);
    add("condition number", e.condition, nullptr);
    if (angle == 0.0) upright = e;
    if (angle == 90.0) {
      VerificationRow row;
      row.case_name = "0 and 90 degrees, literal, delta = 1e-6 h";
      row.quantity = "difference of the displacement errors";
      row.reference = "exact", row.expected = 0.0;
      row.computed = std::abs(e.displacement - upright->displacement);
      row.tolerance = 1e-11, row.gated = true;
      rows.push_back(row);
      row.quantity = "difference of the stress errors";
      row.computed = std::abs(e.stress - upright->stress);
      rows.push_back(row);
    }
  }
  return rows;
}

std::vector<VerificationRow> figures_7_to_9(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  int figure = 7;
  for (const double angle : {0.0, 45.0, 30.0}) {
    const Errors e = compress(literal(angle, 10.0, 1e-6));
    const std::string name = fmt::format("implicit-boundary.figure-{}", figure++);
    write_points(request.folder, name + "a", "Contained block: displacement error", {e.x, e.y, e.off});
    write_points(request.folder, name + "b", "Contained block: stress error", {e.x, e.y, e.stress_off});
    VerificationRow row;
    row.case_name = at_angle(angle) + ", literal, delta = 1e-6 h";
    row.quantity = "greatest displacement error [mm]";
    row.computed = e.worst_displacement;
    row.gated = true, row.verdict = row.computed < 6.09e-6;  // the paper's greatest
    rows.push_back(row);
  }
  return rows;
}

/// Figures 10 to 12: errors over 1/h for bands of fixed width (mm); figure 13: over delta/h at 90 degrees.
std::vector<VerificationRow> figures_10_to_13(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  int figure = 10;
  const std::vector<double> sizes{20.0, 10.0, 5.0, 2.5};
  for (const double angle : {30.0, 45.0, 90.0}) {
    FigureColumn inverse{"1/h [1/mm]", {}};
    for (const double h : sizes) inverse.values.push_back(1.0 / h);
    std::vector<FigureColumn> columns{inverse};
    for (const double delta : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
      FigureColumn column{fmt::format("delta = {:g} h", delta), {}};
      for (const double h : sizes) column.values.push_back(compress(literal(angle, h, delta)).displacement);
      columns.push_back(column);
    }
    write_curves(request.folder, fmt::format("implicit-boundary.figure-{}", figure++),
                 "Contained block, literal form: displacement error at " + at_angle(angle), columns);
  }
  FigureColumn ratio{"log10(delta/h)", {}};
  for (int k = -8; k <= 0; ++k) ratio.values.push_back(k);
  std::vector<FigureColumn> columns{ratio};
  for (const double h : sizes) {
    FigureColumn column{fmt::format("h = {:g} mm", h), {}};
    for (const double k : ratio.values)
      column.values.push_back(compress(literal(90.0, h, std::pow(10.0, k))).displacement);
    columns.push_back(column);
    VerificationRow row;  // "decreasing delta/h decreases the error"
    row.case_name = fmt::format("90 degrees, h = {:g} mm", h);
    row.quantity = "error at delta/h = 1e-2 over that at 1e-4";
    row.reference = "exact", row.expected = 100.0, row.computed = column.values[6] / column.values[4];
    row.tolerance = 0.05, row.gated = true;
    rows.push_back(row);
  }
  write_curves(request.folder, "implicit-boundary.figure-13",
               "Contained block, literal form: displacement error over the band", columns);
  return rows;
}

}  // namespace

std::vector<VerificationTable> contained_block_tables() {
  return {
      {"implicit-boundary.contained-block", "Contained block: stresses at every inclination", stresses,
       false},
      {"implicit-boundary.band-law", "Contained block: the error that the band makes", law, false},
      {"implicit-boundary.table-1", "Contained block: errors at delta = 1e-6 h", table_1, false},
      {"implicit-boundary.figures-7-to-9", "Contained block: where the errors are", figures_7_to_9, false},
      {"implicit-boundary.figures-10-to-13", "Contained block: errors over grid and band", figures_10_to_13,
       false}};
}

}  // namespace wisp
