// What a case file says about walls that ignore the grid.
#pragma once
#include <optional>

#include "core/curve.h"
#include "core/describe.h"
#include "geometry/rigid_motion.h"
#include "geometry/wall_options.h"

namespace wisp {

/// What a wall does to the material beside it. A prescribed wall moves it in every direction.
enum class WallKind { fixed, roller, tangential, prescribed };
template <>
inline constexpr auto choices<WallKind> = choice_list<WallKind>({{"fixed", WallKind::fixed},
                                                                 {"roller", WallKind::roller},
                                                                 {"tangential", WallKind::tangential},
                                                                 {"prescribed", WallKind::prescribed}});

enum class WallMode { consistent, literal };
template <>
inline constexpr auto choices<WallMode> = choice_list<WallMode>({{"consistent", WallMode::consistent},
                                                                 {"literal", WallMode::literal}});

/// A wall anywhere in the grid. Implicit analyses impose it weakly (Cortis, Coombs and Augarde 2018),
/// explicit ones by impulses.
struct WallOptions {
  std::string label;
  AnyWallShape shape;
  WallKind kind = WallKind::roller;
  std::vector<Curve> displacement;
  std::vector<Curve> velocity;
  std::optional<RigidMotionOptions> motion;
  WallMode mode = WallMode::consistent;
  std::optional<double> delta;
  std::optional<double> ghost;
  bool unilateral = false;
  double friction = 0.0;

  static constexpr std::string_view name = "wall";
  static constexpr std::string_view summary = "A wall of any shape anywhere in the grid, weakly imposed";
  static constexpr std::string_view source = "Cortis, Coombs and Augarde 2018; Nitsche 1971";
  static constexpr auto keys() {
    using O = WallOptions;
    return std::tuple{
        key("name", &O::label, "", "name of the wall (its reactions are listed under it)").required(),
        key("shape", &O::shape, "", "where the wall is, and which side of it is solid").required(),
        key("kind", &O::kind, "",
            "directions that follow the wall: all (fixed, prescribed), the normal one (roller), all but it "
            "(tangential)"),
        key("displacement", &O::displacement, "m",
            "displacement in time along the wall's own axes: normal into the solid, then tangents")
            .per_direction(),
        key("velocity", &O::velocity, "m/s", "velocity along the wall's own axes (instead of displacement)")
            .per_direction(),
        key("motion", &O::motion, "", "rigid motion of the wall in time, along the grid's axes"),
        key("mode", &O::mode, "",
            "implicit steps: consistent (Nitsche's method), or the literal form of the paper"),
        key("delta", &O::delta, "-",
            "implicit steps: width of the band over the cell's side, of a triangle its shortest height "
            "(default "
            "1e-2, for splines 5e-2, literal 1e-6)")
            .positive()
            .at_most(1),
        key("ghost", &O::ghost, "-",
            "implicit steps, consistent, no [stabilisation]: Ghost stiffness in units of lambda + 2 mu "
            "(default "
            "3e-2, on triangles 5e-2, for splines 0.1)")
            .at_least(0),
        key("unilateral", &O::unilateral, "", "explicit steps: the wall only pushes"),
        key("friction", &O::friction, "-", "explicit steps: Coulomb's coefficient").at_least(0)};
  }
};

}  // namespace wisp
