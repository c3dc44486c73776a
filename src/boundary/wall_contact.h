// Walls in explicit dynamics: impulses on the grid's velocity, found together for all walls of a step.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "basis/space.h"
#include "boundary/wall.h"
#include "boundary/wall_rows.h"
#include "boundary/wall_system.h"
#include "parallel/session.h"
#include "particle/body.h"
#include "particle/mean_motion.h"

namespace wisp {

/// Number of a cell or node in the box of the whole grid, x fastest.
template <int dim>
std::int64_t number_in(const IndexBox<dim>& box, const MultiIndex<dim>& index) {
  std::int64_t number = 0;
  for (int d = dim - 1; d >= 0; --d) number = number * box.upper[d] + index[d];
  return number;
}
/// The inverse.
template <int dim>
MultiIndex<dim> index_in(const IndexBox<dim>& box, std::int64_t number) {
  MultiIndex<dim> index;
  for (int d = 0; d < dim; ++d) index[d] = static_cast<int>(number % box.upper[d]), number /= box.upper[d];
  return index;
}

/// A wall as explicit steps see it.
template <int dim>
struct ContactWall : Wall<dim> {
  explicit ContactWall(const Wall<dim>& wall) : Wall<dim>(wall) {}

  bool holds_normal() const { return this->options().kind != WallKind::tangential; }
  bool holds_tangent() const {
    return this->options().kind != WallKind::roller || this->options().friction > 0.0;
  }
  /// Only pushes. Then friction bounds the tangential impulse, or, where nothing slips, the touch itself.
  bool unilateral() const { return this->options().unilateral && holds_normal(); }
  bool slips() const { return this->options().kind == WallKind::roller; }
  /// Velocity (m/s) over a step that the wall prescribes besides its rigid motion, n its normal.
  Vec<dim> prescribed(const Vec<dim>& n, double t, double dt) const;
};

/// The masses of one step: what an impulse does to the velocity of the functions.
struct StepMass {
  std::span<const double> sums;  ///< n_functions x stride, the lumped mass first
  int stride = 0;
  std::span<const char> fixed;  ///< n_functions x dim flags of held unknowns, or empty
  /// Consistent mass: solves M dv = b (both n_functions x dim), dv = 0 where held. Empty: lumped.
  std::function<void(std::span<const double> b, std::span<double> dv)> solve;
};

/// What a wall did to the bodies in a step.
template <int dim>
struct WallReaction {
  Vec<dim> force = Vec<dim>::Zero();         ///< N
  Moment<dim> moment = Moment<dim>::Zero();  ///< N m (2D: N), about the centre of the wall's motion
};

/// Walls as projections of the velocity, so that the critical time step stays that of the free body.
///
/// Impulses lambda_r on the rows w_r = sum_i C_ri v_i (wall_rows.h) change the velocity by M^-1 C^T lambda.
/// One iteration over the rows of all walls (wall_system.h) finds those that make every row's velocity
/// admissible: with u = w - (velocity of the wall), u_n >= -max(gap, 0)/dt and lambda_n >= 0 where a wall
/// only pushes, u_n = 0 where it holds, |lambda_t| <= friction lambda_n where it rubs. They are the only
/// change of momentum. The velocity that strains the points is projected a second time, on the rows with an
/// impulse, without touching momentum. docs/theory/walls-explicit.md derives it and says what does not work.
///
/// Nothing is carried from step to step, so that a resumed run gives the same bits. On several ranks each one
/// keeps the rows of all, which are few beside the points, with the masses and velocities of their functions
/// as the owners know them, and finds all impulses itself: they are the same on every rank.
template <int dim>
class WallContact {
 public:
  /// `space` must outlive it. Collective, as all below. Errors (InputError): a wall wholly outside the grid.
  WallContact(const std::vector<Wall<dim>>& walls, const Space<dim>& space);

  bool empty() const { return walls_.empty(); }
  /// Whether it was made for this space: another distribution over the ranks needs another one.
  bool is_on(const Space<dim>& space) const { return space_ == &space; }

  /// Before the velocities of a step from t to t + dt: cuts walls that move, finds points near walls and the
  /// gap of every row. Points must have their cells (`locate`).
  void find(const std::vector<Body<dim>>& bodies, double t, double dt);

  /// Takes the velocity that the step would end with, `velocity` + dt `acceleration` (n_functions x dim), and
  /// adds to `acceleration` what the walls' impulses do.
  void correct_velocity(const StepMass& mass, std::span<const double> velocity, double dt,
                        std::span<double> acceleration);

  /// Adds the impulses over dt, C^T lambda/dt, to `force` (n_functions x dim).
  void add_force(double dt, std::span<double> force) const;

  /// Projects the velocity that strains the points (n_functions x dim) on the rows that carry an impulse: the
  /// normal part, the tangential one where it sticks. `alone`: the step's impulses are not known yet (USF)
  /// and the rows decide by this velocity.
  void correct_strain_velocity(const StepMass& mass, std::span<double> velocity, bool alone = false);

  /// For USL without domains: functions lighter than 0.05 of their mass in full cells take in `motion`
  /// (n_functions x stride, velocity and acceleration) the velocity of the momentum that the points will have
  /// at the end of the step, projected where rows carry an impulse. The points' velocity is then theirs plus
  /// dt times the acceleration (FLIP); with dt = 0 as it is.
  void calm_light_functions(const std::vector<Body<dim>>& bodies, const StepMass& mass, double dt,
                            std::span<double> motion, int stride);

  /// After the points have moved: those too close to a wall go back by a tenth of what is missing; with
  /// domains the velocities around loaded rows are blended by a tenth towards the mean rigid motions of the
  /// points at each function, momentum and angular momentum unchanged.
  void correct_points(std::vector<Body<dim>>& bodies);

  /// Of the last step, one a wall.
  const std::vector<WallReaction<dim>>& reactions() const { return reactions_; }
  /// Work (J) of the walls on the bodies in the last step, by the end-of-step velocity like all other work.
  double work() const { return work_; }
  /// Rows that took part in the last step, and sweeps that their impulses took.
  int n_rows() const { return static_cast<int>(live_.size()); }
  int sweeps() const { return system_.sweeps(); }

 private:
  struct PointOf {
    int body, point;
  };
  struct Touch {
    PointOf at;
    double missing;  ///< m, how much too close; negative: too far from a wall that holds
    Vec<dim> normal;
  };
  /// The functions of a row of the step.
  struct Live {
    int row = 0;
    std::size_t n = 0;
    std::array<int, WallRow<dim>::max_functions> slot{};       ///< of its functions in `value_`
    std::array<double, WallRow<dim>::max_functions> weight{};  ///< over functions with mass, sum one
  };

  // wall_contact_rows.cpp: rows from geometry
  void cut_walls(double t);
  void share_rows();
  void number_rows();
  void number_rows_on_triangles();
  void mark_cells();
  // wall_contact.cpp: what points and rows mean to each other
  void touch(const Body<dim>& body, PointOf at, double t);
  std::int64_t cell_number(const Vec<dim>& x) const;
  int row_at(int wall, const Vec<dim>& x, const Vec<dim>& normal) const;
  void choose_rows(double t, double dt);
  // wall_impulses.cpp: velocities
  /// `value_` from value_of(function, direction), asked of the functions that this rank owns.
  template <class F>
  void take_values(F&& value_of) {
    const bool alone = Session::size() == 1;
    for (std::size_t k = 0; k < functions_.size(); ++k)
      for (std::size_t d = 0; d < dim; ++d)
        value_[k * dim + d] = alone || (functions_[k] >= 0 && space_->nodes().owns(functions_[k]))
                                  ? value_of(static_cast<std::size_t>(functions_[k]), d)
                                  : 0.0;
    if (!alone) Session::sum_in_place(value_);
  }
  /// Calls take(function, direction, place in `value_`) for those that this rank knows.
  template <class F>
  void give_values(F&& take) const {
    for (std::size_t k = 0; k < functions_.size(); ++k)
      if (functions_[k] >= 0)
        for (std::size_t d = 0; d < dim; ++d) take(static_cast<std::size_t>(functions_[k]), d, k * dim + d);
  }
  void take_functions(const StepMass& mass);
  void take_masses(const StepMass& mass);
  void couple(const StepMass& mass);
  void couple_by_functions();
  void take_row_velocities();
  void find_impulses();
  void project();
  void set_reactions(double dt);
  void add_row(const Live& live, const Vec<dim>& impulse, std::span<double> sum) const;
  void spread(const StepMass& mass, std::span<double> change);
  void spread_lumped();
  // wall_points.cpp: points
  template <class F>
  void for_each_near_stencil(const std::vector<Body<dim>>& bodies, F&& f) const;
  bool in_window(const Vec<dim>& x) const;
  void blend(std::vector<Body<dim>>& bodies);
  void find_light_functions(const StepMass& mass, double light);
  void mark_cells_of(int function);
  void list_functions();

  std::vector<ContactWall<dim>> walls_;
  const Space<dim>* space_;
  WallCutter<dim> cutter_;
  bool any_moves_ = false;
  std::vector<std::vector<WallPiece<dim>>> pieces_;  // at rest
  std::vector<WallRow<dim>> rows_;                   // of all ranks, by wall and cell; functions by place in
  std::vector<std::int64_t> cell_of_row_;            // number in the whole grid
  std::vector<std::int64_t> wall_functions_;         // this list of their numbers in the whole grid
  std::vector<int> local_;                           // their numbers here, or -1
  std::vector<std::size_t> first_row_;               // one a wall, and the end
  std::vector<char> near_;                           // cells that a point near a wall can be in
  std::vector<int> near_cells_;
  std::vector<double> gap_;  // one a row
  std::vector<PointOf> points_;
  std::vector<Touch> touches_;
  std::vector<Live> live_;
  std::vector<RowState<dim>> states_;              // of the live rows
  WallSystem<dim> system_;                         // likewise
  std::vector<int> wall_slot_, slot_, functions_;  // slots of wall functions, of functions, and back; or -1
  std::vector<double> value_, inverse_;            // over slots x dim: velocity, inverse mass
  std::vector<double> spread_;                     // likewise: what a row does to the functions
  std::vector<std::vector<int>> rows_of_slot_;     // live rows
  std::vector<char> seen_;                         // over live rows
  std::vector<int> met_;
  std::vector<double> slot_mass_;             // over slots: mass, then for each direction 1 if free
  std::vector<double> momentum_;              // over slots or light functions
  std::vector<MeanMotion<dim>> mean_motion_;  // slots x, of loaded functions
  std::vector<int> light_functions_, light_number_, light_cells_;
  std::vector<char> light_cell_;
  std::vector<double> function_volume_;                 // of triangulations: integrals of the functions, m2
  std::vector<std::vector<int>> triangles_of_;          // likewise: where they are not zero
  std::vector<char> loaded_;                            // over slots: of a row with an impulse
  std::vector<Vec<dim>> impulses_;                      // of live rows
  std::vector<double> right_side_, solved_, coupling_;  // consistent mass; coupling_: rows x rows x dim
  bool consistent_ = false;
  std::vector<WallReaction<dim>> reactions_;
  double time_ = 0.0, work_ = 0.0;
};

extern template class WallContact<2>;
extern template class WallContact<3>;

}  // namespace wisp
