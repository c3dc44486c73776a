// What a case file says about conforming conditions and gravity.
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
  std::vector<double> profile;

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
        key("velocity", &O::velocity, "m/s", "prescribed velocity in time (instead of displacement)"),
        key("profile", &O::profile, "-, 1/m",
            "[c, a, b] (3D: [c, a, b, d]): the motion at (x, y) is c + a x + b y times that in time, by the "
            "initial position on the grid (default: the same everywhere)")};
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
