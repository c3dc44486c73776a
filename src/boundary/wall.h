// A wall of a run: what the case says of it, what it does in implicit steps, and what it carries from step to
// step. Explicit steps use its geometry and motion and find impulses themselves.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "basis/trace.h"
#include "boundary/wall_cut.h"
#include "boundary/wall_options.h"
#include "boundary/wall_state.h"
#include "geometry/rigid_motion.h"
#include "geometry/wall_shape.h"
#include "linear/block_matrix.h"
#include "particle/body.h"
#include "transfer/active.h"

namespace wisp {

/// Moment of a reaction: one number in 2D (about z, N), a vector in 3D (N m).
template <int dim>
using Moment = Eigen::Matrix<double, dim == 2 ? 1 : 3, 1>;

/// Integrals across the band of width delta over which d = 1 - (1 - phi/delta)^2 rises from 0 to 1 (Cortis,
/// Coombs and Augarde 2018, eq. 16, 21-22), by 3 Gauss points, which are exact.
struct BandIntegrals {
  double slope = 0.0;          ///< of d': 1
  double value_slope = 0.0;    ///< of d d': 1/2
  double slope_squared = 0.0;  ///< of d'^2: 4/(3 delta), 1/m
};
BandIntegrals band_integrals(double delta);

/// How much of a wall works in a step, m2 (2D m), all ranks.
struct WallCoverage {
  double whole = 0.0;         ///< the wall in the grid
  double held = 0.0;          ///< beside material
  double extrapolated = 0.0;  ///< of it, in empty cells: the next cell along the normal stands in
};

template <int dim>
class Wall {
 public:
  /// Checks the wall. `folder` is where relative file names start from. Errors: InputError.
  Wall(const WallOptions& options, const std::filesystem::path& folder);

  const std::string& name() const { return options_.label; }
  const WallOptions& options() const { return options_; }
  /// At rest; where it is at a time is up to `motion`.
  const WallShape<dim>& shape() const { return shape_; }
  const RigidMotion<dim>& motion() const { return motion_; }

  /// Implicit steps, in this order. First the wall is cut at the grid lines (edges of triangles) where it is
  /// at time t, and every part finds the active cell whose functions it uses: its own, or if that is empty
  /// the nearest along the normal, at most one cell away. Collective.
  void begin_step(const Space<dim>& space, const ActiveCells& active, const std::vector<Body<dim>>& bodies,
                  double t, double dt);
  /// Lets the pattern of a matrix couple the functions at the wall.
  void add_pattern(BlockMatrix& matrix) const;
  /// The wall takes up K u + c from the displacement u over the step: adds K = K2 + K2^T + K3 (Cortis, Coombs
  /// and Augarde 2018, eq. 26, 27, local rows; consistent mode: Nitsche 1971 with 4/(3 delta)) to a matrix
  /// and c, from prescribed motion (eq. 28) and what has gathered before, to `force` (n_functions x dim).
  void add_stiffness(BlockMatrix& stiffness) const;
  void add_force(std::span<double> force) const;
  /// Takes over a converged displacement: states, `reaction`, `moment`, `work`. Collective.
  void finish(std::span<const double> u, double t, double dt);

  const WallCoverage& coverage() const { return coverage_; }
  /// What the wall has gathered, on all ranks alike. For checkpoints.
  std::vector<WallState<dim>>& states() { return states_; }
  const std::vector<WallState<dim>>& states() const { return states_; }

  Vec<dim> reaction = Vec<dim>::Zero();      ///< N, on the body, all ranks, at the end of the last step
  Moment<dim> moment = Moment<dim>::Zero();  ///< about motion().centre(t), likewise
  double work = 0.0;                         ///< J, done on the body in the last step, all ranks

 private:
  /// A Gauss point of a step, in the axes of the grid.
  struct Point {
    CellFunctions<dim> functions;
    Vec<dim> position, normal, target;  // target: displacement of the wall over the step, m
    Vec<dim> traction, gap;             // at the start of the step
    double weight = 0.0, lambda = 0.0, mu = 0.0, penalty = 0.0;  // penalty: 4/(3 delta)
  };
  /// Operators at a Gauss point: held directions P, penalty Q, and traction s = S_j u_j of function j.
  struct Operators {
    Mat<dim> held, penalty;
    std::array<Mat<dim>, CellFunctions<dim>::max_functions> traction;
  };
  Operators operators(const Point& point) const;
  Vec<dim> own_displacement(const Vec<dim>& normal, double t, double dt) const;
  void cut(const Space<dim>& space, double t);
  WallOptions options_;
  WallShape<dim> shape_;
  RigidMotion<dim> motion_;
  std::vector<WallPiece<dim>> pieces_;  // at rest
  WallCut<dim> cut_;
  bool is_cut_ = false, is_curved_ = false;
  Vec<dim> shift_ = Vec<dim>::Zero();  // own displacement of a flat wall so far, at rest
  std::vector<Point> points_;
  std::vector<std::size_t> parts_;  // first point of each part that works, and the end
  std::vector<WallState<dim>> states_;
  WallCoverage coverage_;
};

}  // namespace wisp
