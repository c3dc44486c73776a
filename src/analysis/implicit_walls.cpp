// Walls in implicit steps.
#include "analysis/implicit.h"

#include <algorithm>

#include "boundary/wall_host.h"

namespace wisp {

/// Names the parts of a step, and chooses Ghost: as the case says, or for walls in their consistent form what
/// they need (docs/theory/implicit-boundaries.md). On triangulations that is Ghost on a ring around the body,
/// which ties triangles that touch it in a vertex only.
template <int dim>
void Implicit<dim>::prepare() {
  ghost_options_ = model_.options.stabilisation;
  for_each<Wall, dim>(model_.boundaries, [&](const Wall<dim>& wall, std::size_t) {
    walls_ = true;
    const WallOptions& o = wall.options();
    const bool triangles = !model_.space->structured();
    const double ghost = o.ghost.value_or(on_splines(*model_.space) ? 0.1 : triangles ? 5e-2 : 3e-2);
    if (model_.options.stabilisation || o.mode == WallMode::literal || ghost == 0.0) return;
    if (!ghost_options_) ghost_options_ = GhostOptions(), ghost_options_->stiffness = 0.0;
    if (triangles) ghost_options_->elements = GhostElements::ring;
    ghost_options_->stiffness = std::max(ghost_options_->stiffness, ghost);
  });
  model_.timers.part("1 locate, stencils");
  model_.timers.part("2 ghost matrix");
  for (const char* name : {"3a residual", "3b tangent", "3c solve", "4 move, commit"})
    model_.timers.part(name);
  if (walls_) model_.timers.part("walls");
}

template <int dim>
void Implicit<dim>::start_walls(const ActiveCells& cells, double dt) {
  const auto timer = model_.timers.start("walls");
  for_each<Wall, dim>(model_.boundaries, [&](Wall<dim>& wall, std::size_t) {
    wall.begin_step(*model_.space, cells, model_.bodies, model_.time, dt);
  });
}

/// What walls take up in a step is linear in the displacement, so their tangent is exact.
template <int dim>
void Implicit<dim>::assemble_walls() {
  const auto timer = model_.timers.start("walls");
  wall_matrix_.share_pattern(ghost_);
  wall_force_.assign(static_cast<std::size_t>(model_.space->n_functions()) * dim, 0.0);
  for_each<Wall, dim>(model_.boundaries, [&](const Wall<dim>& wall, std::size_t) {
    wall.add_stiffness(wall_matrix_);
    wall.add_force(wall_force_);
  });
}

/// Takes what walls take up at a displacement from the forces on the functions; owners and ghosts.
template <int dim>
void Implicit<dim>::add_walls(std::span<const double> u, std::vector<double>& action) {
  const auto timer = model_.timers.start("walls");
  wall_action_.resize(action.size());
  wall_matrix_.multiply(u, wall_action_);
  for (std::size_t k = 0; k < wall_action_.size(); ++k) wall_action_[k] += wall_force_[k];
  model_.space->nodes().add_update(wall_action_.data(), dim);
  for (std::size_t k = 0; k < action.size(); ++k) action[k] -= wall_action_[k];
}

template <int dim>
void Implicit<dim>::add_wall_stiffness() {
  const auto timer = model_.timers.start("walls");
  stiffness_.add_matrix(1.0, wall_matrix_);
}

template <int dim>
void Implicit<dim>::finish_walls(std::span<const double> u, double dt) {
  const auto timer = model_.timers.start("walls");
  for_each<Wall, dim>(model_.boundaries, [&](Wall<dim>& wall, std::size_t k) {
    wall.finish(u, model_.time, dt);
    model_.reactions[k] = wall.reaction, model_.moments[k] = wall.moment;
    model_.external_work += wall.work;
  });
}

template void Implicit<2>::prepare();
template void Implicit<2>::start_walls(const ActiveCells&, double);
template void Implicit<2>::assemble_walls();
template void Implicit<2>::add_walls(std::span<const double>, std::vector<double>&);
template void Implicit<2>::add_wall_stiffness();
template void Implicit<2>::finish_walls(std::span<const double>, double);
template void Implicit<3>::prepare();
template void Implicit<3>::start_walls(const ActiveCells&, double);
template void Implicit<3>::assemble_walls();
template void Implicit<3>::add_walls(std::span<const double>, std::vector<double>&);
template void Implicit<3>::add_wall_stiffness();
template void Implicit<3>::finish_walls(std::span<const double>, double);

}  // namespace wisp
