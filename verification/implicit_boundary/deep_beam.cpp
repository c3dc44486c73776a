// Section 5.2 of Cortis, Coombs and Augarde 2018: a deep beam under its own weight, against finite elements
// on the same grid: points at Gauss positions and conforming conditions.
#include <fmt/format.h>

#include <cmath>

#include "verification/implicit_boundary/list.h"
#include "verification/implicit_boundary/square.h"
#include "verification/published.h"

namespace wisp {

namespace {
using namespace implicit_boundary_paper;

struct Beam {
  double h = 10.0;
  int points = 2;
  bool elements = false;  ///< finite elements instead of a wall
};

/// Deflection at the free end's lower corner (mm).
double deflection(const Beam& beam) {
  SquareCase square;
  square.h = beam.h, square.points = beam.points, square.mode = WallMode::literal;
  ModelOptions o = square_options(square);
  GravityOptions weight;
  weight.acceleration = {0.0, -1.0};  // density 1: 1 N/mm2 per mm
  o.gravity = weight;
  if (beam.elements) {
    o.bodies.front().shape = Box{{0.0, 0.0}, {side, side}};
    o.bodies.front().sampling.method = SamplingMethod::gauss;
    o.bodies.front().sampling.clip = false;
    ConformingOptions support;
    support.label = "support", support.normal = "x", support.directions = {"x", "y"};
    o.boundaries.push_back(support);
  } else {
    add_wall(o, square, "support", {0, side}, {0, 0}, WallKind::fixed);
  }
  const Solved solved = solve(o);
  const auto& grid = solved.model->space->grid();
  return at_node(solved, grid.locate(0, side + 1e-6 * beam.h), grid.locate(1, 1e-6 * beam.h))[1];
}

double difference(double h, int points, double elements) {
  return std::abs(deflection({h, points, false}) / elements - 1.0);
}

std::vector<VerificationRow> table_2(const VerificationRequest& request) {
  const Published published("ib-table-2");
  std::vector<VerificationRow> rows;
  const double elements = deflection({10.0, 2, true});
  FigureColumn count{"points a cell", {}}, error{"displacement error", {}};
  for (const int m : {3, 5, 10, 15, 20, 25, 40}) {
    VerificationRow row;
    row.case_name = fmt::format("{0} x {0} points a cell", m);
    row.quantity = "deflection against finite elements";
    row.published = published.at({std::to_string(m * m)}, "error");
    row.computed = difference(10.0, m, elements);
    row.gated = true, row.tolerance = 0.01;
    if (m == 40) {  // the printed 1.0277e-5 breaks the 1/m^2 of its own column
      row.reference = "converged";
      row.expected = *published.at({"625"}, "error") * 625.0 / 1600.0;
    }
    rows.push_back(row);
    count.values.push_back(m * m), error.values.push_back(row.computed);
  }
  write_curves(request.folder, "implicit-boundary.figure-15a", "Deep beam: error over the points in a cell",
               {count, error});
  return rows;
}

std::vector<VerificationRow> table_3(const VerificationRequest& request) {
  const Published published("ib-table-3");
  std::vector<VerificationRow> rows;
  FigureColumn size{"degrees of freedom", {}}, error{"displacement error", {}};
  for (const int n : {10, 20, 50, 100}) {
    const double h = side / n;
    VerificationRow row;
    row.case_name = fmt::format("h = {:g} mm, 4 x 4 points a cell", h);
    row.quantity = "deflection against finite elements";
    row.published = published.at({std::to_string(n * n)}, "error");
    row.computed = difference(h, 4, deflection({h, 2, true}));
    row.gated = true, row.tolerance = 0.01;
    rows.push_back(row);
    size.values.push_back(2.0 * (n + 1) * (n + 1)), error.values.push_back(row.computed);
  }
  write_curves(request.folder, "implicit-boundary.figure-15b", "Deep beam: error over the grid",
               {size, error});
  return rows;
}

}  // namespace

std::vector<VerificationTable> deep_beam_tables() {
  return {{"implicit-boundary.table-2", "Deep beam: error over the points in a cell", table_2, false},
          {"implicit-boundary.table-3", "Deep beam: error over the grid", table_3, false}};
}

}  // namespace wisp
