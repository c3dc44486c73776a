// A wall cut by the cells of the grid: one row of weights for each wall and host cell.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "basis/trace.h"
#include "boundary/wall_cut.h"
#include "geometry/wall_piece.h"

namespace wisp {

/// Mean over the part of a wall in one cell: w(u) = sum_i weight_i u_i is the mean of a field there, weight_i
/// = (1/size) int N_i ds. On structured grids N_i are the linear functions, also with GIMP, so that a row has
/// the functions of its own cell only; on triangulations those of the basis. At a corner inside a cell each
/// side has a row of its own. The first `n` entries count.
template <int dim>
struct WallRow {
  static constexpr int corners = 1 << dim;
  static constexpr int max_functions = CellFunctions<dim>::max_functions;
  int wall = 0;  ///< index among the walls
  int cell = 0;  ///< local number of the host cell or triangle
  int n = 0;
  std::array<int, max_functions> function{};   ///< local indices
  std::array<double, max_functions> weight{};  ///< sum to one
  Vec<dim> normal = Vec<dim>::Zero();          ///< mean, unit, into the solid side
  Vec<dim> middle = Vec<dim>::Zero();          ///< m, centroid of the part
  double size = 0.0;                           ///< m (2D), m2 (3D)

  std::span<const int> functions() const { return {function.data(), static_cast<std::size_t>(n)}; }
  /// Adds to the weight of a function.
  void add(int i, double w);
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
    Vec<dim> normal;
    WallRow<dim> row;  ///< integrals of the functions and of the position, not yet divided by the size
  };
  void cut(const Convex& shape, int direction, MultiIndex<dim> cell, const Vec<dim>& normal);
  void integrate(const Convex& shape, const MultiIndex<dim>& cell, const Vec<dim>& normal);
  void add_point(const Vec<dim>& x, double weight, const MultiIndex<dim>& cell, Part& part) const;
  void add_on_triangles(const WallPiece<dim>& piece);

  const Space<dim>* space_;
  std::vector<Part> parts_;
  WallCut<dim> cut_;
};

extern template class WallCutter<2>;
extern template class WallCutter<3>;

}  // namespace wisp
