// What an analysis works on: the discretisation, the bodies, what acts on them, and where the run stands.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "basis/space.h"
#include "boundary/list.h"
#include "core/timers.h"
#include "grid/triangulation_options.h"
#include "linear/solver.h"
#include "particle/body.h"
#include "particle/body_options.h"
#include "particle/order.h"
#include "stabilise/ghost_options.h"

namespace wisp {

/// The parts of a case that do not depend on its stages.
struct ModelOptions {
  StructuredGridOptions grid;
  std::optional<AnyTriangulationOptions> triangulation;  ///< instead of the structured grid (2D)
  AnyBasisOptions basis;
  std::vector<BodyOptions> bodies;
  std::vector<AnyBoundaryOptions> boundaries;
  std::vector<AnyLoadOptions> loads;
  std::optional<GravityOptions> gravity;
  std::optional<GhostOptions> stabilisation;
  SolverOptions solver;
  std::filesystem::path folder;  ///< where relative file names start

  Leaving leaving() const {
    return triangulation ? std::visit([](const auto& t) { return t.leaving; }, *triangulation) : grid.leaving;
  }
};

/// A run on this rank. Plain members: analyses change them, output reads them.
template <int dim>
struct Model {
  /// Splits the grid by the points of the bodies and samples those of this rank. Collective. Errors
  /// (InputError): also a triangulation on several ranks or in 3D, a basis that the grid does not have.
  explicit Model(const ModelOptions& options);

  ModelOptions options;
  std::unique_ptr<Space<dim>> space;
  std::vector<Body<dim>> bodies;
  std::vector<AnyBoundary<dim>> boundaries;
  Constraints<dim> constraints;
  std::vector<AnyLoad<dim>> loads;

  /// Body force per mass (m/s2) besides gravity at a point's initial position (m) and a time (s); not in case
  /// files. Forces that make a chosen motion the exact solution come in here.
  std::function<Vec<dim>(const Vec<dim>& start, double t)> body_acceleration;

  double time = 0.0;                 ///< s
  std::int64_t step = 0;             ///< finished steps, over all stages
  std::int64_t reorderings = 0;      ///< times the points of a body were put in order, this rank
  std::int64_t removed = 0;          ///< points removed because they left the grid, all ranks
  double external_work = 0.0;        ///< J, of body forces, loads and prescribed motion, all ranks
  std::vector<Vec<dim>> reactions;   ///< N, on the bodies, one a boundary, all ranks, of the last step
  std::vector<Moment<dim>> moments;  ///< of the reactions of walls, about Wall::motion().centre(t), likewise
  Timers timers;

  Vec<dim> gravity(double t) const;
  bool has_loads() const { return !loads.empty() || body_acceleration; }
  /// Moves what of the loads moves with the bodies, see boundary/list.h.
  void move_loads(std::span<const double> field, int stride, double factor);
  /// Adds loads and body_acceleration at time t to `force` (n_functions x dim), this rank's
  /// share.
  void add_loads(double t, std::span<double> force) const;
  std::int64_t n_points() const;  ///< all ranks

  /// Before a step: finds the points' cells, moves points to the ranks that own them, puts them in cell order
  /// and chooses the stencils' width. Collective. Errors (RunError): points left the grid and the case says
  /// stop; domains too large.
  void settle();
  /// Splits the grid anew when the imbalance of points passes 10 %. Collective; between steps only.
  /// Whether it was split anew: arrays over functions are then those of another window.
  bool rebalance();
  /// Splits the grid in the given way. Points stay where they are: see `keep_owned`, `settle`.
  void make_space(const BoxPartition<dim>& partition);
  /// Of points that every rank has, keeps those of this rank's cells, in cell order; points outside the grid
  /// stay on rank 0, for `settle`.
  void keep_owned();

 private:
  void sample_on_grid();
  void sample_on_triangulation();
  Location find_cells(Particles<dim>& points) const;
  void remove_outside(std::size_t outside);
  void migrate();
  void choose_width();
  std::string oversized_domain() const;

  std::vector<int> disorder_;  // of every body; kept, so that steps allocate nothing
  OrderMemory order_memory_;   // likewise
};

}  // namespace wisp
