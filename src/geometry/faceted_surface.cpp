#include "geometry/faceted_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace wisp {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Nearest point of a facet and the feature that it lies on: -1 the inside, k vertex k, 3 + k edge k (3D).
template <int dim>
struct Nearest {
  Eigen::Matrix<double, dim, 1> point;
  int feature = -1;
};

Nearest<2> nearest_on(const std::array<Eigen::Vector2d, 2>& v, const Eigen::Vector2d& x) {
  const Eigen::Vector2d edge = v[1] - v[0];
  const double t = (x - v[0]).dot(edge) / edge.squaredNorm();
  if (t <= 0.0) return {v[0], 0};
  if (t >= 1.0) return {v[1], 1};
  return {v[0] + t * edge, -1};
}

/// By the regions of the triangle's plane (Ericson 2005, section 5.1.5).
Nearest<3> nearest_on(const std::array<Eigen::Vector3d, 3>& v, const Eigen::Vector3d& x) {
  const Eigen::Vector3d ab = v[1] - v[0], ac = v[2] - v[0], ap = x - v[0], bp = x - v[1], cp = x - v[2];
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {v[0], 0};
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {v[1], 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {v[0] + d1 / (d1 - d3) * ab, 3};
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return {v[2], 2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {v[0] + d2 / (d2 - d6) * ac, 5};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
    return {v[1] + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (v[2] - v[1]), 4};
  const double sum = va + vb + vc;
  return {v[0] + ab * (vb / sum) + ac * (vc / sum), -1};
}

template <int dim>
Eigen::Matrix<double, dim, 1> normal_of(const std::array<Eigen::Matrix<double, dim, 1>, dim>& v) {
  if constexpr (dim == 2) {
    const Eigen::Vector2d t = (v[1] - v[0]).normalized();
    return {-t.y(), t.x()};
  } else {
    return (v[1] - v[0]).cross(v[2] - v[0]).normalized();
  }
}

}  // namespace

template <int dim>
FacetedSurface<dim>::FacetedSurface(std::vector<Vector> vertices, std::vector<Facet> facets)
    : vertices_(std::move(vertices)), facets_(std::move(facets)) {
  set_normals();
  find_open_ends();
  order_.resize(facets_.size());
  std::iota(order_.begin(), order_.end(), 0);
  tree_.resize(1);
  build(0, 0, size());
}

template <int dim>
WallPiece<dim> FacetedSurface<dim>::piece(int facet) const {
  WallPiece<dim> result;
  for (std::size_t k = 0; k < dim; ++k) result.vertex[k] = vertices_[at(facets_[at(facet)][k])];
  result.normal = normals_[at(facet)];
  return result;
}

template <int dim>
void FacetedSurface<dim>::set_normals() {
  vertex_normals_.assign(vertices_.size(), Vector::Zero());
  for (const auto& facet : facets_) {
    std::array<Vector, dim> v;
    for (std::size_t k = 0; k < dim; ++k) v[k] = vertices_[at(facet[k])];
    const Vector n = normal_of<dim>(v);
    normals_.push_back(n);
    for (std::size_t k = 0; k < dim; ++k) {
      double weight = 1.0;
      if constexpr (dim == 3) {
        const Vector a = v[(k + 1) % 3] - v[k], b = v[(k + 2) % 3] - v[k];
        weight = std::atan2(a.cross(b).norm(), a.dot(b));
      }
      vertex_normals_[at(facet[k])] += weight * n;
    }
  }
}

template <int dim>
void FacetedSurface<dim>::find_open_ends() {
  open_vertex_.assign(vertices_.size(), 0);
  if constexpr (dim == 2) {
    std::vector<int> count(vertices_.size(), 0);
    for (const auto& facet : facets_)
      for (const int v : facet) ++count[at(v)];
    for (std::size_t v = 0; v < count.size(); ++v) open_vertex_[v] = count[v] == 1;
  } else {
    std::map<std::pair<int, int>, std::vector<int>> facets_of;
    const auto edge = [](const Facet& facet, std::size_t k) {
      return std::minmax(facet[k], facet[(k + 1) % 3]);
    };
    for (int f = 0; f < size(); ++f)
      for (std::size_t k = 0; k < 3; ++k) facets_of[edge(facets_[at(f)], k)].push_back(f);
    edge_normals_.resize(facets_.size());
    open_edge_.resize(facets_.size());
    for (int f = 0; f < size(); ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& sharing = facets_of[edge(facets_[at(f)], k)];
        Vector sum = Vector::Zero();
        for (const int g : sharing) sum += normals_[at(g)];
        edge_normals_[at(f)][k] = sum;
        open_edge_[at(f)][k] = sharing.size() == 1;
        if (sharing.size() == 1)
          open_vertex_[at(facets_[at(f)][k])] = open_vertex_[at(facets_[at(f)][(k + 1) % 3])] = 1;
      }
  }
}

template <int dim>
void FacetedSurface<dim>::build(int node, int first, int last) {
  const auto centre = [&](int f) {
    Vector sum = Vector::Zero();
    for (const int v : facets_[at(f)]) sum += vertices_[at(v)];
    return sum;
  };
  constexpr double far = std::numeric_limits<double>::infinity();
  Vector lower = Vector::Constant(far), upper = -lower, least = lower, most = upper;
  for (int k = first; k < last; ++k) {
    for (const int v : facets_[at(order_[at(k)])])
      lower = lower.cwiseMin(vertices_[at(v)]), upper = upper.cwiseMax(vertices_[at(v)]);
    const Vector c = centre(order_[at(k)]);
    least = least.cwiseMin(c), most = most.cwiseMax(c);
  }
  Node& here = tree_[at(node)];
  here.lower = lower, here.upper = upper, here.first = first, here.last = last;
  if (last - first <= 4) return;
  int direction = 0;
  (most - least).maxCoeff(&direction);
  const int middle = (first + last) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [&](int a, int b) { return centre(a)[direction] < centre(b)[direction]; });
  const int child = static_cast<int>(tree_.size());
  here.child = child;
  tree_.resize(tree_.size() + 2);
  build(child, first, middle);
  build(child + 1, middle, last);
}

template <int dim>
WallDistance<dim> FacetedSurface<dim>::signed_distance(const Vector& x) const {
  double best = std::numeric_limits<double>::infinity();
  int facet = -1;
  Nearest<dim> nearest;
  const auto away = [&](const Node& node) {
    return (x - x.cwiseMax(node.lower).cwiseMin(node.upper)).squaredNorm();
  };
  // Deeper than any tree of 2^31 facets that is halved at each level.
  std::array<int, 80> stack{};
  std::size_t depth = 1;
  while (depth > 0) {
    const Node& node = tree_[at(stack[--depth])];
    if (away(node) >= best) continue;
    if (node.child >= 0) {
      const bool left_first = away(tree_[at(node.child)]) <= away(tree_[at(node.child + 1)]);
      stack[depth++] = node.child + (left_first ? 1 : 0);
      stack[depth++] = node.child + (left_first ? 0 : 1);
      continue;
    }
    for (int k = node.first; k < node.last; ++k) {
      std::array<Vector, dim> v;
      for (std::size_t j = 0; j < dim; ++j) v[j] = vertices_[at(facets_[at(order_[at(k)])][j])];
      const Nearest<dim> found = nearest_on(v, x);
      const double distance = (x - found.point).squaredNorm();
      if (distance < best) best = distance, nearest = found, facet = order_[at(k)];
    }
  }
  WallDistance<dim> result;
  result.closest = nearest.point;
  const Vector& n = normals_[at(facet)];
  const Vector away_from = x - nearest.point;
  Vector side = n;
  const auto feature = static_cast<std::size_t>(std::max(nearest.feature, 0));
  if (nearest.feature >= 3) {
    side = edge_normals_[at(facet)][feature - 3];
    result.beyond = open_edge_[at(facet)][feature - 3];
  } else if (nearest.feature >= 0) {
    side = vertex_normals_[at(facets_[at(facet)][feature])];
    result.beyond = open_vertex_[at(facets_[at(facet)][feature])];
  }
  const double sign = away_from.dot(side) >= 0.0 ? 1.0 : -1.0;
  result.distance = sign * std::sqrt(best);
  // Opposite the inside of a facet its own normal is exact, also on the wall itself.
  result.normal = nearest.feature < 0 ? n
                  : best > 0.0        ? Vector(sign * away_from / std::sqrt(best))
                                      : Vector(side.normalized());
  // Straight above an end is not past it.
  if (result.beyond && std::abs(result.normal.dot(n)) > 1.0 - 1e-12) result.beyond = false;
  return result;
}

template class FacetedSurface<2>;
template class FacetedSurface<3>;

}  // namespace wisp
