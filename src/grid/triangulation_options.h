// What a case file says about a triangulation (2D only).
#pragma once
#include <cstdint>
#include <variant>

#include "core/describe.h"
#include "geometry/polygon.h"
#include "grid/structured_options.h"

namespace wisp {

/// How a block becomes triangles.
enum class BlockSplit { four, two, mirrored };
template <>
inline constexpr auto choices<BlockSplit> = choice_list<BlockSplit>({{"four", BlockSplit::four},
                                                                     {"two", BlockSplit::two},
                                                                     {"two-mirrored", BlockSplit::mirrored}});

struct TriangleBlocksOptions {
  std::vector<double> lower;
  std::vector<double> upper;
  std::vector<int> cells;
  std::vector<std::vector<double>> coordinates;
  BlockSplit split = BlockSplit::four;
  Leaving leaving = Leaving::stop;

  static constexpr std::string_view name = "triangle-blocks";
  static constexpr std::string_view summary =
      "Rectangular blocks split into four or two triangles (2D); boundaries left, right, bottom, top";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = TriangleBlocksOptions;
    return std::tuple{
        key("lower", &O::lower, "m", "lower corner (with upper and cells; or give coordinates)")
            .per_direction(),
        key("upper", &O::upper, "m", "upper corner").per_direction(),
        key("cells", &O::cells, "-", "number of blocks in each direction").at_least(1).per_direction(),
        key("coordinates", &O::coordinates, "m",
            "for each direction the list of the blocks' lines, increasing")
            .per_direction(),
        key("split", &O::split, "",
            "four triangles around the centre, two by the rising diagonal, or two by diagonals that "
            "alternate"),
        key("leaving", &O::leaving, "",
            "what happens to points that leave the grid: stop with their ids, or remove and count them")};
  }
};

struct DelaunayOptions {
  Polygon outline;
  double spacing = 0.0;
  std::vector<std::vector<double>> vertices;
  double irregularity = 0.0;
  int seed = 1;
  Leaving leaving = Leaving::stop;

  static constexpr std::string_view name = "delaunay";
  static constexpr std::string_view summary =
      "Delaunay triangulation inside a polygon (2D); boundaries outer, hole 1, ... and side 1, ... of the "
      "outer ring";
  static constexpr std::string_view source = "Barber et al. 1996";
  static constexpr auto keys() {
    using O = DelaunayOptions;
    return std::tuple{
        key("outline", &O::outline, "", "the polygon, with holes if it comes from a file").required(),
        key("spacing", &O::spacing, "m", "distance of generated vertices; 0: only the given ones")
            .at_least(0),
        key("vertices", &O::vertices, "m", "list of [x, y] inside or on the polygon, besides its corners"),
        key("irregularity", &O::irregularity, "-",
            "generated inner vertices are shifted at random by up to this share of the spacing; 0: smoothed")
            .at_least(0)
            .at_most(0.4),
        key("seed", &O::seed, "-", "of the shifts").at_least(0),
        key("leaving", &O::leaving, "",
            "what happens to points that leave the grid: stop with their ids, or remove and count them")};
  }
};

struct GmshOptions {
  std::string file;
  double scale = 1.0;
  Leaving leaving = Leaving::stop;

  static constexpr std::string_view name = "gmsh";
  static constexpr std::string_view summary =
      "Triangles of a Gmsh file (.msh 2 or 4; 2D); its physical groups name boundaries";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = GmshOptions;
    return std::tuple{
        key("file", &O::file, "", "the .msh file, relative to the folder of the case").required(),
        key("scale", &O::scale, "-", "factor on all coordinates").positive(),
        key("leaving", &O::leaving, "",
            "what happens to points that leave the grid: stop with their ids, or remove and count them")};
  }
};

using AnyTriangulationOptions = std::variant<TriangleBlocksOptions, DelaunayOptions, GmshOptions>;

}  // namespace wisp
