// The equations between the rows of walls in an explicit step, and the impulses that solve them.
#pragma once
#include <span>
#include <utility>
#include <vector>

#include "tensor/tensor.h"

namespace wisp {

/// What a row asks for in a step, and its impulse.
template <int dim>
struct RowState {
  Vec<dim> normal, target;  ///< target: velocity of the wall, m/s
  double bias = 0.0;        ///< least u_n, m/s
  bool normal_held = false, tangent_held = false, pushes = false, slips = false, sticks = false;
  double friction = 0.0;
  double lambda_n = 0.0;                 ///< N s
  Vec<dim> lambda_t = Vec<dim>::Zero();  ///< N s

  Vec<dim> impulse() const { return lambda_n * normal + lambda_t; }
  bool loaded() const { return lambda_n != 0.0 || !lambda_t.isZero(0.0); }
};

/// Rows r with velocities w_r that impulses change by A lambda, A = C M^-1 C^T, one number a direction and
/// pair of rows. Neighbouring rows share most of their functions, so A is nearly singular: the iteration of
/// Gauss and Seidel alone would need as many sweeps as the square of the rows along a wall. It only finds
/// which rows carry what; the equations of those are solved at once, in turns (projected Gauss-Seidel with
/// subspace minimisation, Silcowitz, Niebe and Erleben 2010): by a band of L D L^T, or where that is wide, as
/// beside large surfaces in 3D, by conjugate gradients. No library's factorisation: those allocate, and a
/// step must not.
///
/// A row yields by `yield` A_rr lambda_r, which makes rows that say the same twice share an impulse.
template <int dim>
class WallSystem {
 public:
  static constexpr double yield = 1e-4;

  /// Drops all rows.
  void clear();
  /// Adds to the row under way what an impulse on row `other` does to it (1/kg); `end_row` begins the next.
  void add(int other, const Vec<dim>& a);
  void end_row();
  int n_rows() const { return static_cast<int>(first_.size()) - 1; }

  /// Velocities of the rows, m/s, which the functions below read and change.
  std::vector<Vec<dim>>& velocity() { return velocity_; }
  const std::vector<Vec<dim>>& velocity() const { return velocity_; }

  /// Impulses of the rows, from zero: u_n >= bias and lambda_n >= 0 where a wall pushes, u_n = bias where it
  /// holds, Coulomb's cone where it rubs (u = velocity - target).
  void find(std::span<RowState<dim>> rows);

  /// Impulses, added to `impulse`, that make rows that are loaded equalities: u_n = bias, u_t = 0 where they
  /// stick.
  void project(std::span<const RowState<dim>> rows, std::span<Vec<dim>> impulse);

  /// Sweeps and solves of the last `find`.
  int sweeps() const { return sweeps_; }
  int solves() const { return solves_; }

 private:
  struct Entry {
    int row;
    Vec<dim> a;
  };
  /// A direction of a row, and its right side: what its velocity lacks.
  struct Unknown {
    int row;
    Vec<dim> along;
    double lack;
    bool normal;
  };
  double yielding(int r, const Vec<dim>& along) const;
  void push(int r, const Vec<dim>& impulse);
  double solve_normal(RowState<dim>& row, int r);
  double solve_tangent(RowState<dim>& row, int r);
  double sweep(std::span<RowState<dim>> rows, bool back);
  void solve_active(std::span<RowState<dim>> rows);
  template <class Add>
  void list_unknowns(Add&& add);
  void add_unknown(int r, const Vec<dim>& along, double lack, bool normal);
  void add_tangents(int r, const Vec<dim>& normal, const Vec<dim>& lack);
  void order_rows();
  void solve_unknowns();
  double measure();
  void iterate();
  void apply(const std::vector<double>& x, std::vector<double>& y);
  void assemble();
  void factor();
  void back_substitute();

  std::vector<int> first_{0};  // of the entries of a row, and the end
  std::vector<Entry> entries_;
  std::vector<Vec<dim>> velocity_, diagonal_;
  std::vector<int> order_, place_, queue_;        // rows by place, and back
  std::vector<std::pair<int, int>> unknowns_of_;  // first unknown of a row, and how many
  std::vector<Unknown> unknowns_;
  std::vector<int> low_;            // first column of a row of the factor
  std::vector<std::size_t> start_;  // where it is in `factor_`
  std::vector<double> factor_, change_, pivot_;
  std::vector<double> rest_, search_, image_;  // of conjugate gradients
  std::vector<Vec<dim>> pushed_;               // over rows
  bool ordered_ = false;
  int sweeps_ = 0, solves_ = 0;
};

extern template class WallSystem<2>;
extern template class WallSystem<3>;

}  // namespace wisp
