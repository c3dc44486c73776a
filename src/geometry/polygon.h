#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/describe.h"
#include "geometry/outline.h"

namespace wisp {

/// Polygon (2D only) as a case file gives it: either `vertices` (and `holes`) or `file`. A file holds rows
/// x,y; blank lines separate rings; the first ring is the outer one, all others are holes. Each vertex is
/// placed at scale * (x, y) + offset.
struct Polygon {
  static constexpr std::string_view name = "polygon";
  static constexpr std::string_view summary =
      "polygon with holes, from a list of vertices or a CSV file (2D)";
  static constexpr std::string_view source = "";

  std::vector<std::vector<double>> vertices{};            ///< [n][2], m, either sense of rotation
  std::vector<std::vector<std::vector<double>>> holes{};  ///< rings like `vertices`, m
  std::string file{};                                     ///< CSV, relative to the folder of the case
  double scale = 1.0;                                     ///< positive
  std::vector<double> offset{0.0, 0.0};                   ///< [2], m, added after scaling

  static constexpr auto keys() {
    return std::tuple{
        key("vertices", &Polygon::vertices, "m",
            "list of [x, y], the last joined to the first; or give `file`"),
        key("holes", &Polygon::holes, "m", "with `vertices`: rings of [x, y] that are cut out"),
        key("file", &Polygon::file, "",
            "CSV file with rows x,y; blank lines separate rings, rings after the first are holes"),
        key("scale", &Polygon::scale, "-", "factor on all coordinates").positive(),
        key("offset", &Polygon::offset, "m", "shift added after scaling").per_direction()};
  }
};

/// Reads, places and checks a polygon. `folder` is where a relative `file` starts from.
/// Throws InputError for every polygon that is not simple (see Outline) and for malformed files.
Outline outline(const Polygon& polygon, const std::filesystem::path& folder = {});

}  // namespace wisp
