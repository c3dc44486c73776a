// Figures 3.23, 3.24 and 3.26 of de Koster 2018: a basis function, control triangles, a projection.
#include <cmath>

#include "analysis/projection.h"
#include "verification/powell_sabin/double_sine.h"
#include "verification/powell_sabin/list.h"
#include "verification/published.h"

namespace wisp {

namespace {
using namespace spline_thesis;

struct Segments {
  std::vector<FigureColumn> columns{{"x0", {}}, {"y0", {}}, {"x1", {}}, {"y1", {}}, {"kind", {}}};
  void add(const Vec<2>& a, const Vec<2>& b, int kind) {
    const double values[] = {a[0], a[1], b[0], b[1], static_cast<double>(kind)};
    for (std::size_t c = 0; c < columns.size(); ++c) columns[c].values.push_back(values[c]);
  }
};

/// Share of the Powell–Sabin points of all vertices that lie in their control triangles, rounding forgiven.
double contained(const PowellSabinQuadratic& basis) {
  const auto& mesh = basis.triangulation();
  int inside = 0, all = 0;
  for (int t = 0; t < mesh.n_triangles(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.triangle(t)[static_cast<std::size_t>(k)];
      const Vec<2>& x = mesh.vertex(v);
      for (const Vec<2>& p : {x, Vec<2>(0.5 * (x + basis.split().centre(t))),
                              Vec<2>(0.5 * (x + basis.split().edge_point(mesh.edge(t, k)))),
                              Vec<2>(0.5 * (x + basis.split().edge_point(mesh.edge(t, (k + 2) % 3))))}) {
        bool in = true;
        for (int q = 0; q < 3; ++q) {
          const auto f = basis.triplet(v, q);
          in = in && f.value + f.x * (p - x)[0] + f.y * (p - x)[1] > -1e-12;
        }
        inside += in, ++all;
      }
    }
  return static_cast<double>(inside) / all;
}

std::vector<VerificationRow> control_triangles_figure(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  const auto draw = [&](const Triangulation& mesh, const std::string& name, const std::string& title) {
    const PowellSabinQuadratic basis(mesh);
    Segments lines;
    for (int t = 0; t < mesh.n_triangles(); ++t)
      for (int k = 0; k < 3; ++k) {
        lines.add(basis.split().centre(t), mesh.corner(t, k), 1);
        lines.add(basis.split().centre(t), basis.split().edge_point(mesh.edge(t, k)), 1);
      }
    for (int e = 0; e < mesh.n_edges(); ++e)
      lines.add(mesh.vertex(mesh.edge(e).vertex[0]), mesh.vertex(mesh.edge(e).vertex[1]), 0);
    for (int v = 0; v < mesh.n_vertices(); ++v)
      for (std::size_t q = 0; q < 3; ++q)
        lines.add(basis.control_triangle(v)[q], basis.control_triangle(v)[(q + 1) % 3], 2);
    write_segments(request.folder, name, title, lines.columns);
    VerificationRow row;
    row.case_name = title;
    row.quantity = "share of Powell-Sabin points in their control triangles";
    row.reference = "exact", row.expected = 1.0, row.tolerance = 0.0, row.gated = true;
    row.computed = contained(basis);
    rows.push_back(row);
  };
  draw(unit_square(3), "powell-sabin.figure-3-24", "Split and control triangles, nine vertices");
  draw(shifted_square(4, 2), "powell-sabin.figure-3-17", "Split and control triangles, irregular");
  return rows;
}

constexpr int samples = 48;

/// Calls f(x) on a regular grid of places in the unit square.
template <class F>
void on_samples(F&& f) {
  for (int j = 0; j <= samples; ++j)
    for (int i = 0; i <= samples; ++i)
      f(Vec<2>(static_cast<double>(i) / samples, static_cast<double>(j) / samples));
}

std::vector<VerificationRow> basis_function_figure(const VerificationRequest& request) {
  std::vector<VerificationRow> rows;
  const Triangulation mesh = shifted_square(4, 2);
  std::vector<FigureColumn> columns{{"x", {}}, {"y", {}}, {"value", {}}, {"function", {}}};
  const auto sample = [&](const auto& basis, int function, double panel, const std::string& name) {
    std::vector<double> c(static_cast<std::size_t>(basis.n_functions()), 0.0);
    c[static_cast<std::size_t>(function)] = 1.0;
    double least = 0.0;
    on_samples([&](const Vec<2>& x) {
      const double value = field_value(basis, c, x);
      const double row[] = {x[0], x[1], value, panel};
      for (std::size_t k = 0; k < columns.size(); ++k) columns[k].values.push_back(row[k]);
      least = std::min(least, value);
    });
    VerificationRow row;
    row.case_name = name;
    row.quantity = "least value";
    row.reference = "exact", row.expected = 0.0, row.tolerance = 0.0, row.gated = true;
    row.computed = least;
    rows.push_back(row);
  };
  const int middle = 5;  // an inner vertex of the four by four
  const PowellSabinQuadratic quadratic(mesh);
  const PowellSabinCubic cubic(mesh);
  const int t = mesh.triangles_of_vertex(middle)[0];
  int k = 0;
  while (mesh.triangle(t)[static_cast<std::size_t>(k)] != middle) ++k;
  sample(quadratic, 3 * middle, 1, "1: a quadratic spline");
  sample(cubic, 3 * middle, 2, "2: a cubic spline of a vertex");
  sample(cubic, cubic.corner_function(t, k, 0), 3, "3: a cubic spline of a triangle's corner");
  write_surface(request.folder, "powell-sabin.figure-3-23", "Basis functions of Powell-Sabin splines",
                columns);
  return rows;
}

std::vector<VerificationRow> projection_figure(const VerificationRequest& request) {
  std::vector<FigureColumn> columns{{"x", {}}, {"y", {}}, {"value", {}}, {"panel", {}}};
  const auto add = [&](double panel, auto&& value) {
    on_samples([&](const Vec<2>& x) {
      const double row[] = {x[0], x[1], value(x), panel};
      for (std::size_t k = 0; k < columns.size(); ++k) columns[k].values.push_back(row[k]);
    });
  };
  add(1, double_sine);
  std::vector<double> largest;
  std::vector<VerificationRow> rows;
  for (const int n : {3, 17}) {
    const Triangulation mesh = unit_square(n);
    const PowellSabinQuadratic basis(mesh);
    const auto c = solve_field(basis, double_sine);
    if (n == 3) add(2, [&](const Vec<2>& x) { return field_value(basis, c, x); });
    add(n == 3 ? 3 : 4, [&](const Vec<2>& x) { return field_value(basis, c, x) - double_sine(x); });
    VerificationRow row;
    row.case_name = fmt::format("h = 1/{}", n - 1);
    row.quantity = "largest error";
    row.computed = field_error(basis, c, double_sine).largest;
    largest.push_back(row.computed);
    rows.push_back(row);
  }
  VerificationRow ratio;
  ratio.case_name = "h = 1/2 to 1/16";
  ratio.quantity = "rate of the largest error";
  ratio.computed = std::log2(largest[0] / largest[1]) / 3.0;
  ratio.gated = true, ratio.verdict = ratio.computed > 2.7;  // third order, the coarsest grid included
  rows.push_back(ratio);
  write_surface(request.folder, "powell-sabin.figure-3-26",
                "1: double sine, 2: its projection (h = 1/2), 3 and 4: errors (h = 1/2, 1/16)", columns);
  return rows;
}

}  // namespace

std::vector<VerificationTable> spline_pictures() {
  return {
      {"powell-sabin.figure-3-23", "Basis functions as surfaces", basis_function_figure, false},
      {"powell-sabin.figure-3-24", "The split with its control triangles", control_triangles_figure, false},
      {"powell-sabin.figure-3-26", "The projection and its error as surfaces", projection_figure, false}};
}

}  // namespace wisp
