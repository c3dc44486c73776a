// What a case file says about the geometry of a wall: one described type for each shape.
#pragma once
#include <string>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

#include "core/describe.h"
#include "geometry/list.h"

namespace wisp {

/// Which side of a closed wall is solid: the body fills a container, or lies around an obstacle.
enum class SolidSide { inside, outside };
template <>
inline constexpr auto choices<SolidSide> = choice_list<SolidSide>({{"inside", SolidSide::inside},
                                                                   {"outside", SolidSide::outside}});

/// Which side of a line is solid: seen along it, or for a closed one also as for closed walls.
enum class LineSide { left, right, inside, outside };
template <>
inline constexpr auto choices<LineSide> = choice_list<LineSide>({{"left", LineSide::left},
                                                                 {"right", LineSide::right},
                                                                 {"inside", LineSide::inside},
                                                                 {"outside", LineSide::outside}});

struct PolylineWall {
  std::vector<std::vector<double>> vertices{};
  LineSide solid = LineSide::left;

  static constexpr std::string_view name = "polyline";
  static constexpr std::string_view summary =
      "segments from vertex to vertex (2D), closed if it ends where it starts";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = PolylineWall;
    return std::tuple{
        key("vertices", &O::vertices, "m", "list of [x, y]").required().example("[[0.0, 0.0], [1.0, 0.0]]"),
        key("solid", &O::solid, "",
            "where the body is: left or right of the line seen along it; inside or outside a closed one")};
  }
};

struct CircleWall {
  std::vector<double> centre{};
  double radius = 0.0;
  SolidSide solid = SolidSide::inside;

  static constexpr std::string_view name = "circle";
  static constexpr std::string_view summary = "a whole circle (2D)";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = CircleWall;
    return std::tuple{key("centre", &O::centre, "m", "centre").required().per_direction(),
                      key("radius", &O::radius, "m", "radius").required().positive(),
                      key("solid", &O::solid, "", "where the body is")};
  }
};

struct ArcWall {
  std::vector<double> centre{};
  double radius = 0.0;
  double from = 0.0;
  double to = 90.0;
  SolidSide solid = SolidSide::inside;

  static constexpr std::string_view name = "arc";
  static constexpr std::string_view summary = "part of a circle (2D)";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = ArcWall;
    return std::tuple{
        key("centre", &O::centre, "m", "centre").required().per_direction(),
        key("radius", &O::radius, "m", "radius").required().positive(),
        key("from", &O::from, "degrees", "start, counter-clockwise from the x direction").required(),
        key("to", &O::to, "degrees", "end, at most 360 degrees after the start").required(),
        key("solid", &O::solid, "", "where the body is: inside or outside the circle")};
  }
};

struct PolygonWall {
  std::vector<std::vector<double>> vertices{};
  std::string file{};
  double scale = 1.0;
  std::vector<double> offset{0.0, 0.0};
  SolidSide solid = SolidSide::inside;

  static constexpr std::string_view name = "polygon";
  static constexpr std::string_view summary =
      "all edges of a polygon with holes, from a list or a CSV file (2D)";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = PolygonWall;
    return std::tuple{
        key("vertices", &O::vertices, "m", "list of [x, y], the last joined to the first; or give `file`"),
        key("file", &O::file, "",
            "CSV file with rows x,y; blank lines separate rings, rings after the first are holes"),
        key("scale", &O::scale, "-", "factor on all coordinates").positive(),
        key("offset", &O::offset, "m", "shift added after scaling").per_direction(),
        key("solid", &O::solid, "", "where the body is")};
  }
};

struct LevelSetWall {
  std::vector<AnyRegion> shapes{};
  double offset = 0.0;
  SolidSide solid = SolidSide::inside;

  static constexpr std::string_view name = "level-set";
  static constexpr std::string_view summary =
      "the line at a distance from a union of shapes: rounded outlines, joined shapes (2D)";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = LevelSetWall;
    return std::tuple{
        key("shapes", &O::shapes, "", "the shapes that are joined").required(),
        key("offset", &O::offset, "m", "signed distance of the line from them, positive outside"),
        key("solid", &O::solid, "", "where the body is")};
  }
};

struct PlaneWall {
  std::vector<double> point{};
  std::vector<double> normal{};
  std::vector<std::vector<double>> edges{};

  static constexpr std::string_view name = "plane";
  static constexpr std::string_view summary =
      "a plane (in 2D a straight line) without bounds, or in 3D a parallelogram of it";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = PlaneWall;
    return std::tuple{
        key("point", &O::point, "m", "a point of it; the corner if `edges` are given")
            .required()
            .per_direction(),
        key("normal", &O::normal, "-", "normal that points into the body, of any length")
            .required()
            .per_direction(),
        key("edges", &O::edges, "m", "two edge vectors of a parallelogram (3D); unbounded without")};
  }
};

struct StlWall {
  std::string file{};
  double scale = 1.0;
  std::vector<double> offset{0.0, 0.0, 0.0};
  SolidSide solid = SolidSide::inside;

  static constexpr std::string_view name = "stl";
  static constexpr std::string_view summary =
      "closed triangulated surface from an STL file, text or binary (3D)";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = StlWall;
    return std::tuple{
        key("file", &O::file, "", "STL file, relative to the folder of the case").required().existing_file(),
        key("scale", &O::scale, "-", "factor on all coordinates").positive(),
        key("offset", &O::offset, "m", "shift added after scaling").per_direction(),
        key("solid", &O::solid, "", "where the body is")};
  }
};

/// Every geometry of a wall that a case file can name.
using AnyWallShape =
    std::variant<PolylineWall, CircleWall, ArcWall, PolygonWall, LevelSetWall, PlaneWall, StlWall>;

}  // namespace wisp
