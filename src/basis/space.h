// What a rank knows of the discretisation: its part of the grid, who owns what, and the basis.
#pragma once
#include <algorithm>
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
/// On a structured grid functions are numbered densely like the nodes of the rank's window, ghosts and
/// phantoms included: the functions of cell c have the multi-indices c to c + degree in each direction. Those
/// of linear functions and of GIMP's are its nodes; of B-splines there are more than nodes, and the last of
/// them lie where phantoms are. A triangulation (2D) lies on one rank with all its functions.
template <int dim>
class Space {
 public:
  Space(const StructuredGrid<dim>& grid, const BoxPartition<dim>& partition, bool domains)
      : Space(grid, partition, domains ? AnyBasisOptions(GimpOptions{}) : AnyBasisOptions(LinearOptions{})) {}
  /// A basis on a structured grid. Errors (InputError): one that needs a triangulation; a degree of B-splines
  /// that is not built.
  Space(const StructuredGrid<dim>& grid, const BoxPartition<dim>& partition, const AnyBasisOptions& options)
      : grid_(grid),
        partition_(partition),
        degree_(degree_of(options)),
        window_(std::in_place, *partition_, Session::rank(), std::max(degree_, Window<dim>::default_margin)),
        nodes_(make_node_halo<dim>(*partition_, *window_, degree_)),
        cells_(make_cell_halo<dim>(*partition_, *window_)),
        domains_(std::holds_alternative<GimpOptions>(options)),
        basis_(Linear<dim>(*grid_, NodeNumbering<dim>(*window_))) {
    if (domains_) set_width(3);
    if (!nodal()) make_splines();
  }
  /// A basis on a triangulation; for dim = 2 only (there is no other definition). Errors (InputError): one
  /// that needs a structured grid, more than one rank.
  Space(std::shared_ptr<const Triangulation> triangulation, const AnyBasisOptions& options);
  Space(const Space&) = delete;
  Space& operator=(const Space&) = delete;

  bool structured() const { return !triangulation_; }
  /// Whether the functions of a structured grid are its nodes', not those of B-splines.
  bool nodal() const { return structured() && degree_ == 1; }
  /// Of structured grids: multi-indices of all functions, and of those of a cell.
  IndexBox<dim> grid_functions() const {
    return {MultiIndex<dim>::Zero(), grid_->cells() + MultiIndex<dim>::Constant(degree_)};
  }
  IndexBox<dim> functions_of_cell(const MultiIndex<dim>& cell) const {
    return {cell, cell + MultiIndex<dim>::Constant(degree_ + 1)};
  }
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
  /// height of a triangle, over the degree of the functions.
  double shortest_extent() const {
    if (structured()) return grid_->shortest_side() / degree_;
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
    const MultiIndex<dim> i = window_->node_multi_index(function);
    if (!nodal()) {
      const MultiIndex<dim> last =
          grid_functions().upper - MultiIndex<dim>::Ones();  // phantoms have no place
      return visit_splines(
          [&](const auto& b) { return b.control_point(i.cwiseMax(0).cwiseMin(last).eval()); });
    }
    Vec<dim> x;
    for (int d = 0; d < dim; ++d) x[d] = grid_->line(d, i[d]);
    return x;
  }

  /// f(basis) of B-splines.
  template <class F>
  auto visit_splines(F&& f) const {
    using Result = decltype(f(std::declval<const BSpline<dim, 2>&>()));
    return std::visit(
        [&](const auto& b) -> Result {
          if constexpr (is_bspline<std::decay_t<decltype(b)>>)
            return f(b);
          else
            throw std::logic_error("visit_splines: the basis is no B-spline");
        },
        basis_);
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
  /// Of functions on a structured grid.
  static int degree_of(const AnyBasisOptions& options);
  void make_splines();

  std::optional<StructuredGrid<dim>> grid_;
  std::optional<BoxPartition<dim>> partition_;
  int degree_ = 0;  // of functions on a structured grid; 0: a triangulation
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
