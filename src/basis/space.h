// What a rank knows of the discretisation: its part of the grid, who owns what, and the basis.
#pragma once
#include "basis/list.h"
#include "parallel/halo.h"
#include "parallel/window.h"

namespace wisp {

/// Grid, partition and basis of a run on one rank. Functions are the nodes of the rank's window, numbered
/// densely; arrays over functions have `n_functions()` entries, ghosts and phantoms included. Not copyable:
/// the basis points to the grid.
template <int dim>
class Space {
 public:
  Space(const StructuredGrid<dim>& grid, const BoxPartition<dim>& partition, bool domains)
      : grid_(grid),
        partition_(partition),
        window_(partition_),
        nodes_(make_node_halo<dim>(partition_, window_)),
        cells_(make_cell_halo<dim>(partition_, window_)),
        domains_(domains),
        basis_(Linear<dim>(grid_, NodeNumbering<dim>(window_))) {
    if (domains) set_width(3);
  }
  Space(const Space&) = delete;
  Space& operator=(const Space&) = delete;

  const StructuredGrid<dim>& grid() const { return grid_; }
  const BoxPartition<dim>& partition() const { return partition_; }
  const Window<dim>& window() const { return window_; }
  const Halo& nodes() const { return nodes_; }
  const Halo& cells() const { return cells_; }
  const AnyBasis<dim>& basis() const { return basis_; }
  int n_functions() const { return window_.n_nodes(); }
  /// Whether points have domains (GIMP).
  bool domains() const { return domains_; }

  /// Functions a direction that the stencils of a basis with domains need: 3, or 5 for domains over a cell's
  /// side.
  void set_width(int width) {
    const NodeNumbering<dim> numbering(window_);
    if (width == 3)
      basis_ = Gimp<dim, 3>(grid_, numbering);
    else
      basis_ = Gimp<dim, 5>(grid_, numbering);
  }

  Vec<dim> node_position(int function) const {
    Vec<dim> x;
    const MultiIndex<dim> i = window_.node_multi_index(function);
    for (int d = 0; d < dim; ++d) x[d] = grid_.line(d, i[d]);
    return x;
  }

 private:
  StructuredGrid<dim> grid_;
  BoxPartition<dim> partition_;
  Window<dim> window_;
  Halo nodes_, cells_;
  bool domains_;
  AnyBasis<dim> basis_;
};

}  // namespace wisp
