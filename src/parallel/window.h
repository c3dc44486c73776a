// What one rank sees of a structured grid: its own box of cells and a margin around it, numbered densely.
#pragma once
#include <limits>

#include "core/error.h"
#include "parallel/box_partition.h"
#include "parallel/index_box.h"

namespace wisp {

/// A rank's box of owned cells and `margin` more cells on every side, also beyond the edge of the grid:
/// kernels then need no case for edges. Cells and nodes out there are phantoms: numbered, but owned by nobody
/// and never active.
///
/// Multi-indices are those of the whole grid; local numbers are dense with x fastest, i + nx (j + ny k) from
/// the lower corner of the window.
template <int dim>
class Window {
 public:
  static constexpr int default_margin = 2;

  /// The window of one part.
  explicit Window(const BoxPartition<dim>& partition, int part = Session::rank(), int margin = default_margin)
      : Window(partition.n_cells(), partition.box(part), margin) {}
  /// @param n_cells cells per direction of the whole grid
  /// @param owned   this rank's cells
  /// @throws RunError if the window has more nodes than an int can count
  Window(const MultiIndex<dim>& n_cells, const IndexBox<dim>& owned, int margin = default_margin)
      : grid_cells_{MultiIndex<dim>::Zero(), n_cells},
        grid_nodes_{MultiIndex<dim>::Zero(), n_cells + MultiIndex<dim>::Ones()},
        owned_cells_(owned),
        owned_nodes_(owned),
        cells_{owned.lower - MultiIndex<dim>::Constant(margin),
               owned.upper + MultiIndex<dim>::Constant(margin)},
        nodes_{cells_.lower, cells_.upper + MultiIndex<dim>::Ones()},
        margin_(margin) {
    if (nodes_.count() > std::numeric_limits<int>::max())
      run_error("a rank's part of the grid has {} nodes, more than 2^31: use more ranks", nodes_.count());
    for (int d = 0; d < dim; ++d) {
      // The nodes of the upper edge have no cell of their own: the last cell's owner takes them.
      if (owned.upper[d] == n_cells[d]) ++owned_nodes_.upper[d];
      cell_strides_[d] = d == 0 ? 1 : cell_strides_[d - 1] * cells_.extent()[d - 1];
      node_strides_[d] = d == 0 ? 1 : node_strides_[d - 1] * nodes_.extent()[d - 1];
    }
  }

  [[nodiscard]] int margin() const { return margin_; }
  /// Boxes of the whole grid, of this rank's own part, and of the window with its margin.
  [[nodiscard]] const IndexBox<dim>& grid_cells() const { return grid_cells_; }
  [[nodiscard]] const IndexBox<dim>& grid_nodes() const { return grid_nodes_; }
  [[nodiscard]] const IndexBox<dim>& owned_cells() const { return owned_cells_; }
  [[nodiscard]] const IndexBox<dim>& owned_nodes() const { return owned_nodes_; }
  [[nodiscard]] const IndexBox<dim>& cells() const { return cells_; }
  [[nodiscard]] const IndexBox<dim>& nodes() const { return nodes_; }

  /// Numbers of local cells and nodes, margin and phantoms included: the lengths of arrays.
  [[nodiscard]] int n_cells() const { return static_cast<int>(cells_.count()); }
  [[nodiscard]] int n_nodes() const { return static_cast<int>(nodes_.count()); }

  /// Distance in local numbers between neighbours in each direction.
  [[nodiscard]] const MultiIndex<dim>& cell_strides() const { return cell_strides_; }
  [[nodiscard]] const MultiIndex<dim>& node_strides() const { return node_strides_; }

  /// Local number of a cell or node of the window; the caller makes sure that it is in it.
  [[nodiscard]] int cell_index(const MultiIndex<dim>& cell) const {
    return (cell - cells_.lower).dot(cell_strides_);
  }
  [[nodiscard]] int node_index(const MultiIndex<dim>& node) const {
    return (node - nodes_.lower).dot(node_strides_);
  }
  /// The inverse.
  [[nodiscard]] MultiIndex<dim> cell_multi_index(int cell) const { return inverse(cell, cells_); }
  [[nodiscard]] MultiIndex<dim> node_multi_index(int node) const { return inverse(node, nodes_); }
  /// Local number of the lower corner of a cell, both given and returned as local numbers.
  [[nodiscard]] int first_node_of_cell(int cell) const { return node_index(cell_multi_index(cell)); }

  [[nodiscard]] bool contains_cell(const MultiIndex<dim>& cell) const { return cells_.contains(cell); }
  [[nodiscard]] bool contains_node(const MultiIndex<dim>& node) const { return nodes_.contains(node); }
  [[nodiscard]] bool owns_cell(const MultiIndex<dim>& cell) const { return owned_cells_.contains(cell); }
  [[nodiscard]] bool owns_node(const MultiIndex<dim>& node) const { return owned_nodes_.contains(node); }
  /// False for phantoms.
  [[nodiscard]] bool cell_in_grid(const MultiIndex<dim>& cell) const { return grid_cells_.contains(cell); }
  [[nodiscard]] bool node_in_grid(const MultiIndex<dim>& node) const { return grid_nodes_.contains(node); }

 private:
  [[nodiscard]] static MultiIndex<dim> inverse(int number, const IndexBox<dim>& box) {
    MultiIndex<dim> result = box.lower;
    for (int d = 0; d < dim; ++d) {
      const int extent = box.upper[d] - box.lower[d];
      result[d] += number % extent;
      number /= extent;
    }
    return result;
  }

  IndexBox<dim> grid_cells_, grid_nodes_, owned_cells_, owned_nodes_, cells_, nodes_;
  MultiIndex<dim> cell_strides_ = MultiIndex<dim>::Zero();
  MultiIndex<dim> node_strides_ = MultiIndex<dim>::Zero();
  int margin_;
};

}  // namespace wisp
