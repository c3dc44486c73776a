// What a rank knows of the discretisation: its part of the grid, who owns what, and the basis.
#pragma once
#include <memory>
#include <optional>
#include <stdexcept>

#include "basis/list.h"
#include "basis/options.h"
#include "parallel/halo.h"
#include "parallel/window.h"

namespace wisp {

/// Grid, partition and basis of a run on one rank. Arrays over functions have `n_functions()` entries. Not
/// copyable: the basis points to the grid.
///
/// On a structured grid functions are the nodes of the rank's window, numbered densely, ghosts and phantoms
/// included. A triangulation (2D) lies on one rank with all its functions.
template <int dim>
class Space {
 public:
  Space(const StructuredGrid<dim>& grid, const BoxPartition<dim>& partition, bool domains)
      : grid_(grid),
        partition_(partition),
        window_(*partition_),
        nodes_(make_node_halo<dim>(*partition_, *window_)),
        cells_(make_cell_halo<dim>(*partition_, *window_)),
        domains_(domains),
        basis_(Linear<dim>(*grid_, NodeNumbering<dim>(*window_))) {
    if (domains) set_width(3);
  }
  /// A basis on a triangulation. Errors (InputError): one that needs a structured grid, more than one rank.
  Space(std::shared_ptr<const Triangulation> triangulation,
        const AnyBasisOptions& options) requires(dim == 2);
  Space(const Space&) = delete;
  Space& operator=(const Space&) = delete;

  bool structured() const { return !triangulation_; }
  /// Of structured grids only.
  const StructuredGrid<dim>& grid() const { return *grid_; }
  const BoxPartition<dim>& partition() const { return *partition_; }
  const Window<dim>& window() const { return *window_; }
  /// Of triangulations only.
  const Triangulation& triangulation() const { return *triangulation_; }

  const Halo& nodes() const { return nodes_; }
  const Halo& cells() const { return cells_; }
  const AnyBasis<dim>& basis() const { return basis_; }
  int n_functions() const { return nodes_.n_local(); }
  int n_cells() const { return cells_.n_local(); }
  /// Keys of stencils lie below this.
  int n_keys() const { return structured() ? n_functions() : n_cells(); }
  /// Whether points have domains (GIMP).
  bool domains() const { return domains_; }
  /// The shortest side of a cell or height of a triangle, m.
  double shortest_side() const {
    return structured() ? grid_->shortest_side() : triangulation_->shortest_height();
  }
  /// The least extent that a wave crosses in a cell, for time steps, m: the shortest side, or the shortest
  /// height of a triangle over the degree of its functions.
  double shortest_extent() const {
    if (structured()) return grid_->shortest_side();
    return triangulation_->shortest_height() / std::visit([](const auto& b) { return b.degree; }, basis_);
  }
  /// Corners of the box around the grid, m.
  Vec<dim> lower() const {
    if constexpr (dim == 2)
      if (!structured()) return triangulation_->lower();
    return grid_->lower();
  }
  Vec<dim> upper() const {
    if constexpr (dim == 2)
      if (!structured()) return triangulation_->upper();
    return grid_->upper();
  }

  /// Functions a direction that the stencils of a basis with domains need: 3, or 5 for domains over a cell's
  /// side.
  void set_width(int width) {
    const NodeNumbering<dim> numbering(*window_);
    if (width == 3)
      basis_ = Gimp<dim, 3>(*grid_, numbering);
    else
      basis_ = Gimp<dim, 5>(*grid_, numbering);
  }

  /// Where the coefficient of a function lives: sum of node_position(i) phi_i(x) = x.
  Vec<dim> node_position(int function) const {
    if constexpr (dim == 2)
      if (!structured())
        return std::visit(
            [&](const auto& b) -> Vec<2> {
              if constexpr (is_on_triangles<std::decay_t<decltype(b)>>)
                return b.basis().control_point(function);
              return Vec<2>::Zero();
            },
            basis_);
    Vec<dim> x;
    const MultiIndex<dim> i = window_->node_multi_index(function);
    for (int d = 0; d < dim; ++d) x[d] = grid_->line(d, i[d]);
    return x;
  }

  /// Whether x lies in the grid, its edge included.
  bool contains(const Vec<dim>& x) const {
    if constexpr (dim == 2)
      if (!structured()) return triangulation_->locate(x) >= 0;
    for (int d = 0; d < dim; ++d)
      if (const int c = grid_->locate_inside(d, x[d]); c < 0 || c >= grid_->cells(d)) return false;
    return true;
  }

 private:
  std::optional<StructuredGrid<dim>> grid_;
  std::optional<BoxPartition<dim>> partition_;
  std::optional<Window<dim>> window_;
  std::shared_ptr<const Triangulation> triangulation_;
  Halo nodes_, cells_;
  bool domains_ = false;
  AnyBasis<dim> basis_;
};

/// Calls f(basis) with the basis of a triangulation (LinearTriangle, PowellSabinQuadratic, ...).
template <class F>
decltype(auto) visit_on_triangles(const Space<2>& space, F&& f) {
  using Result = decltype(f(std::declval<const LinearTriangle&>()));
  return std::visit(
      [&](const auto& b) -> Result {
        if constexpr (is_on_triangles<std::decay_t<decltype(b)>>)
          return f(b.basis());
        else
          throw std::logic_error("visit_on_triangles: the grid is structured");
      },
      space.basis());
}

template <>
Space<2>::Space(std::shared_ptr<const Triangulation> triangulation, const AnyBasisOptions& options);

}  // namespace wisp
