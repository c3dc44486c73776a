// A wall cut by the cells of the grid: one row of weights for each wall and host cell.
#pragma once
#include <array>
#include <vector>

#include "basis/space.h"
#include "geometry/wall_piece.h"

namespace wisp {

/// Mean over the part of a wall in one cell: w(u) = sum_i weight_i u_i is the mean of a field of linear
/// functions there, weight_i = (1/size) int N_i ds. Linear whatever the basis, so that a row has the
/// functions of its own cell only. At a corner inside a cell each side has a row of its own.
template <int dim>
struct WallRow {
  static constexpr int n = 1 << dim;
  int wall = 0;                        ///< index among the walls
  int cell = 0;                        ///< local number of the host cell
  std::array<int, n> function{};       ///< local indices
  std::array<double, n> weight{};      ///< sum to one
  Vec<dim> normal = Vec<dim>::Zero();  ///< mean, unit, into the solid side
  Vec<dim> middle = Vec<dim>::Zero();  ///< m, centroid of the part
  double size = 0.0;                   ///< m (2D), m2 (3D)
};

/// Cuts pieces by the cells of a rank's window. Arrays keep their capacity from call to call.
template <int dim>
class WallCutter {
 public:
  explicit WallCutter(const Space<dim>& space) : space_(&space) {}

  /// Adds one piece of a wall. Parts outside the grid are left out; a part on a grid line belongs to the cell
  /// on the solid side.
  void add(const WallPiece<dim>& piece);

  /// Appends the rows of the pieces added so far, in the order of their cells, and forgets the pieces. Pieces
  /// in one cell share a row if their normals differ by less than some 20 degrees.
  void finish(int wall, std::vector<WallRow<dim>>& rows);

 private:
  static constexpr std::size_t max_vertices = dim == 2 ? 2 : 9;  // a triangle cut by six planes
  struct Convex {
    std::array<Vec<dim>, max_vertices + 1> vertex;
    std::size_t n = 0;
  };
  struct Part {
    int cell, order;
    Vec<dim> normal, first;                      ///< first: integral of the position
    std::array<double, WallRow<dim>::n> weight;  ///< integrals of the functions
    double size;
  };
  void cut(const Convex& shape, int direction, MultiIndex<dim> cell, const Vec<dim>& normal);
  void integrate(const Convex& shape, const MultiIndex<dim>& cell, const Vec<dim>& normal);
  void add_point(const Vec<dim>& x, double weight, const MultiIndex<dim>& cell, Part& part) const;

  const Space<dim>* space_;
  std::vector<Part> parts_;
};

extern template class WallCutter<2>;
extern template class WallCutter<3>;

}  // namespace wisp
