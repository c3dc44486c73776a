// The ghost of sections 5.1 to 5.3. Its outline is not printed; ours has the printed width, height and area.
#pragma once
#include <string>
#include <vector>

#include "grid/structured_options.h"
#include "particle/body_options.h"
#include "stabilise/ghost_options.h"

namespace wisp::ghost_paper {

/// One of the paper's three sets of points.
struct Resolution {
  std::string name;  ///< as in the published tables
  int across;        ///< points across the ghost, which gives about the printed number of points
};
const std::vector<Resolution>& resolutions();
/// By name. Errors (RunError): none of that name.
const Resolution& resolution(const std::string& name);

/// A ghost whose 0.4 m x 0.4 m box has its lower left corner at (x, y).
BodyOptions ghost_body(const std::string& label, const Resolution& points, double x, double y,
                       const AnyLaw& law);

/// Square cells of side 1/cells on the unit square and two layers around it, so that grid edges touch
/// nothing.
StructuredGridOptions unit_grid(int cells);

/// The paper's gamma_M = rho/4 (kg/m3) at the scale of its figures, J_G h^2/4: with J_G as printed the
/// condition numbers of table 2 come out a thousand times smaller, and the collisions of table 3 lose a
/// hundred times the energy.
GhostOptions mass_stabilisation(double density);

}  // namespace wisp::ghost_paper
