// What a case file says about conditions, loads and tractions.
#pragma once
#include <optional>

#include "core/curve.h"
#include "core/describe.h"

namespace wisp {

/// A conforming condition: functions on a grid line (2D), plane (3D) or at a node are fixed or prescribed per
/// direction.
struct ConformingOptions {
  std::string label;
  std::string normal;
  double at = 0.0;
  std::vector<double> node;
  std::string part;
  std::vector<double> lower;
  std::vector<double> upper;
  std::vector<std::string> directions;
  std::optional<Curve> displacement;
  std::optional<Curve> velocity;

  static constexpr std::string_view name = "conforming";
  static constexpr std::string_view summary =
      "Fixed or prescribed motion of the grid functions on a grid line, plane or node";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = ConformingOptions;
    return std::tuple{
        key("name", &O::label, "", "name of the condition (its reactions are listed under it)").required(),
        key("normal", &O::normal, "", "direction normal to the grid line or plane: x, y or z"),
        key("at", &O::at, "m", "coordinate of the grid line or plane along `normal`"),
        key("node", &O::node, "m", "position of a single grid node (instead of normal and at)")
            .per_direction(),
        key("part", &O::part, "", "named boundary of a triangulation (instead of normal and at)"),
        key("lower", &O::lower, "m", "only nodes with coordinates not below this corner").per_direction(),
        key("upper", &O::upper, "m", "only nodes with coordinates not above this corner").per_direction(),
        key("directions", &O::directions, "", "directions that are constrained: x, y, z").required(),
        key("displacement", &O::displacement, "m", "prescribed displacement in time (default: fixed)"),
        key("velocity", &O::velocity, "m/s", "prescribed velocity in time (instead of displacement)")};
  }
};

/// A force on chosen points, shared equally among them.
struct PointLoadOptions {
  std::string label;
  std::string body;
  std::vector<std::vector<double>> nearest;
  std::vector<double> force;
  Curve factor{1.0};

  static constexpr std::string_view name = "point-load";
  static constexpr std::string_view summary =
      "A force on the points nearest to given positions, shared equally";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = PointLoadOptions;
    return std::tuple{
        key("name", &O::label, "", "name of the load").required(),
        key("body", &O::body, "", "body whose points carry it").required(),
        key("nearest", &O::nearest, "m", "for each loaded point a position; the nearest point is taken")
            .required(),
        key("force", &O::force, "N", "total force (per metre of thickness in 2D)").required().per_direction(),
        key("factor", &O::factor, "-", "factor on the force in time")};
  }
};

/// Marked surface points that move with a body and carry a traction or a pressure.
struct TractionOptions {
  std::string label;
  std::string body;
  std::vector<double> corner;
  std::vector<std::vector<double>> edges;
  std::vector<int> points;
  std::vector<double> traction;
  std::optional<Curve> pressure;
  Curve factor{1.0};

  static constexpr std::string_view name = "traction";
  static constexpr std::string_view summary =
      "Traction (dead) or pressure (following) on surface points that move with a body";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = TractionOptions;
    return std::tuple{
        key("name", &O::label, "", "name of the traction").required(),
        key("body", &O::body, "", "body whose motion the surface follows").required(),
        key("corner", &O::corner, "m", "start of the segment (2D) or corner of the parallelogram (3D)")
            .required()
            .per_direction(),
        key("edges", &O::edges, "m",
            "one edge vector in 2D, two in 3D; the outward normal is the edge turned by -90 degrees (2D) or "
            "e1 x e2 (3D)")
            .required(),
        key("points", &O::points, "-", "number of surface points along each edge").at_least(1).required(),
        key("traction", &O::traction, "Pa", "force per initial area").per_direction(),
        key("pressure", &O::pressure, "Pa",
            "pressure against the outward normal on the current area, in time"),
        key("factor", &O::factor, "-", "factor on the traction in time")};
  }
};

struct GravityOptions {
  std::vector<double> acceleration;
  Curve factor{1.0};

  static constexpr std::string_view name = "gravity";
  static constexpr std::string_view summary = "Body force per mass on every point";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    return std::tuple{key("acceleration", &GravityOptions::acceleration, "m/s2", "acceleration of gravity")
                          .required()
                          .per_direction(),
                      key("factor", &GravityOptions::factor, "-", "factor in time")};
  }
};

}  // namespace wisp
