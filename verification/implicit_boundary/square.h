// The 100 mm square of Cortis, Coombs and Augarde 2018, sections 5.1 and 5.2, and other rectangles, at any
// inclination to the grid.
// Lengths in mm, stresses in MPa, forces in N/mm.
#pragma once
#include <memory>
#include <optional>

#include "analysis/implicit.h"

namespace wisp::implicit_boundary_paper {

constexpr double side = 100.0, young_modulus = 1000.0, poisson_ratio = 0.3;

struct SquareCase {
  double angle = 0.0;                  ///< degrees, of the square against the grid, about `pivot`
  Vec<2> pivot = Vec<2>::Zero();       ///< mm, a node of the grid
  double width = side, height = side;  ///< mm, along the rectangle's own axes
  double room = 0.0;                   ///< mm, empty space around besides two cells
  double h = 10.0;                     ///< mm
  int points = 1;                      ///< a cell and direction
  WallMode mode = WallMode::consistent;
  std::optional<double> delta{};  ///< in units of h
  bool gimp = false;
  bool finite = false;  ///< Hencky's law instead of small strains
  std::optional<double> ghost{};
};

/// Turned by the angle; exact at multiples of 90 degrees.
Mat<2> turn(double degrees);
/// A point of the rectangle's own axes, [0, width] x [0, height], in those of the grid.
Vec<2> placed(const SquareCase& square, const Vec<2>& own);

/// Grid with lines at multiples of h and two empty cells around; the body; no walls yet.
ModelOptions square_options(const SquareCase& square);
/// A straight wall from a to b in the square's own axes, the solid on the left.
WallOptions& add_wall(ModelOptions& options, const SquareCase& square, const char* name, const Vec<2>& a,
                      const Vec<2>& b, WallKind kind);

/// One solved step.
struct Solved {
  std::unique_ptr<Model<2>> model;
  std::unique_ptr<Implicit<2>> analysis;
  ImplicitRecord record;
};
Solved solve(const ModelOptions& options, int steps = 1);
/// Volume mean of the points' displacements (mm), along the rectangle's own axes.
Vec<2> mean_displacement(const Solved& solved, const SquareCase& square);

/// Displacement of the grid at a node (mm), over the last step.
Vec<2> at_node(const Solved& solved, int i, int j);

}  // namespace wisp::implicit_boundary_paper
