// Segments or triangles with what it takes to ask for signed distances: neighbours' normals and a tree of
// boxes.
#pragma once
#include <array>
#include <vector>

#include "geometry/block.h"
#include "geometry/wall_piece.h"

namespace wisp {

/// A line (2D) or surface (3D) of flat pieces that share vertices. Closed, or with open ends.
template <int dim>
class FacetedSurface {
 public:
  using Vector = Eigen::Matrix<double, dim, 1>;
  using Facet = std::array<int, dim>;  ///< vertex numbers; the order gives the normal, see WallPiece

  /// Takes pieces that are consistently oriented; the caller has checked them.
  FacetedSurface(std::vector<Vector> vertices, std::vector<Facet> facets);

  int size() const { return static_cast<int>(facets_.size()); }
  const std::vector<Vector>& vertices() const { return vertices_; }
  const std::vector<Facet>& facets() const { return facets_; }
  WallPiece<dim> piece(int facet) const;
  /// Calls f(facet) for the facets in boxes of the tree that `skip` (a Block) does not leave out.
  template <class Skip, class F>
  void for_each_but(Skip&& skip, F&& f) const {
    std::array<int, 80> stack{};
    std::size_t depth = 1;
    while (depth > 0) {
      const Node& node = tree_[static_cast<std::size_t>(stack[--depth])];
      if (skip(Block<dim>{node.lower, node.upper})) continue;
      if (node.child >= 0) {
        stack[depth++] = node.child + 1, stack[depth++] = node.child;
        continue;
      }
      for (int k = node.first; k < node.last; ++k) f(order_[static_cast<std::size_t>(k)]);
    }
  }
  Block<dim> bounds() const { return {tree_.front().lower, tree_.front().upper}; }

  /// Signed distance, positive on the side of the normals. The sign at vertices and edges comes from the
  /// angle-weighted mean normal, which is exact for closed surfaces (Baerentzen and Aanaes 2005).
  WallDistance<dim> signed_distance(const Vector& x) const;

 private:
  /// Node of a binary tree over boxes: leaves hold facets [first, last) of `order_`, others two children.
  struct Node {
    Vector lower, upper;
    int first = 0, last = 0;
    int child = -1;  ///< the other child follows
  };
  void build(int node, int first, int last);
  void set_normals();
  void find_open_ends();

  std::vector<Vector> vertices_;
  std::vector<Facet> facets_;
  std::vector<Vector> normals_;                      // of facets
  std::vector<Vector> vertex_normals_;               // sums weighted with the angle
  std::vector<char> open_vertex_;                    // at an open end
  std::vector<std::array<Vector, 3>> edge_normals_;  // 3D: edge k of a facet runs from vertex k to k + 1
  std::vector<std::array<char, 3>> open_edge_;
  std::vector<int> order_;
  std::vector<Node> tree_;
};

}  // namespace wisp
