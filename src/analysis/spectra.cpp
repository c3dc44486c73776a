#include "analysis/spectra.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

template <int dim>
ExplicitSpectrum<dim>::ExplicitSpectrum(Model<dim>& model, Mass mass)
    : model_(model), consistent_(mass == Mass::consistent) {
  const auto& space = *model.space;
  const auto& ghost = model.options.stabilisation;
  lumped_.assign(static_cast<std::size_t>(space.n_functions()), 0.0);
  StoredStencils<dim> stencils;
  for (const auto& body : model.bodies) {
    tabulate(space, body.points, stencils);
    const auto width = static_cast<std::size_t>(stencils.n);
    for (std::size_t k = 0; k < stencils.phi.size(); ++k)
      lumped_[static_cast<std::size_t>(stencils.function[k])] +=
          stencils.phi[k] * body.points.mass[k / width];
  }
  space.nodes().add_update(lumped_.data());
  const ActiveCells cells = active_cells(space, model.bodies);
  std::vector<char> active = active_functions(space, ghost ? ghost_cells(space, cells, *ghost) : cells);
  if (!consistent_ || !ghost)
    for (std::size_t i = 0; i < active.size(); ++i) active[i] = lumped_[i] > 0.0;
  unknowns_ = DofMap(
      space.nodes(), dim, active,
      model.constraints.any ? std::span<const char>(model.constraints.fixed) : std::span<const char>());
  std::vector<GhostFacet> facets;
  if (consistent_ && ghost)
    facets = ghost_facets(space, cells, model.bodies, held_edges(model.boundaries), ghost->elements);
  mass_.begin_pattern(space.n_functions());
  add_point_pattern(space, model.bodies, mass_);
  add_ghost_pattern(space, facets, mass_);
  mass_.end_pattern();
  add_consistent_mass(space, model.bodies, mass_);
  if (!facets.empty()) add_ghost(space, facets, *ghost, GhostMatrix::mass, mass_);
}

template <int dim>
double ExplicitSpectrum<dim>::condition() const {
  if (consistent_) return condition_number(mass_, unknowns_);
  double least = std::numeric_limits<double>::infinity(), greatest = 0.0;
  for (const int k : unknowns_.owned()) {
    const double m = lumped_[static_cast<std::size_t>(k / dim)];
    least = std::min(least, m), greatest = std::max(greatest, m);
  }
  greatest = Session::max(greatest);
  return greatest > 0.0 ? greatest / Session::min(least) : 1.0;
}

template <int dim>
double ExplicitSpectrum<dim>::critical_time_step() {
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
  SystemMatrix k;
  k.assign(stiffness_, unknowns_);
  double greatest = 0.0;
  if (consistent_) {
    SystemMatrix m;
    m.assign(mass_, unknowns_);
    greatest = greatest_pencil_eigenvalue(k, m);
  } else {
    std::vector<double> diagonal;
    for (const int unknown : unknowns_.owned())
      diagonal.push_back(lumped_[static_cast<std::size_t>(unknown / dim)]);
    greatest = greatest_pencil_eigenvalue(k, diagonal);
  }
  return greatest > 0.0 ? 2.0 / std::sqrt(greatest) : std::numeric_limits<double>::infinity();
}

template class ExplicitSpectrum<2>;
template class ExplicitSpectrum<3>;

}  // namespace wisp
