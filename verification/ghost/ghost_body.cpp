#include "verification/ghost/ghost_body.h"

#include "core/error.h"
#include "verification/published.h"

namespace wisp::ghost_paper {

const std::vector<Resolution>& resolutions() {
  static const std::vector<Resolution> all{{"coarse", 31}, {"medium", 60}, {"fine", 120}};
  return all;
}

const Resolution& resolution(const std::string& name) {
  for (const auto& r : resolutions())
    if (r.name == name) return r;
  run_error("there is no resolution '{}' of the ghost", name);
}

BodyOptions ghost_body(const std::string& label, const Resolution& points, double x, double y,
                       const AnyLaw& law) {
  Polygon outline;
  outline.file = verification_file("ghost/outline.csv").string();
  outline.offset = {x, y};
  BodyOptions body;
  body.label = label;
  body.shape = outline;
  body.sampling.method = SamplingMethod::divisions;
  body.sampling.divisions = {points.across, points.across};
  body.material = law;
  return body;
}

StructuredGridOptions unit_grid(int cells) {
  const double margin = 2.0 / cells;
  StructuredGridOptions grid;
  grid.lower = {-margin, -margin}, grid.upper = {1.0 + margin, 1.0 + margin};
  grid.cells = {cells + 4, cells + 4};
  return grid;
}

GhostOptions mass_stabilisation(double density) {
  GhostOptions ghost;
  ghost.units = GhostUnits::paper, ghost.scale = GhostScale::figures;
  ghost.mass = 0.25 * density;
  return ghost;
}

}  // namespace wisp::ghost_paper
