// Every boundary and every load that a case file can name. A new one is one file and one word here.
//
// A boundary has a name() and any of these hooks; absent ones cost nothing:
//     constrain(index, Constraints&)      once: holds unknowns of the grid
//     increment(t, dt), velocity(t, dt)   what the held unknowns do in a step
//     on_edge(direction, side)            holds a whole edge of the grid
//     edges()                             edges of a triangulation that it holds
//     holds(direction)                    its reaction has a component there
//     begin_step, add_pattern, add_stiffness, add_force, finish    implicit steps, see Wall
//     reaction, moment, work              members, if it finds its reactions itself
//
// A load has a name() and
//     add_force(space, bodies, t, force)  adds this rank's share to an array over functions and directions
// and may have
//     settle(space, active)               before a step, when the points have their cells
//     move(space, field, stride, factor)  after a step, with its field of displacements or velocities
//     for_each_field(f)                   arrays that checkpoints keep
#pragma once
#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "basis/facet.h"
#include "boundary/conforming.h"
#include "boundary/point_load.h"
#include "boundary/traction.h"
#include "boundary/wall.h"
#include "core/error.h"

namespace wisp {

using AnyBoundaryOptions = std::variant<ConformingOptions, WallOptions>;
template <>
inline constexpr int default_alternative<AnyBoundaryOptions> = 0;

template <int dim>
using AnyBoundary = std::variant<Conforming<dim>, Wall<dim>>;

using AnyLoadOptions = std::variant<PointLoadOptions, TractionOptions>;
template <>
inline constexpr int default_alternative<AnyLoadOptions> = 0;

template <int dim, class List>
struct LoadVariant;
template <int dim, class... Options>
struct LoadVariant<dim, std::variant<Options...>> {
  using type = std::variant<typename Options::template Load<dim>...>;
};
template <int dim>
using AnyLoad = typename LoadVariant<dim, AnyLoadOptions>::type;

/// Collective; `bodies` are this rank's.
template <int dim>
AnyLoad<dim> make_load(const AnyLoadOptions& options, const std::vector<Body<dim>>& bodies,
                       const Space<dim>& space) {
  return std::visit(
      [&](const auto& o) -> AnyLoad<dim> {
        return typename std::decay_t<decltype(o)>::template Load<dim>(o, bodies, space);
      },
      options);
}

template <int dim>
AnyBoundary<dim> make_boundary(const AnyBoundaryOptions& options, const Space<dim>& space,
                               const std::filesystem::path& folder = {}) {
  if (const auto* conforming = std::get_if<ConformingOptions>(&options))
    return Conforming<dim>(*conforming, space);
  const auto& wall = std::get<WallOptions>(options);
  if (space.structured() && !space.nodal())
    input_error("boundary '{}': walls on structured grids need linear or GIMP functions", wall.label);
  return Wall<dim>(wall, folder);
}

template <int dim>
const std::string& name(const AnyBoundary<dim>& boundary) {
  return std::visit([](const auto& b) -> const std::string& { return b.name(); }, boundary);
}

/// Calls f(boundary, index) for every boundary of one type.
template <template <int> class B, int dim, class F>
void for_each(std::vector<AnyBoundary<dim>>& boundaries, F&& f) {
  for (std::size_t k = 0; k < boundaries.size(); ++k)
    if (auto* b = std::get_if<B<dim>>(&boundaries[k])) f(*b, k);
}
template <template <int> class B, int dim, class F>
void for_each(const std::vector<AnyBoundary<dim>>& boundaries, F&& f) {
  for (std::size_t k = 0; k < boundaries.size(); ++k)
    if (const auto* b = std::get_if<B<dim>>(&boundaries[k])) f(*b, k);
}

/// Whether the reaction of a boundary can have a component in a direction.
template <int dim>
bool holds(const AnyBoundary<dim>& boundary, int direction) {
  return std::visit(
      [&](const auto& b) {
        if constexpr (requires { b.holds(direction); }) return b.holds(direction);
        return true;
      },
      boundary);
}

/// The unknowns that the boundaries hold.
template <int dim>
Constraints<dim> constraints_of(const std::vector<AnyBoundary<dim>>& boundaries, int n_functions) {
  Constraints<dim> c(n_functions, boundaries.size());
  for (std::size_t k = 0; k < boundaries.size(); ++k)
    std::visit(
        [&](const auto& b) {
          if constexpr (requires { b.constrain(k, c); }) b.constrain(k, c), c.any = true;
        },
        boundaries[k]);
  return c;
}

/// Sets `motion` to the displacement (m) over a step from t to t + dt.
template <int dim>
void set_increments(const std::vector<AnyBoundary<dim>>& boundaries, double t, double dt,
                    Constraints<dim>& c) {
  for (std::size_t k = 0; k < boundaries.size(); ++k)
    std::visit(
        [&](const auto& b) {
          if constexpr (requires { b.constrain(k, c); }) c.motion[k] = b.increment(t, dt);
        },
        boundaries[k]);
}

/// Sets `motion` to the velocity (m/s) at the end of a step from t to t + dt.
template <int dim>
void set_velocities(const std::vector<AnyBoundary<dim>>& boundaries, double t, double dt,
                    Constraints<dim>& c) {
  for (std::size_t k = 0; k < boundaries.size(); ++k)
    std::visit(
        [&](const auto& b) {
          if constexpr (requires { b.constrain(k, c); }) c.motion[k] = b.velocity(t, dt);
        },
        boundaries[k]);
}

/// Which edges of the grid the boundaries hold.
template <int dim>
HeldEdges<dim> held_edges(const std::vector<AnyBoundary<dim>>& boundaries) {
  HeldEdges<dim> held;
  for (const auto& boundary : boundaries)
    std::visit(
        [&](const auto& b) {
          for (int d = 0; d < dim; ++d)
            for (int side = 0; side < 2; ++side)
              if constexpr (requires { b.on_edge(d, side); })
                held.side[static_cast<std::size_t>(2 * d + side)] |= b.on_edge(d, side);
          if constexpr (requires { b.edges(); })
            for (const int e : b.edges()) {
              held.edge.resize(std::max(held.edge.size(), static_cast<std::size_t>(e) + 1), 0);
              held.edge[static_cast<std::size_t>(e)] = 1;
            }
        },
        boundary);
  return held;
}

}  // namespace wisp
