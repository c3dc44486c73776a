// Triangulations of a plane domain. A value: no fields live here.
#pragma once
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tensor/tensor.h"

namespace wisp {

/// A set of edges, vertices or triangles that has a name, such as a physical group of a Gmsh file.
struct NamedPart {
  std::string name;
  std::vector<int> edges;      ///< edge numbers, increasing
  std::vector<int> vertices;   ///< increasing: those of the edges, and vertices named alone
  std::vector<int> triangles;  ///< increasing; of named surfaces only
};

/// Triangles over vertices, counter-clockwise; edges with their neighbours. Conforming: two triangles share
/// nothing, a vertex or a whole edge.
class Triangulation {
 public:
  /// `triangles` hold vertex numbers; if all of them run clockwise all are turned. Errors (InputError): no
  /// triangle; numbers out of range; coordinates that are not finite; some triangles clockwise (inverted) or
  /// without area; vertices without a triangle; edges with more than two triangles; triangles that overlap;
  /// vertices that coincide or lie on another triangle's edge. `origin` starts the messages.
  Triangulation(std::vector<Vec<2>> vertices, std::vector<std::array<int, 3>> triangles,
                std::string_view origin = "triangulation");

  int n_vertices() const { return static_cast<int>(vertices_.size()); }
  int n_triangles() const { return static_cast<int>(triangles_.size()); }
  int n_edges() const { return static_cast<int>(edges_.size()); }

  const Vec<2>& vertex(int v) const { return vertices_[index(v)]; }
  /// Vertex numbers, counter-clockwise.
  const std::array<int, 3>& triangle(int t) const { return triangles_[index(t)]; }
  /// Position of corner k, m.
  const Vec<2>& corner(int t, int k) const { return vertex(triangle(t)[index(k)]); }
  /// The triangle across the edge from corner k to corner k+1; -1 on the boundary.
  int neighbour(int t, int k) const { return neighbours_[index(t)][index(k)]; }
  /// Number of the edge from corner k to corner k+1.
  int edge(int t, int k) const { return edges_of_[index(t)][index(k)]; }

  struct Edge {
    std::array<int, 2> vertex;    ///< as they follow one another counter-clockwise in triangle[0]
    std::array<int, 2> triangle;  ///< triangle[0] < triangle[1]; triangle[1] = -1 on the boundary
    bool boundary() const { return triangle[1] < 0; }
  };
  const Edge& edge(int e) const { return edges_[index(e)]; }
  /// m
  double edge_length(int e) const;

  /// Triangles around a vertex, counter-clockwise; at the boundary they start at the edge after which none
  /// comes clockwise.
  std::span<const int> triangles_of_vertex(int v) const;
  bool on_boundary(int v) const { return on_boundary_[index(v)]; }

  /// Barycentric coordinates of x in triangle t; they sum to one, and are negative outside.
  std::array<double, 3> barycentric(int t, const Vec<2>& x) const {
    const Shape& s = shapes_[index(t)];
    const Vec<2> d = x - s.origin;
    const double a = s.gradient[0].dot(d), b = s.gradient[1].dot(d);
    return {1.0 - a - b, a, b};
  }
  /// Gradients of the barycentric coordinates, 1/m.
  std::array<Vec<2>, 3> barycentric_gradients(int t) const {
    const Shape& s = shapes_[index(t)];
    return {Vec<2>(-s.gradient[0] - s.gradient[1]), s.gradient[0], s.gradient[1]};
  }
  Vec<2> point(int t, const std::array<double, 3>& barycentric) const {
    return barycentric[0] * corner(t, 0) + barycentric[1] * corner(t, 1) + barycentric[2] * corner(t, 2);
  }
  Vec<2> centroid(int t) const { return (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0; }
  double area(int t) const;           ///< m²
  double height(int t, int k) const;  ///< distance of the opposite corner from edge k, m
  double shortest_height() const { return shortest_height_; }
  double smallest_angle() const { return smallest_angle_; }  ///< rad
  double total_area() const;                                 ///< m²
  const Vec<2>& lower() const { return lower_; }
  const Vec<2>& upper() const { return upper_; }

  /// The triangle that holds x, -1 outside or if x is not a number. A point on edges or at a vertex belongs
  /// to the lowest number of its triangles, whatever the hint; a point off the boundary by rounding (1e-12 of
  /// a triangle) to the nearest triangle. A good hint (a triangle near x) costs a few comparisons; without it
  /// bins find x in constant time on average.
  int locate(const Vec<2>& x, int hint = -1) const {
    if (hint >= 0) {
      const auto b = barycentric(hint, x);
      if (b[0] > safely_inside && b[1] > safely_inside && b[2] > safely_inside) return hint;
    }
    return locate_from(x, hint);
  }

  /// Calls f(t) for every triangle whose bounding box may meet the box from `low` to `high`; for some more
  /// than once.
  template <class F>
  void for_each_near(const Vec<2>& low, const Vec<2>& high, F&& f) const {
    const auto from = bin(low), to = bin(high);
    for (int j = from[1]; j <= to[1]; ++j)
      for (int i = from[0]; i <= to[0]; ++i)
        for (const int t : in_bin({i, j})) f(t);
  }

  /// Names edges by their vertex pairs, single vertices, or triangles; adds to a name that exists. Errors
  /// (InputError): a pair that is no edge, numbers out of range.
  void add_part(const std::string& name, std::span<const std::array<int, 2>> edges,
                std::span<const int> vertices = {}, std::span<const int> triangles = {});
  const std::vector<NamedPart>& parts() const { return parts_; }
  /// Errors (InputError): an unknown name, with the nearest one.
  const NamedPart& part(std::string_view name) const;
  /// Edge number of two vertices in either order, -1 if they share none.
  int find_edge(int a, int b) const;

  /// Neighbouring triangles share nothing that differs by rounding beyond this share of their size.
  static constexpr double safely_inside = 1e-12;

 private:
  struct Shape {
    Vec<2> origin;                   ///< corner 0
    std::array<Vec<2>, 2> gradient;  ///< of the barycentric coordinates of corners 1 and 2
  };
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  void check_vertices(std::string_view origin);
  void turn(std::string_view origin);
  void join(std::string_view origin);
  void list_around_vertices();
  void measure();
  void fill_bins();
  void check_overlaps(std::string_view origin) const;
  void check_pair(int s, int t, std::string_view origin) const;
  std::array<int, 2> bin(const Vec<2>& x) const;
  std::span<const int> in_bin(const std::array<int, 2>& b) const;
  bool holds(int t, const Vec<2>& x) const;
  int locate_from(const Vec<2>& x, int hint) const;
  int walk(const Vec<2>& x, int start, int most_steps) const;
  int lowest_holder(int t, const Vec<2>& x) const;
  int search_bin(const Vec<2>& x) const;

  std::vector<Vec<2>> vertices_;
  std::vector<std::array<int, 3>> triangles_, neighbours_, edges_of_;
  std::vector<Edge> edges_;
  std::vector<Shape> shapes_;
  std::vector<int> around_, around_start_;  ///< triangles of each vertex
  std::vector<char> on_boundary_;
  std::vector<NamedPart> parts_;
  Vec<2> lower_, upper_;
  double shortest_height_ = 0.0, smallest_angle_ = 0.0;
  std::array<int, 2> bins_{1, 1};
  Vec<2> per_bin_;
  std::vector<int> bin_start_, bin_triangles_;  ///< triangles whose bounding box meets the bin, increasing
};

}  // namespace wisp
