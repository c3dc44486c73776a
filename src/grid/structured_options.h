// What a case file says about a structured grid.
#pragma once
#include "core/describe.h"

namespace wisp {

/// What happens to a point that leaves the grid.
enum class Leaving { stop, remove };
template <>
inline constexpr auto choices<Leaving> = choice_list<Leaving>({{"stop", Leaving::stop},
                                                               {"remove", Leaving::remove}});

/// Quads (2D) or hexes (3D) between grid lines: equal spacing by `lower`, `upper`, `cells`, or the
/// coordinates of the lines in each direction.
struct StructuredGridOptions {
  std::vector<double> lower;
  std::vector<double> upper;
  std::vector<int> cells;
  std::vector<std::vector<double>> coordinates;
  Leaving leaving = Leaving::stop;

  static constexpr std::string_view name = "structured";
  static constexpr std::string_view summary =
      "Quads or hexes between grid lines, equally or unequally spaced";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = StructuredGridOptions;
    return std::tuple{
        key("lower", &O::lower, "m", "lower corner (with upper and cells; or give coordinates)")
            .per_direction(),
        key("upper", &O::upper, "m", "upper corner").per_direction(),
        key("cells", &O::cells, "-", "number of cells in each direction").at_least(1).per_direction(),
        key("coordinates", &O::coordinates, "m", "for each direction the list of its grid lines, increasing")
            .per_direction(),
        key("leaving", &O::leaving, "",
            "what happens to points that leave the grid: stop with their ids, or remove and count them")};
  }
};

}  // namespace wisp
