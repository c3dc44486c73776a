// The cells of a structured grid, split into one box per rank.
#pragma once
#include <span>
#include <vector>

#include "parallel/index_box.h"
#include "parallel/session.h"

namespace wisp {

/// Cuts the cells of a structured grid into boxes with about equal numbers of points, by recursive bisection
/// along the coordinates (Berger and Bokhari 1987). Every rank knows all boxes. No rank needs to see all
/// points: only their histograms are summed. Any number of parts; the boxes are disjoint, not empty, and
/// cover the grid.
template <int dim>
class BoxPartition {
 public:
  /// The whole grid in one box.
  explicit BoxPartition(const MultiIndex<dim>& n_cells);
  /// Balances the points whose cells are listed, each rank listing its own. Collective. Where there are no
  /// points, cells are balanced instead.
  /// @param n_cells        cells per direction
  /// @param cells_of_points one entry per local point; must lie in the grid
  /// @throws InputError if the grid has fewer cells than parts, RunError if a point lies outside
  BoxPartition(const MultiIndex<dim>& n_cells, std::span<const MultiIndex<dim>> cells_of_points,
               int n_parts = Session::size());
  /// A split that was in force before (of a stopped run).
  /// @throws InputError if the boxes are not one such split of the grid
  BoxPartition(const MultiIndex<dim>& n_cells, std::vector<IndexBox<dim>> boxes);

  [[nodiscard]] int n_parts() const { return static_cast<int>(boxes_.size()); }
  [[nodiscard]] const MultiIndex<dim>& n_cells() const { return n_cells_; }
  /// The cells of one part.
  [[nodiscard]] const IndexBox<dim>& box(int part) const { return boxes_[static_cast<std::size_t>(part)]; }
  /// The part that owns a cell of the grid.
  [[nodiscard]] int owner_of_cell(const MultiIndex<dim>& cell) const {
    int position = 0;
    while (tree_[static_cast<std::size_t>(position)].direction >= 0) {
      const Cut& cut = tree_[static_cast<std::size_t>(position)];
      position = cell[cut.direction] < cut.position ? cut.below : cut.above;
    }
    return tree_[static_cast<std::size_t>(position)].part;
  }
  /// The part that owns a node of the grid: that of the cell with the same multi-index; on the upper edges,
  /// where there is no such cell, that of the last one.
  [[nodiscard]] int owner_of_node(const MultiIndex<dim>& node) const {
    return owner_of_cell(node.cwiseMin(n_cells_ - MultiIndex<dim>::Ones()));
  }
  friend bool operator==(const BoxPartition& a, const BoxPartition& b) {
    return a.n_cells_ == b.n_cells_ && a.boxes_ == b.boxes_;
  }

 private:
  struct Cut {
    int direction = -1;  // -1: a leaf
    int position = 0;    // the first cell above the cut
    int below = -1, above = -1;
    int part = 0;
  };
  /// A box still to be shared between the parts [first, first + n).
  struct Open {
    IndexBox<dim> box;
    int first = 0, n = 1, node = 0;
  };
  void cut(const Open& open, const std::int64_t* histogram, std::vector<Open>& next);
  void find_cut(const Open& open, std::vector<Open>& next);
  void split(const Open& open, int direction, int position, int below, std::vector<Open>& next);

  MultiIndex<dim> n_cells_;
  std::vector<IndexBox<dim>> boxes_;
  std::vector<Cut> tree_;
};

extern template class BoxPartition<1>;
extern template class BoxPartition<2>;
extern template class BoxPartition<3>;

}  // namespace wisp
