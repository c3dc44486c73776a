// Walls in explicit dynamics against closed forms: beyond the paper, whose walls are implicit.
#include <cmath>

#include "verification/implicit_boundary/explicit_cases.h"
#include "verification/implicit_boundary/list.h"

namespace wisp {

namespace {

using namespace explicit_walls;
using Rows = std::vector<VerificationRow>;

/// Both kinds of functions on squares, both schemes, several offsets of the wall in its cell.
std::vector<Variant> variants(const VerificationRequest& request) {
  std::vector<Variant> all;
  for (const Functions functions : {Functions::linear, Functions::gimp})
    for (const StressUpdate update : {StressUpdate::usl, StressUpdate::musl})
      for (const double offset :
           request.full ? std::vector{0.0, 0.2, 0.4, 0.6, 0.8} : std::vector{0.0, 0.35, 0.7})
        all.push_back({functions, update, false, offset});
  return all;
}

/// Both kinds of functions on triangles.
std::vector<Variant> triangle_variants() {
  std::vector<Variant> all;
  for (const Functions functions : {Functions::linear_triangles, Functions::powell_sabin})
    for (const StressUpdate update : {StressUpdate::usl, StressUpdate::musl})
      for (const double offset : {0.0, 0.35, 0.7}) all.push_back({functions, update, false, offset});
  return all;
}

std::vector<Variant> consistent_variants() {
  std::vector<Variant> all;
  for (const StressUpdate update : {StressUpdate::usl, StressUpdate::musl})
    for (const double offset : {0.0, 0.35}) all.push_back({Functions::gimp, update, true, offset});
  return all;
}

/// A ratio that is one exactly.
VerificationRow ratio(const std::string& name, const char* quantity, double value, double tolerance) {
  VerificationRow row;
  row.case_name = name, row.quantity = quantity;
  row.computed = value, row.reference = "exact", row.expected = 1.0, row.tolerance = tolerance,
  row.gated = true;
  return row;
}

/// A number with a bound.
VerificationRow below(const std::string& name, const char* quantity, double value, double most) {
  VerificationRow row;
  row.case_name = name, row.quantity = quantity;
  row.computed = value, row.reference = "exact", row.gated = true, row.verdict = value <= most;
  return row;
}

VerificationRow shown(const std::string& name, const char* quantity, double value) {
  VerificationRow row;
  row.case_name = name, row.quantity = quantity, row.computed = value;
  return row;
}

Rows incline(const std::vector<Variant>& list) {
  Rows rows;
  for (const Variant& v : list) {
    const Slide smooth = slide(v, 0.0), rough = slide(v, 0.3);
    const Stick stuck = stick(v);
    rows.push_back(ratio(v.name(), "acceleration without friction, over exact", smooth.acceleration, 0.005));
    rows.push_back(ratio(v.name(), "acceleration with friction 0.3, over exact", rough.acceleration, 0.005));
    rows.push_back(below(v.name(), "friction 0.7: creep [h/s], at most 1e-3", stuck.creep, 1e-3));
    rows.push_back(below(v.name(), "friction 0.7: lasting [h], at most 0.01", stuck.lasting, 0.01));
    rows.push_back(below(v.name(), "momentum less impulses, over momentum, at most 1e-12",
                         std::max(smooth.imbalance, rough.imbalance), 1e-12));
  }
  return rows;
}

Rows resting(const std::vector<Variant>& list) {
  Rows rows;
  for (const Variant& v : list) {
    const Rest r = rest(v);
    rows.push_back(below(v.name(), "drift in 1 s [h], at most 0.005", r.drift, 0.005));
    rows.push_back(
        below(v.name(), "distance of the lowest point in 1 s [h], at most 0.005", r.lowest, 0.005));
    rows.push_back(below(v.name(), "rise under sudden gravity [h], at most 0.005", r.jump, 0.005));
    rows.push_back(ratio(v.name(), "mean force over weight", r.force, 0.005));
  }
  return rows;
}

Rows rebounding(const std::vector<Variant>& list) {
  Rows rows;
  for (const Variant& v : list) {
    Variant fitted = v;
    fitted.offset = 0.0, fitted.update = StressUpdate::musl;  // USL and linear functions fail there
    const double embedded = rebound(v, 20.0, 12);
    VerificationRow row = shown(v.name(), "speed after the impact over that on a body-fitted wall, 12 cells",
                                embedded / rebound(fitted, -1.0, 12));
    row.expected = 1.0, row.reference = "converged", row.tolerance = 0.12, row.gated = true;
    rows.push_back(row);
    rows.push_back(shown(v.name(), "the same, 6 cells", rebound(v, 20.0, 6) / rebound(fitted, -1.0, 6)));
  }
  return rows;
}

Rows pushing(const std::vector<Variant>& list) {
  Rows rows;
  for (const Variant& v : list)
    rows.push_back(ratio(v.name(), "force of the wall over mass times acceleration", push(v), 0.01));
  return rows;
}

Rows cornered(const std::vector<Variant>& list) {
  Rows rows;
  for (const Variant& v : list) {
    const Corner c = corner(v);
    rows.push_back(ratio(v.name(), "force of the floor over exact", c.floor, 0.005));
    rows.push_back(ratio(v.name(), "force of the side over exact", c.side, 0.005));
  }
  return rows;
}

Rows rolling(const std::vector<Variant>& list) {
  Rows rows;
  for (const Variant& v : list)
    for (const double friction : {1.0, 0.3}) {
      const Roll r = roll(v, friction);
      const bool rolls = friction == 1.0;
      rows.push_back(
          ratio(v.name(), rolls ? "rolling: way over exact" : "sliding: way over exact", r.way, 0.015));
      // Not gated: friction acts ahead of the disc's foot (docs/theory/walls-explicit.md, limits).
      VerificationRow spin =
          shown(v.name(), rolls ? "rolling: spin over exact" : "sliding: spin over exact", r.spin);
      spin.expected = 1.0, spin.reference = "exact";
      rows.push_back(spin);
    }
  return rows;
}

Rows time_steps(const std::vector<Variant>& list) {
  Rows rows;
  for (const Variant& v : list) {
    const double free = critical_number(v, false), walled = critical_number(v, true);
    rows.push_back(shown(v.name(), "critical Courant number of the free block", free));
    rows.push_back(shown(v.name(), "critical Courant number beside the wall", walled));
    VerificationRow row =
        shown(v.name(), "critical step over that of the free block, at least 0.9 (GIMP)", walled / free);
    row.gated = v.gimp(), row.verdict = walled >= 0.9 * free;
    rows.push_back(row);
  }
  return rows;
}

using Measure = Rows (*)(const std::vector<Variant>&);

VerificationTable table(const char* id, const char* summary, Measure measure) {
  return {std::string("implicit-boundary.explicit-") + id, summary,
          [measure](const VerificationRequest& request) { return measure(variants(request)); }};
}

}  // namespace

std::vector<VerificationTable> explicit_wall_tables() {
  std::vector<VerificationTable> all{
      table("incline", "block on an embedded 30 degree incline: sliding, sticking, momentum", incline),
      table("rest", "block at rest on an inclined wall", resting),
      table("rebound", "block that hits an inclined wall, against a body-fitted one", rebounding),
      table("push", "wall that pushes a block with constant acceleration", pushing),
      table("corner", "block in the corner of two inclined walls", cornered),
      table("disc", "disc that rolls or slides down 60 degrees", rolling),
      table("time-step", "critical time step beside a wall", time_steps)};
  all.push_back({"implicit-boundary.explicit-consistent",
                 "the same walls with the consistent, Ghost-stabilised mass", [](const VerificationRequest&) {
                   const auto list = consistent_variants();
                   Rows rows = incline(list);
                   for (const Measure measure : {pushing, cornered, rolling})
                     for (auto& row : measure(list)) rows.push_back(row);
                   return rows;
                 }});
  all.push_back({"implicit-boundary.explicit-triangles",
                 "the same walls on triangulations, linear functions and Powell-Sabin splines",
                 [](const VerificationRequest&) {
                   const auto list = triangle_variants();
                   Rows rows = incline(list);
                   for (const Measure measure : {resting, pushing, cornered, time_steps})
                     for (auto& row : measure(list)) rows.push_back(row);
                   return rows;
                 }});
  return all;
}

}  // namespace wisp
