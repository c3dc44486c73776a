// The soil column of the thesis: figures 4.10, 4.11, 4.13 and chapter 5, figures 5.3 to 5.6 and 5.8.
#include <cmath>

#include "verification/powell_sabin/dynamics.h"
#include "verification/powell_sabin/exact.h"
#include "verification/powell_sabin/histories.h"
#include "verification/published.h"

namespace wisp {

namespace {
using namespace powell_sabin;

SoilColumn exact_column(const StripCase& s) { return {s.density, s.young_modulus, s.gravity, s.length}; }

Reference exact_reference(const SoilColumn& column, const StripRun& run) {
  Reference r{run.time, {}, {}};
  for (const double t : run.time)
    r.displacement.push_back(column.displacement(run.middle, t)),
        r.velocity.push_back(column.velocity(run.middle, t));
  return r;
}

/// Free fall for a quarter of a period: what velocity errors are measured with.
double speed_scale(const StripCase& s) { return s.gravity * 0.25 * exact_column(s).period(); }

void add_errors(const std::string& name, const StripCase& s, const StripRun& run, const Reference& reference,
                std::vector<VerificationRow>& rows) {
  if (!run.stable()) {
    rows.push_back(number(name, "became unstable at (s)", run.end));
    return;
  }
  rows.push_back(
      number(name, "rms velocity error / (g T/4)", rms_velocity_error(run, reference) / speed_scale(s)));
  rows.push_back(number(name, "rms displacement error (m)", rms_error(run, reference)));
  rows.push_back(number(name, "largest displacement error (m)", largest_error(run, reference)));
}

std::vector<VerificationRow> figure_4_10(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  StripCase s = small_column();
  s.points = 8, s.points_across = 6, s.dt = 1e-4, s.duration = 2.0, s.record_every = 20;
  s.splines = false, s.blocks = 16, s.blocks_across = 2;
  const StripRun linear = run_strip(s);
  // The reference in large deformation, which the thesis's small one drifts from.
  const Reference reference = ulfem_reference(s, linear.middle, linear.time);
  add_errors("Lagrange, 2x16 blocks", s, linear, reference, rows);
  s.splines = true, s.blocks = 8, s.blocks_across = 1;
  const StripRun spline = run_strip(s);
  add_errors("Powell-Sabin, 1x8 blocks", s, spline, ulfem_reference(s, spline.middle, spline.time), rows);
  const double ratio = rms_velocity_error(linear, reference) / rms_velocity_error(spline, reference);
  rows.push_back(bound("Lagrange over Powell-Sabin", "ratio of velocity errors", ratio, ratio > 3.0));
  const Reference exact = exact_reference(exact_column(s), spline);
  rows.push_back(number("ULFEM against the exact small deformation", "rms displacement difference (m)", [&] {
    double sum = 0.0;
    for (std::size_t i = 0; i < exact.time.size(); ++i)
      sum += std::pow(exact.displacement[i] - reference.displacement[i], 2);
    return std::sqrt(sum / static_cast<double>(exact.time.size()));
  }()));
  write_history(request, "powell-sabin.figure-4-10", "Soil column, small deformation",
                {{"Lagrange, 2x16 blocks", linear}, {"Powell-Sabin, 1x8 blocks", spline}}, exact, "exact");
  return rows;
}

std::vector<VerificationRow> figure_4_11(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  StripCase s = small_column();
  s.points = 8, s.points_across = 6, s.dt = 1e-4, s.duration = 2.0, s.record_every = 20;
  s.splines = false, s.blocks = 24, s.blocks_across = 2;
  const StripRun linear = run_strip(s);
  const Reference reference = ulfem_reference(s, linear.middle, linear.time);
  add_errors("Lagrange, 2x24 blocks", s, linear, reference, rows);
  s.splines = true, s.blocks = 16;
  const StripRun spline = run_strip(s);
  add_errors("Powell-Sabin, 2x16 blocks, no treatment (thesis: points out of bounds at 0.031 s)", s, spline,
             ulfem_reference(s, spline.middle, spline.time), rows);
  write_history(request, "powell-sabin.figure-4-11", "Soil column, small deformation, Lagrange 2x24",
                {{"Lagrange, 2x24 blocks", linear}}, exact_reference(exact_column(s), linear), "exact");
  return rows;
}

std::vector<VerificationRow> figure_4_13(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  StripCase s = large_column();
  s.blocks = 4, s.points = 18, s.points_across = 16, s.dt = 1e-4, s.duration = 1.0;
  const StripRun spline = run_strip(s);
  const Reference reference = ulfem_reference(s, spline.middle, spline.time);
  s.splines = false;
  const StripRun linear = run_strip(s);
  add_errors("Lagrange, 1x4 blocks", s, linear, reference, rows);
  add_errors("Powell-Sabin, 1x4 blocks", s, spline, reference, rows);
  const double ratio = rms_velocity_error(linear, reference) / rms_velocity_error(spline, reference);
  rows.push_back(bound("Lagrange over Powell-Sabin", "ratio of velocity errors", ratio, ratio > 2.0));
  write_history(request, "powell-sabin.figure-4-13", "Soil column, large deformation",
                {{"Lagrange, 1x4 blocks", linear}, {"Powell-Sabin, 1x4 blocks", spline}}, reference, "ULFEM");
  return rows;
}

/// The column of chapter 5 on a grid of blocks with an empty row above.
StripCase chapter_5(int across, int blocks, int points_across, int points) {
  StripCase s = large_column();
  s.blocks_across = across, s.blocks = blocks, s.points_across = points_across, s.points = points;
  s.empty_blocks = 1, s.dt = 1e-4, s.duration = 1.0;
  return s;
}

std::vector<VerificationRow> figure_5(const VerificationRequest& request, const std::string& id, Mass mass,
                                      double threshold, bool is_stable_on_1x8) {
  std::vector<VerificationRow> rows;
  std::vector<std::pair<std::string, StripRun>> runs;
  Reference reference;
  for (const StripCase& grid : {chapter_5(1, 4, 16, 18), chapter_5(1, 8, 12, 12), chapter_5(2, 16, 8, 8)}) {
    StripCase s = grid;
    s.mass = mass, s.deactivate_below = threshold;
    const StripRun run = run_strip(s);
    const std::string name = fmt::format("{}x{} blocks", s.blocks_across, s.blocks);
    const Reference own = ulfem_reference(s, run.middle, run.time);
    if (own.time.size() > reference.time.size()) reference = own;
    add_errors(name, s, run, own, rows);
    if (s.blocks == 8)
      rows.push_back(bound(name, "stable as in the thesis", run.stable(), run.stable() == is_stable_on_1x8));
    runs.emplace_back(name, run);
  }
  write_history(request, id, "Soil column, large deformation", runs, reference, "ULFEM");
  return rows;
}

std::vector<VerificationRow> figure_5_3(const VerificationRequest& request) {
  auto rows = figure_5(request, "powell-sabin.figure-5-3", Mass::consistent, 0.0, false);
  StripCase s = chapter_5(1, 8, 12, 12);
  s.duration = 0.1;
  const StripRun run = run_strip(s);
  std::vector<FigureColumn> points{{"x [m]", {}}, {"y [m]", {}}, {"speed [m/s]", {}}};
  for (std::size_t p = 0; p < run.start.size(); ++p) {
    points[0].values.push_back(run.start[p][0] + run.moved[p][0]);
    points[1].values.push_back(run.start[p][1] + run.moved[p][1]);
    points[2].values.push_back(run.point_velocity[p].norm());
  }
  write_points(request.folder, "powell-sabin.figure-5-3-points", "Soil column, 1x8 blocks, at 0.1 s", points);
  return rows;
}
std::vector<VerificationRow> figure_5_4(const VerificationRequest& request) {
  return figure_5(request, "powell-sabin.figure-5-4", Mass::consistent, 1e-2, true);
}
std::vector<VerificationRow> figure_5_5(const VerificationRequest& request) {
  return figure_5(request, "powell-sabin.figure-5-5", Mass::lumped, 0.0, true);
}
std::vector<VerificationRow> figure_5_8(const VerificationRequest& request) {
  return figure_5(request, "powell-sabin.figure-5-8", Mass::partial, 0.0, true);
}

}  // namespace

std::vector<VerificationTable> column_thesis_tables() {
  return {
      {"powell-sabin.figure-4-10", "Soil column, small deformation: splines and linear functions",
       figure_4_10, false},
      {"powell-sabin.figure-4-11", "Soil column, small deformation, finer", figure_4_11, false},
      {"powell-sabin.figure-4-13", "Soil column, large deformation", figure_4_13, false},
      {"powell-sabin.figure-5-3", "Soil column: consistent mass, no treatment", figure_5_3, false},
      {"powell-sabin.figure-5-4", "Soil column: deactivation below 0.01 kg", figure_5_4, false},
      {"powell-sabin.figure-5-5", "Soil column: lumped mass (5.5 on 1x8, 5.6 on 2x16)", figure_5_5, false},
      {"powell-sabin.figure-5-8", "Soil column: partially lumped mass", figure_5_8, false}};
}

}  // namespace wisp
