#include "analysis/spectra.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "linear/spectrum.h"
#include "linear/system_matrix.h"
#include "stabilise/ghost.h"
#include "transfer/active.h"
#include "transfer/implicit_transfer.h"
#include "transfer/mass.h"

namespace wisp {

double condition_number(const BlockMatrix& matrix, const DofMap& unknowns) {
  SystemMatrix system;
  system.assign(matrix, unknowns);
  return eigenvalue_extremes(system).condition();
}

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

template <int dim>
std::vector<double> lumped_mass(const Space<dim>& space, const std::vector<Body<dim>>& bodies) {
  std::vector<double> lumped(static_cast<std::size_t>(space.n_functions()), 0.0);
  StoredStencils<dim> stencils;
  for (const auto& body : bodies) {
    tabulate(space, body.points, stencils);
    const auto width = static_cast<std::size_t>(stencils.n);
    for (std::size_t k = 0; k < stencils.phi.size(); ++k)
      lumped[static_cast<std::size_t>(stencils.function[k])] += stencils.phi[k] * body.points.mass[k / width];
  }
  space.nodes().add_update(lumped.data());
  return lumped;
}

}  // namespace

template <int dim>
ExplicitSpectrum<dim>::ExplicitSpectrum(Model<dim>& model, const ExplicitOptions& options)
    : model_(model),
      options_(options),
      lumped_(lumped_mass(*model.space, model.bodies)),
      equation_({options.mass, options.fmpm_order, options.deactivate_below}) {
  const auto& space = *model.space;
  const bool ghost = model.options.stabilisation && options.mass == Mass::consistent;
  exact_ = options.mass == Mass::consistent && !ghost;
  const ActiveCells cells = active_cells(space, model.bodies);
  std::vector<char> active =
      active_functions(space, ghost ? ghost_cells(space, cells, *model.options.stabilisation) : cells);
  if (!ghost)
    for (std::size_t i = 0; i < active.size(); ++i) active[i] = lumped_[i] > 0.0;
  std::vector<GhostFacet> facets;
  if (ghost)
    facets = ghost_facets(space, cells, model.bodies, held_edges(model.boundaries),
                          model.options.stabilisation->elements);
  mass_.begin_pattern(space.n_functions());
  add_point_pattern(space, model.bodies, mass_);
  add_ghost_pattern(space, facets, mass_);
  mass_.end_pattern();
  add_consistent_mass(space, model.bodies, mass_);
  point_mass_ = mass_;
  if (ghost) add_ghost(space, facets, *model.options.stabilisation, GhostMatrix::mass, mass_);
  std::vector<char> fixed =
      model.constraints.any ? model.constraints.fixed : std::vector<char>(active.size() * dim, 0);
  if (options.mass != Mass::lumped) {
    std::vector<char> boundary;
    if (options.mass == Mass::partial) boundary = boundary_functions(space, cells);
    equation_.set_matrix(mass_, space.nodes(), dim, active, fixed, lumped_, boundary);
    active.assign(equation_.active().begin(), equation_.active().end());
    // The system that is solved has no lumped rows.
    solved_ = DofMap(space.nodes(), dim, active, equation_.held());
  }
  unknowns_ = DofMap(space.nodes(), dim, active, fixed);
}

template <int dim>
double ExplicitSpectrum<dim>::condition() const {
  if (options_.mass == Mass::consistent || options_.mass == Mass::partial)
    return condition_number(mass_, solved_);
  double least = std::numeric_limits<double>::infinity(), greatest = 0.0;
  for (const int k : unknowns_.owned()) {
    const double m = lumped_[static_cast<std::size_t>(k / dim)];
    least = std::min(least, m), greatest = std::max(greatest, m);
  }
  greatest = Session::max(greatest);
  return greatest > 0.0 ? greatest / Session::min(least) : 1.0;
}

template <int dim>
void ExplicitSpectrum<dim>::assemble_stiffness() {
  const auto& space = *model_.space;
  const std::vector<double> rest(lumped_.size() * dim, 0.0);
  std::vector<double> force(rest);
  stiffness_.share_pattern(mass_);
  StoredStencils<dim> stencils;
  for (auto& body : model_.bodies) {
    tabulate(space, body.points, stencils);
    add_internal_force(stencils, body, rest, 0.0, force);  // leaves the trial states that the tangent needs
    add_stiffness(stencils, body, rest, 0.0, stiffness_);
  }
}

/// x = W b.
template <int dim>
void ExplicitSpectrum<dim>::inverse_mass(const std::vector<double>& b, std::vector<double>& x) {
  x.assign(b.size(), 0.0);
  if (options_.mass != Mass::lumped) {
    const SolveReport report = equation_.solve(b, x);
    if (!report.solved)
      run_error("the critical time step: the mass cannot be solved with ({})", report.cause);
    return;
  }
  for (const int k : unknowns_.owned()) x[at(k)] = b[at(k)] / lumped_[at(k / dim)];
  model_.space->nodes().update(x.data(), dim);
}

/// y = M x at free unknowns.
template <int dim>
void ExplicitSpectrum<dim>::point_mass(const std::vector<double>& x, std::vector<double>& y) {
  product_.resize(x.size());
  point_mass_.multiply_columns(x, product_, dim);
  take(y);
}

/// y = K x at free unknowns.
template <int dim>
void ExplicitSpectrum<dim>::stiffness(const std::vector<double>& x, std::vector<double>& y) {
  product_.resize(x.size());
  stiffness_.multiply(x, product_);
  take(y);
}

/// The product of this rank and of the others, at free unknowns.
template <int dim>
void ExplicitSpectrum<dim>::take(std::vector<double>& y) {
  model_.space->nodes().add(product_.data(), dim);
  y.assign(product_.size(), 0.0);
  for (const int k : unknowns_.owned()) y[at(k)] = product_[at(k)];
  model_.space->nodes().update(y.data(), dim);
}

/// x = W M W b, or (2 W - W M W) b where points move by the velocity of the start and the acceleration.
template <int dim>
void ExplicitSpectrum<dim>::step_inverse(const std::vector<double>& b, std::vector<double>& x) {
  inverse_mass(b, first_);
  point_mass(first_, second_);
  inverse_mass(second_, x);
  if (options_.stress_update == StressUpdate::usl)
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = 2.0 * first_[k] - x[k];
}

template <int dim>
double ExplicitSpectrum<dim>::critical_time_step() {
  assemble_stiffness();
  double greatest = 0.0;
  if (exact_) {
    SystemMatrix k, m;
    k.assign(stiffness_, unknowns_), m.assign(mass_, unknowns_);
    greatest = greatest_pencil_eigenvalue(k, m);
  } else if (unknowns_.n_global() > 0) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> share(-1.0, 1.0);
    std::vector<double> start(lumped_.size() * dim, 0.0);
    for (const int k : unknowns_.owned()) start[at(k)] = share(random) * lumped_[at(k / dim)];
    model_.space->nodes().update(start.data(), dim);
    const auto dot = [&](const std::vector<double>& a, const std::vector<double>& b) {
      double sum = 0.0;
      for (const int k : unknowns_.owned()) sum += a[at(k)] * b[at(k)];
      return Session::sum(sum);
    };
    const auto k = [&](const auto& x, auto& y) { stiffness(x, y); };
    const auto b = [&](const auto& x, auto& y) { step_inverse(x, y); };
    std::vector<double> between;
    const auto both = [&](const auto& x, auto& y) { b(x, between), k(between, y); };
    greatest = options_.mass == Mass::partial ? greatest_magnitude(both, dot, std::move(start))
                                              : greatest_product_eigenvalue(k, b, dot, std::move(start));
  }
  return greatest > 0.0 ? 2.0 / std::sqrt(greatest) : std::numeric_limits<double>::infinity();
}

template class ExplicitSpectrum<2>;
template class ExplicitSpectrum<3>;

}  // namespace wisp
