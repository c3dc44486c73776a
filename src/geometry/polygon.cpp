#include "geometry/polygon.h"

#include <cmath>

#include "core/error.h"
#include "geometry/csv.h"

namespace wisp {
namespace {

Ring ring_from_list(const std::vector<std::vector<double>>& vertices, const std::string& label) {
  Ring ring;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (vertices[i].size() != 2)
      input_error("polygon: {}vertex {} has {} {}, expected [x, y]", label, i + 1, vertices[i].size(),
                  vertices[i].size() == 1 ? "number" : "numbers");
    ring.emplace_back(vertices[i][0], vertices[i][1]);
  }
  return ring;
}

/// Rows x,y after an optional header line "x,y"; `labels` says where each ring starts.
std::vector<Ring> rings_from_file(CsvFile& file, std::vector<std::string>& labels) {
  std::vector<Ring> rings;
  CsvLine line;
  bool new_ring = true;
  bool may_be_header = true;
  while (file.next(line)) {
    if (line.cells.empty()) {
      new_ring = true;
      continue;
    }
    if (line.cells.size() != 2)
      file.fail(line, fmt::format("expected 2 cells x,y, found {}", line.cells.size()));
    const bool is_header = may_be_header && line.cells[0].text == "x" && line.cells[1].text == "y";
    may_be_header = false;
    if (is_header) continue;
    if (new_ring) {
      rings.emplace_back();
      labels.push_back(rings.size() == 1 ? fmt::format("outer ring (line {})", line.number)
                                         : fmt::format("hole {} (line {})", rings.size() - 1, line.number));
      new_ring = false;
    }
    const double x = file.number(line, 0, "x");
    rings.back().emplace_back(x, file.number(line, 1, "y"));
  }
  if (rings.empty()) input_error("{}: no vertices, expected rows x,y", file.name());
  return rings;
}

}  // namespace

Outline outline(const Polygon& polygon, const std::filesystem::path& folder) {
  if (polygon.vertices.empty() == polygon.file.empty())
    input_error("polygon: expected either 'vertices' or 'file', found {}",
                polygon.file.empty() ? "neither" : "both");
  if (!polygon.holes.empty() && polygon.vertices.empty())
    input_error("polygon: 'holes' belong to 'vertices'; a file has its holes after a blank line");
  if (!(polygon.scale > 0.0) || !std::isfinite(polygon.scale))
    input_error("polygon: 'scale' is {}, expected a positive finite number", polygon.scale);
  if (polygon.offset.size() != 2)
    input_error("polygon: 'offset' has {} values, expected 2", polygon.offset.size());
  const Eigen::Vector2d offset(polygon.offset[0], polygon.offset[1]);
  if (!offset.allFinite()) input_error("polygon: 'offset' is not finite");

  std::string origin = "polygon";
  std::vector<Ring> rings;
  std::vector<std::string> labels;
  if (polygon.file.empty()) {
    rings.push_back(ring_from_list(polygon.vertices, ""));
    for (std::size_t k = 0; k < polygon.holes.size(); ++k)
      rings.push_back(ring_from_list(polygon.holes[k], fmt::format("hole {}: ", k + 1)));
    if (!polygon.holes.empty()) {
      labels.push_back("outer ring");
      for (std::size_t k = 0; k < polygon.holes.size(); ++k) labels.push_back(fmt::format("hole {}", k + 1));
    }
  } else {
    CsvFile file(folder / polygon.file);  // an absolute path replaces the folder
    origin = file.name();
    rings = rings_from_file(file, labels);
  }
  for (auto& ring : rings)
    for (auto& x : ring) x = polygon.scale * x + offset;
  return Outline(std::move(rings), origin, std::move(labels));
}

}  // namespace wisp
