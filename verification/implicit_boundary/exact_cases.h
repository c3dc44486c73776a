// Cases between walls with known solutions, on any grid and basis.
#pragma once
#include "verification/implicit_boundary/square.h"

namespace wisp::implicit_boundary_paper {

/// Relative L2 error over the points for u = a sin(pi x/L) sin(pi y/L) (1, 1/2) in the square's own axes,
/// which four fixed walls hold to zero. `options`: grid, basis and body.
double manufactured_error(ModelOptions options, const SquareCase& square);

constexpr double inner_radius = 40.0, outer_radius = 100.0;  // mm

struct Cylinder {
  double displacement = 0.0;  ///< relative L2 error over the points
  double pressure = 0.0;      ///< of the wall on the body over Lame's
};

/// A quarter of a thick cylinder between two rollers; the inner face moves out by 1 mm, the outer one is
/// free. `options`: grid and basis.
Cylinder solve_cylinder(ModelOptions options, const Sampling& sampling);

}  // namespace wisp::implicit_boundary_paper
