// What a case file says about the basis.
#pragma once
#include <algorithm>

#include "core/describe.h"
#include "grid/control_triangle.h"

namespace wisp {

struct LinearOptions {
  static constexpr std::string_view name = "linear";
  static constexpr std::string_view summary =
      "Linear hat functions of cells or triangles, points without extent (sMPM)";
  static constexpr std::string_view source = "Sulsky et al. 1994";
  static constexpr auto keys() { return std::tuple{}; }
};

struct GimpOptions {
  static constexpr std::string_view name = "gimp";
  static constexpr std::string_view summary =
      "Generalised interpolation: hats averaged over each point's domain, which follows the stretch";
  static constexpr std::string_view source = "Bardenhagen and Kober 2004; Charlton et al. 2017";
  static constexpr auto keys() { return std::tuple{}; }
};

/// The highest degree of B-splines that runs in 2D or 3D can have (CMake: WISP_SPLINE_DEGREE_2D, ..._3D).
constexpr int highest_spline_degree(int dim) {
  return dim == 2 ? WISP_SPLINE_DEGREE_2D : WISP_SPLINE_DEGREE_3D;
}

struct BSplineOptions {
  int degree = 2;

  static constexpr std::string_view name = "b-spline";
  static constexpr std::string_view summary =
      "Tensor products of B-splines on a structured grid: smooth, never negative";
  static constexpr std::string_view source = "Cox 1972; de Boor 1972; de Koster 2018, section 3.4";
  static constexpr auto keys() {
    return std::tuple{key("degree", &BSplineOptions::degree, "-",
                          "of the pieces, whose derivatives are continuous up to degree - 1; 1 is linear; "
                          "at most 4 in 2D and 3 in 3D, unless built with more (WISP_SPLINE_DEGREE_2D, _3D)")
                          .at_least(1)
                          .at_most(std::max(highest_spline_degree(2), highest_spline_degree(3)))};
  }
};

struct LagrangeQuadraticOptions {
  static constexpr std::string_view name = "lagrange-quadratic";
  static constexpr std::string_view summary =
      "Quadratic Lagrange functions on triangles: negative in places, kinked across edges";
  static constexpr std::string_view source = "de Koster et al. 2021";
  static constexpr auto keys() { return std::tuple{}; }
};

struct PowellSabinOptions {
  ControlTriangleRule control_triangles = ControlTriangleRule::hull_edges;

  static constexpr std::string_view name = "powell-sabin";
  static constexpr std::string_view summary =
      "Quadratic Powell-Sabin splines on triangles: smooth, never negative";
  static constexpr std::string_view source = "Dierckx 1997; de Koster et al. 2021";
  static constexpr auto keys() {
    return std::tuple{key("control_triangles", &PowellSabinOptions::control_triangles, "",
                          "the rule for the control triangle of each vertex")};
  }
};

struct PowellSabinCubicOptions {
  ControlTriangleRule control_triangles = ControlTriangleRule::hull_edges;

  static constexpr std::string_view name = "powell-sabin-cubic";
  static constexpr std::string_view summary =
      "Cubic Powell-Sabin splines on triangles: smooth, never negative";
  static constexpr std::string_view source = "Groselj and Speleers 2017";
  static constexpr auto keys() {
    return std::tuple{key("control_triangles", &PowellSabinCubicOptions::control_triangles, "",
                          "the rule for the control triangle of each vertex")};
  }
};

using AnyBasisOptions = std::variant<LinearOptions, GimpOptions, BSplineOptions, LagrangeQuadraticOptions,
                                     PowellSabinOptions, PowellSabinCubicOptions>;

}  // namespace wisp
