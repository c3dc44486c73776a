// Section 3.6 of de Koster 2018: the L2 projection of sin(pi x) sin(pi y), and the same on the other bases.
#include "analysis/projection.h"

#include <cmath>

#include "basis/bspline.h"
#include "basis/lagrange_quadratic.h"
#include "basis/linear_triangle.h"
#include "grid/quadrature.h"
#include "verification/powell_sabin/double_sine.h"
#include "verification/powell_sabin/list.h"
#include "verification/published.h"

namespace wisp {

namespace {
using namespace spline_thesis;

template <class Basis>
double projection_error(const Basis& basis) {
  return field_error(basis, solve_field(basis, double_sine), double_sine).l2;
}

VerificationRow rate_row(const std::string& name, double coarse, double fine, double expected,
                         double tolerance) {
  VerificationRow row;
  row.case_name = name;
  row.quantity = "rate of the L2 error";
  row.reference = "exact";
  row.expected = expected;
  row.computed = std::log2(coarse / fine);
  row.tolerance = tolerance, row.gated = true;
  return row;
}

std::vector<VerificationRow> table_3_1(const VerificationRequest&) {
  const Published published("ps-table-3-1");
  std::vector<VerificationRow> rows;
  std::vector<double> errors;
  for (const int n : {3, 5, 9, 17}) {
    const Triangulation mesh = unit_square(n);
    VerificationRow row;
    row.case_name = fmt::format("{0} x {0} vertices", n);
    row.quantity = "L2 error";
    row.published = published.at({std::to_string(n)}, "E");
    row.computed = projection_error(PowellSabinQuadratic(mesh));
    row.tolerance = 0.02, row.gated = true;
    errors.push_back(row.computed);
    rows.push_back(row);
  }
  for (std::size_t i = 1; i < errors.size(); ++i) {
    auto row = rate_row(fmt::format("h = 1/{} to 1/{}", 1 << i, 2 << i), errors[i - 1], errors[i], 3.0, 0.03);
    row.gated = i + 1 == errors.size();
    rows.push_back(row);
  }
  return rows;
}

/// The error of a best approximation without its values: |f - u|² = |f|² - (f, u), from the coefficients and
/// the integrals of f times each function, here by a rule of higher order than the projection's.
double error_by_pythagoras(const Triangulation& mesh) {
  const LinearTriangle basis(mesh);
  const auto c = solve_field(basis, double_sine);
  const TriangleRule rule = triangle_rule(9);
  double product = 0.0;
  for (int t = 0; t < mesh.n_triangles(); ++t)
    for (std::size_t q = 0; q < rule.place.size(); ++q) {
      double u = 0.0;
      for (std::size_t k = 0; k < 3; ++k)
        u += rule.place[q][k] * c[static_cast<std::size_t>(mesh.triangle(t)[k])];
      product += mesh.area(t) * rule.weight[q] * u * double_sine(mesh.point(t, rule.place[q]));
    }
  return std::sqrt(0.25 - product);
}

std::vector<VerificationRow> table_3_2(const VerificationRequest&) {
  const Published published("ps-table-3-2");
  std::vector<VerificationRow> rows;
  std::vector<double> errors;
  for (const int n : {5, 9, 17, 33}) {
    const Triangulation mesh = unit_square(n);
    VerificationRow row;
    row.case_name = fmt::format("{0} x {0} vertices", n);
    row.quantity = "L2 error";
    row.published = published.at({std::to_string(n)}, "E");
    row.reference = "exact";
    row.expected = error_by_pythagoras(mesh);
    row.computed = projection_error(LinearTriangle(mesh));
    row.tolerance = 1e-6, row.gated = true;
    errors.push_back(row.computed);
    rows.push_back(row);
    VerificationRow ratio;
    ratio.case_name = row.case_name;
    ratio.quantity = "computed over published (the print is too small)";
    ratio.computed = row.computed / *row.published;
    rows.push_back(ratio);
  }
  for (std::size_t i = 1; i < errors.size(); ++i)
    rows.push_back(
        rate_row(fmt::format("h = 1/{} to 1/{}", 2 << i, 4 << i), errors[i - 1], errors[i], 2.0, 0.04));
  return rows;
}

/// Errors on grids of n vertices a side; the rate of the last pair counts.
template <class ErrorOf>
void add_study(std::vector<VerificationRow>& rows, const std::string& name, const std::vector<int>& sides,
               double rate, double tolerance, ErrorOf&& error_of) {
  std::vector<double> errors;
  for (const int n : sides) {
    VerificationRow row;
    row.case_name = fmt::format("{}, h = 1/{}", name, n - 1);
    row.quantity = "L2 error";
    row.computed = error_of(n);
    errors.push_back(row.computed);
    rows.push_back(row);
  }
  const std::size_t last = errors.size() - 1;
  rows.push_back(rate_row(fmt::format("{}, h = 1/{} to 1/{}", name, sides[last - 1] - 1, sides[last] - 1),
                          errors[last - 1], errors[last], rate, tolerance));
}

std::vector<VerificationRow> cubic(const VerificationRequest&) {
  std::vector<VerificationRow> rows;
  add_study(rows, "cubic splines, one diagonal", {3, 5, 9, 17}, 4.0, 0.03,
            [](int n) { return projection_error(PowellSabinCubic(unit_square(n))); });
  return rows;
}

/// Root mean square of the errors on eight irregular triangulations: one alone owes part of its error to its
/// worst triangles.
template <class Basis>
double error_of_several(int n) {
  constexpr unsigned seeds = 8;
  double square = 0.0;
  for (unsigned seed = 1; seed <= seeds; ++seed)
    square += std::pow(projection_error(Basis(shifted_square(n, seed))), 2) / seeds;
  return std::sqrt(square);
}

std::vector<VerificationRow> delaunay_grids(const VerificationRequest&) {
  std::vector<VerificationRow> rows;
  const std::vector<int> sides{5, 9, 17, 33};
  add_study(rows, "linear", sides, 2.0, 0.06, error_of_several<LinearTriangle>);
  add_study(rows, "quadratic Lagrange", sides, 3.0, 0.06, error_of_several<LagrangeQuadratic>);
  add_study(rows, "quadratic splines", sides, 3.0, 0.06, error_of_several<PowellSabinQuadratic>);
  add_study(rows, "cubic splines", {5, 9, 17}, 4.0, 0.06, error_of_several<PowellSabinCubic>);
  return rows;
}

template <int degree>
void add_tensor(std::vector<VerificationRow>& rows) {
  add_study(rows, fmt::format("degree {}", degree), {5, 9, 17}, degree + 1.0, 0.06, [](int n) {
    const StructuredGrid<2> grid({0, 0}, {1, 1}, {n - 1, n - 1});
    return projection_error(BSpline<2, degree>(grid));
  });
}

std::vector<VerificationRow> tensor(const VerificationRequest&) {
  std::vector<VerificationRow> rows;
  add_tensor<1>(rows), add_tensor<2>(rows), add_tensor<3>(rows), add_tensor<4>(rows);
  return rows;
}

}  // namespace

std::vector<VerificationTable> projection_tables() {
  return {{"powell-sabin.table-3-1", "Projection on quadratic Powell-Sabin splines", table_3_1, false},
          {"powell-sabin.table-3-2", "Projection on linear functions: the print is about 16 times too small",
           table_3_2, false},
          {"powell-sabin.projection-cubic", "Projection on cubic Powell-Sabin splines", cubic, false},
          {"powell-sabin.projection-delaunay", "Projection on irregular Delaunay triangulations",
           delaunay_grids, false},
          {"powell-sabin.projection-tensor", "Projection on tensor products of B-splines", tensor, false}};
}

}  // namespace wisp
