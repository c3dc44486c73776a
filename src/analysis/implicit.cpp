#include "analysis/implicit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "linear/mass_solver.h"
#include "transfer/active.h"
#include "transfer/explicit_transfer.h"
#include "transfer/mass.h"

namespace wisp {

namespace {
template <class Options>
NewtonOptions newton_options(const Options& o) {
  NewtonOptions n;
  n.tolerance = o.tolerance, n.max_iterations = o.max_iterations, n.line_search = o.line_search;
  return n;
}

/// Sum of squares over this rank's own functions, all ranks.
double squared(const Halo& halo, std::span<const double> a, int components) {
  double sum = 0.0;
  for (int f = 0; f < halo.n_local(); ++f) {
    if (!halo.owns(f)) continue;
    for (int c = 0; c < components; ++c) {
      const double v = a[static_cast<std::size_t>(f * components + c)];
      sum += v * v;
    }
  }
  return Session::sum(sum);
}

/// What rounding alone makes of the forces on functions, N: strains carry that of a deformation gradient near
/// one and of differences of the displacements.
template <int dim>
double force_rounding(const Model<dim>& model, std::span<const double> u) {
  double modulus = 0.0, largest = 0.0;
  for (const auto& body : model.bodies) modulus = std::max(modulus, body.p_wave_modulus());
  for (const double v : u) largest = std::max(largest, std::abs(v));
  const double h = model.space->shortest_extent();
  return std::numeric_limits<double>::epsilon() * Session::max(modulus) * std::pow(h, dim - 2) *
         (h + Session::max(largest));
}
}  // namespace

template <int dim>
Implicit<dim>::Implicit(Model<dim>& model, const QuasiStaticOptions& o)
    : model_(model),
      duration_(o.duration),
      steps_(o.steps),
      cuts_(o.cuts),
      newton_(newton_options(o)),
      solver_(model.options.solver) {
  solver_.set_traits({dim, false, {}});
  prepare();
}

template <int dim>
Implicit<dim>::Implicit(Model<dim>& model, const ImplicitDynamicOptions& o)
    : model_(model),
      duration_(o.duration),
      steps_(o.steps),
      cuts_(o.cuts),
      newton_(newton_options(o)),
      solver_(model.options.solver) {
  solver_.set_traits({dim, false, {}});
  const double alpha = o.numerical_damping;
  newmark_ = Newmark{0.25 * (1.0 + alpha) * (1.0 + alpha), 0.5 + alpha};
  for (auto& body : model_.bodies)
    if (body.points.acceleration.empty())
      body.points.acceleration.assign(body.points.position.size(), Vec<dim>::Zero());
  prepare();
}

template <int dim>
void Implicit<dim>::renew_solver() {
  solver_ = LinearSolver(model_.options.solver);
  solver_.set_traits({dim, false, {}});
}

/// Everything that stays the same in a step: stencils, active functions, numbering, Ghost matrix, external
/// forces.
template <int dim>
void Implicit<dim>::set_up(double dt) {
  const auto& space = *model_.space;
  const auto n = static_cast<std::size_t>(space.n_functions());
  ActiveCells cells;
  {
    const auto timer = model_.timers.start("1 locate, stencils");
    model_.settle();
    stencils_.resize(model_.bodies.size());
    for (std::size_t b = 0; b < model_.bodies.size(); ++b)
      tabulate(space, model_.bodies[b].points, stencils_[b]);
    cells = active_cells(space, model_.bodies);
    active_ = active_functions(space, ghost_options_ ? ghost_cells(space, cells, *ghost_options_) : cells);
    external_force(model_.time + dt, external_);
    external_force(model_.time, start_external_);
  }
  if (walls_) start_walls(cells, dt);
  set_up_matrices(cells, dt);
  const auto timer = model_.timers.start("2 ghost matrix");
  number_unknowns();
  prescribed_.assign(n * dim, 0.0);
  set_increments(model_.boundaries, model_.time, dt, model_.constraints);
  for (std::size_t k = 0; k < model_.constraints.fixed.size(); ++k)
    if (model_.constraints.fixed[k] && active_[k / dim]) prescribed_[k] = model_.constraints.prescribed(k);
  reaction_.assign(n * dim, 0.0);
  evaluations_ = 0;
}

/// The pattern of all matrices, and those that stay the same in a step.
template <int dim>
void Implicit<dim>::set_up_matrices(const ActiveCells& cells, double dt) {
  const auto& space = *model_.space;
  const auto& options = ghost_options_;
  std::vector<GhostFacet> facets;
  {
    const auto timer = model_.timers.start("2 ghost matrix");
    if (options)
      facets = ghost_facets(space, cells, model_.bodies, held_edges(model_.boundaries), options->elements);
    ghost_.begin_pattern(space.n_functions());
    add_point_pattern(space, model_.bodies, ghost_);
    add_ghost_pattern(space, facets, ghost_);
    if (walls_)
      for_each<Wall, dim>(model_.boundaries,
                          [&](const Wall<dim>& wall, std::size_t) { wall.add_pattern(ghost_); });
    ghost_.end_pattern();
    if (options) add_ghost(space, facets, *options, GhostMatrix::stiffness, ghost_);
    stiffness_.share_pattern(ghost_);
  }
  if (walls_) assemble_walls();
  const auto timer = model_.timers.start("2 ghost matrix");
  if (newmark_) {
    mass_.share_pattern(ghost_);
    add_consistent_mass(space, model_.bodies, mass_);
    if (options) add_ghost(space, facets, *options, GhostMatrix::mass, mass_);
    start_inertia(dt);
  }
}

/// Numbers the unknowns the way the solver wants them; multigrid also gets their coordinates, for its
/// rigid-body modes.
template <int dim>
void Implicit<dim>::number_unknowns() {
  const auto& space = *model_.space;
  int unknowns = 0;
  for (int f = 0; f < space.n_functions(); ++f)
    if (active_[static_cast<std::size_t>(f)] && space.nodes().owns(f)) unknowns += dim;
  const FixedUnknowns mode = solver_.numbering(Session::sum(unknowns));
  dofs_ = DofMap(
      space.nodes(), dim, active_,
      model_.constraints.any ? std::span<const char>(model_.constraints.fixed) : std::span<const char>(),
      mode);
  MatrixTraits traits;
  traits.dim = dim;
  if (mode == FixedUnknowns::unit_rows)
    for (std::size_t k = 0; k < dofs_.owned().size(); k += dim) {
      const Vec<dim> x = space.node_position(dofs_.owned()[k] / dim);
      traits.coordinates.insert(traits.coordinates.end(), x.data(), x.data() + dim);
    }
  solver_.set_traits(std::move(traits));
}

/// Body forces and loads with start-of-step functions, owners and ghosts.
template <int dim>
void Implicit<dim>::external_force(double t, std::vector<double>& force) const {
  const auto& space = *model_.space;
  force.assign(static_cast<std::size_t>(space.n_functions()) * dim, 0.0);
  const Vec<dim> gravity = model_.gravity(t);
  if (!gravity.isZero())
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      const auto& stencils = stencils_[b];
      const auto width = static_cast<std::size_t>(stencils.n);
      for (std::size_t k = 0; k < stencils.phi.size(); ++k)
        Eigen::Map<Vec<dim>>(force.data() + stencils.function[k] * dim) +=
            stencils.phi[k] * model_.bodies[b].points.mass[k / width] * gravity;
    }
  model_.add_loads(t, force);
  space.nodes().add_update(force.data(), dim);
}

/// Velocity and acceleration of the functions at the start of the step, from the points' by the consistent
/// mass.
template <int dim>
void Implicit<dim>::start_inertia(double dt) {
  const auto& space = *model_.space;
  const auto n = static_cast<std::size_t>(space.n_functions());
  MassSolver solver;
  solver.set_matrix(
      mass_, space.nodes(), dim, active_,
      model_.constraints.any ? std::span<const char>(model_.constraints.fixed) : std::span<const char>());
  const auto map = [&](auto field, std::vector<double>& result, auto prescribe) {
    std::vector<double> right(n * dim, 0.0);
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      const auto& points = model_.bodies[b].points;
      const auto width = static_cast<std::size_t>(stencils_[b].n);
      for (std::size_t k = 0; k < stencils_[b].phi.size(); ++k)
        Eigen::Map<Vec<dim>>(right.data() + stencils_[b].function[k] * dim) +=
            stencils_[b].phi[k] * points.mass[k / width] * field(points)[k / width];
    }
    space.nodes().add_update(right.data(), dim);
    result.assign(n * dim, 0.0);
    for (std::size_t k = 0; k < model_.constraints.fixed.size(); ++k)
      if (model_.constraints.fixed[k] && active_[k / dim]) result[k] = prescribe(k);
    const SolveReport report = solver.solve(right, result);
    if (!report.solved)
      run_error("step {} at t = {:.6g} s: the consistent mass cannot be solved ({}); add [stabilisation]",
                model_.step, model_.time, report.cause);
  };
  set_velocities(model_.boundaries, model_.time - dt, dt, model_.constraints);
  map(
      [](const auto& points) -> const auto& { return points.velocity; }, velocity_,
      [&](std::size_t k) { return model_.constraints.prescribed(k); });
  map(
      [](const auto& points) -> const auto& { return points.acceleration; }, acceleration_,
      [](std::size_t) { return 0.0; });
  // What the momentum at the start would take to stop in the step: forces are differences of terms of this
  // size, so it belongs to the scale of the residual, or nothing converges when all forces pass through zero.
  std::vector<double> inertia(n * dim);
  const std::vector<double> none(n * dim, 0.0);
  mass_.multiply_columns(acceleration(none, dt), inertia, dim);
  space.nodes().add_update(inertia.data(), dim);
  inertia_scale_ = std::sqrt(squared(space.nodes(), inertia, dim));
}

/// a = (u - dt v_n - dt^2 (1/2 - beta) a_n) / (beta dt^2)  (Newmark 1959)
template <int dim>
std::vector<double> Implicit<dim>::acceleration(std::span<const double> u, double dt) const {
  std::vector<double> a(u.size());
  const double beta = newmark_->beta;
  for (std::size_t k = 0; k < a.size(); ++k)
    a[k] = (u[k] - dt * velocity_[k] - dt * dt * (0.5 - beta) * acceleration_[k]) / (beta * dt * dt);
  for (std::size_t k = 0; k < a.size(); ++k)
    if (!active_[k / dim]) a[k] = 0.0;
  return a;
}

template <int dim>
double Implicit<dim>::residual(std::span<const double> u, double dt) {
  const auto& space = *model_.space;
  const auto n = static_cast<std::size_t>(space.n_functions());
  std::vector<double> action(n * dim);
  for (std::size_t k = 0; k < action.size(); ++k) action[k] = external_[k] + reaction_[k];
  if (walls_) add_walls(u, action);
  const auto timer = model_.timers.start("3a residual");
  force_.assign(n * dim, 0.0);
  ghost_.multiply_columns(u, force_, dim);
  int inverted = 0;
  for (std::size_t b = 0; b < model_.bodies.size(); ++b)
    inverted += add_internal_force(stencils_[b], model_.bodies[b], u, dt, force_);
  if (newmark_) {
    std::vector<double> inertia(n * dim);
    mass_.multiply_columns(acceleration(u, dt), inertia, dim);
    for (std::size_t k = 0; k < inertia.size(); ++k) force_[k] += inertia[k];
  }
  space.nodes().add_update(force_.data(), dim);
  residual_.resize(n * dim);
  for (std::size_t k = 0; k < residual_.size(); ++k) residual_[k] = action[k] - force_[k];
  ++evaluations_;
  if (Session::sum(inverted) > 0) return std::numeric_limits<double>::quiet_NaN();
  const double r = std::sqrt(squared(space.nodes(), residual_, dim));
  double scale = std::sqrt(squared(space.nodes(), action, dim));
  if (newmark_) scale += std::sqrt(squared(space.nodes(), force_, dim)) + inertia_scale_;
  // The first evaluation, before any correction, never ends a step: prescribed motion has yet to be applied.
  // Where nothing but a prescribed motion acts, there is no scale before that has found its reactions; where
  // that is rigid there is none at all, and rounding over rounding says nothing.
  const double relative = r <= force_rounding(model_, u) ? 0.0 : scale > 0 ? r / scale : 1.0;
  return evaluations_ == 1 ? std::max(relative, 1.0) : relative;
}

template <int dim>
std::string Implicit<dim>::correct(std::span<double> du, std::span<const double> u, double dt) {
  const auto& space = *model_.space;
  {
    const auto timer = model_.timers.start("3b tangent");
    stiffness_.zero();
    for (std::size_t b = 0; b < model_.bodies.size(); ++b)
      add_stiffness(stencils_[b], model_.bodies[b], u, dt, stiffness_);
    stiffness_.add_matrix(1.0, ghost_);
    if (newmark_) stiffness_.add_matrix(1.0 / (newmark_->beta * dt * dt), mass_);
  }
  if (walls_) add_wall_stiffness();
  const auto timer = model_.timers.start("3c solve");
  std::vector<double> lift(du.size(), 0.0), right(residual_), product(du.size());
  for (std::size_t k = 0; k < model_.constraints.fixed.size(); ++k)
    if (model_.constraints.fixed[k] && active_[k / dim]) lift[k] = prescribed_[k] - u[k];
  if (model_.constraints.any) {
    stiffness_.multiply(lift, product);
    space.nodes().add_update(product.data(), dim);
    for (std::size_t k = 0; k < right.size(); ++k) right[k] -= product[k];
  }
  system_.assign(stiffness_, dofs_);
  std::fill(du.begin(), du.end(), 0.0);
  const SolveReport report = solver_.solve(system_, dofs_, space.nodes(), right, du);
  if (!report.solved) return report.cause;
  for (std::size_t k = 0; k < du.size(); ++k) du[k] += lift[k];
  if (model_.constraints.any) {
    stiffness_.multiply(du, product);
    space.nodes().add_update(product.data(), dim);
    for (std::size_t k = 0; k < du.size(); ++k)
      if (model_.constraints.fixed[k] && active_[k / dim]) reaction_[k] += product[k] - residual_[k];
  }
  return {};
}

/// Velocities and accelerations of the points from the change of the functions' (FLIP).
template <int dim>
void Implicit<dim>::update_velocities(std::span<const double> u, double dt) {
  const std::vector<double> a = acceleration(u, dt);
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    auto& points = model_.bodies[b].points;
    const auto width = static_cast<std::size_t>(stencils_[b].n);
    for (std::size_t p = 0; p < points.position.size(); ++p) {
      Vec<dim> now = Vec<dim>::Zero(), before = Vec<dim>::Zero();
      for (std::size_t k = p * width; k < (p + 1) * width; ++k) {
        now += stencils_[b].phi[k] * Eigen::Map<const Vec<dim>>(a.data() + stencils_[b].function[k] * dim);
        before += stencils_[b].phi[k] *
                  Eigen::Map<const Vec<dim>>(acceleration_.data() + stencils_[b].function[k] * dim);
      }
      points.velocity[p] += dt * ((1.0 - newmark_->gamma) * before + newmark_->gamma * now);
      points.acceleration[p] = now;
    }
  }
}

template <int dim>
void Implicit<dim>::finish(std::span<const double> u, double dt) {
  points_changed_ = true;
  for (auto& r : model_.reactions) r.setZero();
  if (walls_) finish_walls(u, dt);
  const auto timer = model_.timers.start("4 move, commit");
  const auto& space = *model_.space;
  displacement_.assign(u.begin(), u.end());
  double work = 0.0;
  std::vector<Vec<dim>> held(model_.reactions.size(), Vec<dim>::Zero());
  for (int i = 0; i < space.n_functions(); ++i) {
    if (!space.nodes().owns(i)) continue;
    for (int d = 0; d < dim; ++d) {
      const auto k = static_cast<std::size_t>(i * dim + d);
      work += 0.5 * (external_[k] + start_external_[k]) * u[k];
      if (!model_.constraints.any || !model_.constraints.fixed[k]) continue;
      held[static_cast<std::size_t>(model_.constraints.condition[k])][d] += reaction_[k];
      work += reaction_[k] * u[k];
    }
  }
  model_.external_work += Session::sum(work);
  for (std::size_t k = 0; k < held.size(); ++k) model_.reactions[k] += Session::sum(held[k]);
  model_.move_loads(u, dim, 1.0);
  if (newmark_) update_velocities(u, dt);
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) commit(stencils_[b], model_.bodies[b], u);
  model_.time += dt;
  points_changed_ = false;
}

template <int dim>
NewtonReport Implicit<dim>::attempt(double dt) {
  set_up(dt);
  std::vector<double> u(static_cast<std::size_t>(model_.space->n_functions()) * dim, 0.0);
  std::vector<double> last(u);
  NewtonReport report = newton(
      newton_, u,
      [&](std::span<const double> now) {
        last.assign(now.begin(), now.end());
        return residual(now, dt);
      },
      [&](std::span<double> du) { return correct(du, last, dt); });
  if (report.converged) finish(u, dt);
  return report;
}

template <int dim>
void Implicit<dim>::advance(double dt, int cuts_left, ImplicitRecord& record) {
  const NewtonReport report = attempt(dt);
  record.iterations += report.iterations;
  record.residuals = report.residuals;
  record.margin = std::min(record.margin, report.margin);
  if (report.converged) return;
  if (cuts_left > 0) {
    ++record.cuts;
    advance(0.5 * dt, cuts_left - 1, record);
    advance(0.5 * dt, cuts_left - 1, record);
    return;
  }
  std::string residuals;
  for (const double r : report.residuals)
    residuals += fmt::format("{}{:.3e}", residuals.empty() ? "" : ", ", r);
  run_error(
      "step {} at t = {:.6g} s did not converge: {} (residuals {}); try more steps, cuts = 5, line_search = "
      "true, or [stabilisation]",
      model_.step + 1, model_.time, report.cause, residuals);
}

template <int dim>
ImplicitRecord Implicit<dim>::step(double dt, EnergyRecord* energies) {
  ImplicitRecord record;
  record.margin = std::numeric_limits<double>::infinity();
  advance(dt, cuts_, record);
  ++model_.step;
  if (energies) {
    *energies = {};
    for (const auto& body : model_.bodies) {
      const BodyEnergy e = energy(body);
      energies->kinetic += e.kinetic, energies->strain += e.strain, energies->dissipation += e.dissipation;
    }
    const Vec<3> sum = Session::sum(Vec<3>(energies->kinetic, energies->strain, energies->dissipation));
    energies->kinetic = sum[0], energies->strain = sum[1], energies->dissipation = sum[2];
    energies->external_work = model_.external_work;
  }
  return record;
}

template class Implicit<2>;
template class Implicit<3>;

}  // namespace wisp
