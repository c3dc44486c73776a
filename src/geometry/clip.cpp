#include "geometry/clip.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace wisp {

template <>
ClippedBox<3> clip_box<3>(const Region<3>& shape, const std::vector<HalfSpace<3>>& cuts,
                          const Eigen::Vector3d& lower, const Eigen::Vector3d& upper);

namespace {

template <int dim>
using Vector = Eigen::Matrix<double, dim, 1>;
template <int dim>
using Corners = std::vector<Vector<dim>>;

/// Integrals of 1, x and x x^T, of simplices with signs, about a point near by.
template <int dim>
struct Integrals {
  double volume = 0.0;
  Vector<dim> first = Vector<dim>::Zero();
  Eigen::Matrix<double, dim, dim> second = Eigen::Matrix<double, dim, dim>::Zero();

  /// A simplex of the origin and dim corners.
  void add(const std::array<Vector<dim>, dim>& v) {
    Eigen::Matrix<double, dim, dim> edges;
    for (int k = 0; k < dim; ++k) edges.col(k) = v[static_cast<std::size_t>(k)];
    const double size = edges.determinant() / (dim == 2 ? 2.0 : 6.0);
    const Vector<dim> sum = edges.rowwise().sum();
    volume += size;
    first += size / (dim + 1) * sum;
    second += size / ((dim + 1) * (dim + 2)) * (edges * edges.transpose() + sum * sum.transpose());
  }
  Eigen::Matrix<double, dim, dim> covariance() const {
    const Vector<dim> mean = first / volume;
    return second / volume - mean * mean.transpose();
  }
  ClippedBox<dim> about(const Vector<dim>& origin) const {
    ClippedBox<dim> part;
    if (!(volume > 0.0)) return part;
    part.volume = volume;
    part.centroid = origin + first / volume;
    part.variance = covariance().diagonal().cwiseMax(0.0);
    return part;
  }
};

/// What of a closed line of corners lies in a half-space (Sutherland and Hodgman 1974); corners on its plane
/// that the cut makes are added to `on`.
template <int dim>
Corners<dim> cut_corners(const Corners<dim>& in, const HalfSpace<dim>& half, Corners<dim>* on = nullptr) {
  Corners<dim> out;
  for (std::size_t k = 0; k < in.size(); ++k) {
    const Vector<dim>&a = in[k], &b = in[(k + 1) % in.size()];
    const double fa = (a - half.point).dot(half.normal), fb = (b - half.point).dot(half.normal);
    if (fa >= 0.0) out.push_back(a);
    if (on && fa == 0.0) on->push_back(a);
    if ((fa > 0.0 && fb < 0.0) || (fa < 0.0 && fb > 0.0)) {
      // From the inner end, so that neighbours find the same corner to the last bit.
      out.push_back(fa > 0.0 ? Vector<dim>(a + fa / (fa - fb) * (b - a))
                             : Vector<dim>(b + fb / (fb - fa) * (a - b)));
      if (on) on->push_back(out.back());
    }
  }
  return out;
}

template <int dim>
std::vector<HalfSpace<dim>> sides(const Vector<dim>& lower, const Vector<dim>& upper) {
  std::vector<HalfSpace<dim>> s;
  for (int d = 0; d < dim; ++d) {
    s.push_back({lower, Vector<dim>::Unit(d)});
    s.push_back({upper, -Vector<dim>::Unit(d)});
  }
  return s;
}

std::vector<Corners<2>> rings_of(const Block<2>& block) {
  return {{block.lower, {block.upper[0], block.lower[1]}, block.upper, {block.lower[0], block.upper[1]}}};
}
std::vector<Corners<2>> rings_of(const Outline& outline) { return outline.rings(); }
std::vector<Corners<2>> rings_of(const Sphere<2>&) {
  input_error("shape: points cannot be cut at a ball; give a polygon, or clip = false");
}

/// Faces of a box, corners counter-clockwise seen from outside.
std::vector<Corners<3>> faces_of(const Vector<3>& lower, const Vector<3>& upper) {
  std::vector<Corners<3>> faces;
  for (int d = 0; d < 3; ++d)
    for (const bool top : {false, true}) {
      Corners<3> face;
      for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        Vector<3> x;
        x[d] = top ? upper[d] : lower[d];
        x[(d + 1) % 3] = u ? upper[(d + 1) % 3] : lower[(d + 1) % 3];
        x[(d + 2) % 3] = v ? upper[(d + 2) % 3] : lower[(d + 2) % 3];
        face.push_back(x);
      }
      if (!top) std::reverse(face.begin(), face.end());
      faces.push_back(face);
    }
  return faces;
}

/// Cuts a convex polyhedron and closes it again: the corners on the plane, sorted around their mean.
void cut_polyhedron(std::vector<Corners<3>>& faces, const HalfSpace<3>& half) {
  Corners<3> on;
  bool changed = false;
  for (auto& face : faces) {
    for (const auto& x : face) changed |= (x - half.point).dot(half.normal) < 0.0;
    face = cut_corners<3>(face, half, &on);
  }
  faces.erase(std::remove_if(faces.begin(), faces.end(), [](const auto& f) { return f.size() < 3; }),
              faces.end());
  if (!changed || on.size() < 3 || faces.empty()) return;
  Vector<3> mean = Vector<3>::Zero();
  for (const auto& x : on) mean += x / static_cast<double>(on.size());
  const Vector<3> n = half.normal.normalized();
  Eigen::Index least = 0;
  n.cwiseAbs().minCoeff(&least);
  const Vector<3> a = n.cross(Vector<3>::Unit(least)).normalized(), b = n.cross(a);
  std::sort(on.begin(), on.end(), [&](const Vector<3>& x, const Vector<3>& y) {
    return std::atan2((x - mean).dot(b), (x - mean).dot(a)) <
           std::atan2((y - mean).dot(b), (y - mean).dot(a));
  });
  std::reverse(on.begin(), on.end());  // the outward normal is -n
  faces.push_back(std::move(on));
}

ClippedBox<2> clip(const std::vector<Corners<2>>& rings, const std::vector<HalfSpace<2>>& cuts,
                   const Vector<2>& lower, const Vector<2>& upper) {
  const Vector<2> origin = 0.5 * (lower + upper);
  std::vector<HalfSpace<2>> all = sides<2>(lower, upper);
  all.insert(all.end(), cuts.begin(), cuts.end());
  Integrals<2> sum;
  for (Corners<2> ring : rings) {
    for (const auto& half : all)
      if (!ring.empty()) ring = cut_corners<2>(ring, half);
    for (std::size_t k = 0; k < ring.size(); ++k)
      sum.add({ring[k] - origin, ring[(k + 1) % ring.size()] - origin});
  }
  return sum.about(origin);
}

ClippedTriangle triangle_of(const std::vector<Corners<2>>& rings, const Vector<2>& origin) {
  ClippedTriangle part;
  Integrals<2> sum;
  for (const auto& ring : rings)
    for (std::size_t k = 0; k < ring.size(); ++k) {
      sum.add({ring[k] - origin, ring[(k + 1) % ring.size()] - origin});
      part.corners.push_back(ring[k]);
    }
  if (!(sum.volume > 0.0)) return {};
  part.area = sum.volume;
  part.centroid = origin + sum.first / sum.volume;
  part.covariance = sum.covariance();
  return part;
}

/// A part of a surface of triangles that two directions have flattened onto a line encloses nothing.
bool beyond_two_sides(const Block<3>& part, const Vector<3>& lower, const Vector<3>& upper) {
  return ((part.lower.array() >= upper.array()) || (part.upper.array() <= lower.array())).count() > 1;
}

/// What lies beyond a plane is projected onto it: what a closed surface encloses on the inner side stays, the
/// rest becomes flat. So a solid is cut by its surface alone, without looking for the rest of its boundary.
ClippedBox<3> clip(const Solid& solid, const std::vector<HalfSpace<3>>& cuts, const Vector<3>& lower,
                   const Vector<3>& upper) {
  const Vector<3> origin = 0.5 * (lower + upper);
  const double reach = 0.5 * (upper - lower).norm(), inside = solid.distance(origin);
  if (inside < -reach) return {};
  if (inside > reach) return clip_box<3>(Block<3>{lower, upper}, cuts, lower, upper);
  std::vector<HalfSpace<3>> all = sides<3>(lower, upper);
  for (const auto& cut : cuts) all.push_back({cut.point, cut.normal.normalized()});
  Integrals<3> sum;
  std::vector<Corners<3>> parts, next;
  const auto add = [&](int facet) {
    const auto v = solid.surface().piece(facet).vertex;
    const Block<3> box{v[0].cwiseMin(v[1]).cwiseMin(v[2]), v[0].cwiseMax(v[1]).cwiseMax(v[2])};
    if (beyond_two_sides(box, lower, upper)) return;
    parts.assign(1, Corners<3>(v.begin(), v.end()));
    for (const auto& half : all) {
      next.clear();
      for (const auto& part : parts) {
        Corners<3> in = cut_corners<3>(part, half);
        Corners<3> out = cut_corners<3>(part, {half.point, -half.normal});
        for (auto& x : out) x -= (x - half.point).dot(half.normal) * half.normal;
        if (in.size() > 2) next.push_back(std::move(in));
        if (out.size() > 2) next.push_back(std::move(out));
      }
      parts.swap(next);
    }
    for (const auto& part : parts)
      for (std::size_t k = 1; k + 1 < part.size(); ++k)
        sum.add({part[0] - origin, part[k] - origin, part[k + 1] - origin});
  };
  solid.surface().for_each_but([&](const Block<3>& box) { return beyond_two_sides(box, lower, upper); }, add);
  // Less than this is the rounding of parts that cancel.
  return sum.volume > 1e-12 * (upper - lower).prod() ? sum.about(origin) : ClippedBox<3>{};
}

}  // namespace

ClippedTriangle clip_triangle(const Region<2>& shape, const std::vector<HalfSpace<2>>& cuts,
                              const std::array<Vector<2>, 3>& corners) {
  std::vector<HalfSpace<2>> all;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector<2> side = corners[(k + 1) % 3] - corners[k];
    all.push_back({corners[k], {-side[1], side[0]}});
  }
  all.insert(all.end(), cuts.begin(), cuts.end());
  std::vector<Corners<2>> rings =
      std::visit([](const auto& s) -> std::vector<Corners<2>> { return rings_of(s); }, shape);
  for (auto& ring : rings)
    for (const auto& half : all)
      if (!ring.empty()) ring = cut_corners<2>(ring, half);
  return triangle_of(rings, (corners[0] + corners[1] + corners[2]) / 3.0);
}

ClippedTriangle whole_triangle(const std::array<Vector<2>, 3>& corners) {
  return triangle_of({{corners.begin(), corners.end()}}, (corners[0] + corners[1] + corners[2]) / 3.0);
}

std::vector<Vector<2>> gauss_points(const ClippedTriangle& part) {
  const Eigen::LLT<Eigen::Matrix2d> root(part.covariance);
  const Eigen::Matrix2d l = root.matrixL();
  if (root.info() != Eigen::Success || !(l(1, 1) > 1e-6 * l(0, 0)) || !(l(0, 0) > 1e-6 * l(1, 1))) return {};
  // Where the part is a disc in the mean: towards the farthest corner, in triangles away from the sides.
  Vector<2> far(1.0, 0.0);
  double most = 0.0;
  for (const auto& x : part.corners)
    if (const Vector<2> d = root.matrixL().solve(x - part.centroid); d.norm() > most)
      most = d.norm(), far = d;
  const double turn = std::atan2(far[1], far[0]);
  std::vector<Vector<2>> points;
  for (int k = 0; k < 3; ++k) {
    const double a = turn + 2.0 * std::numbers::pi / 3.0 * k;
    points.emplace_back(part.centroid + std::numbers::sqrt2 * (l * Vector<2>(std::cos(a), std::sin(a))));
  }
  return points;
}

template <>
ClippedBox<2> clip_box<2>(const Region<2>& shape, const std::vector<HalfSpace<2>>& cuts,
                          const Vector<2>& lower, const Vector<2>& upper) {
  return std::visit([&](const auto& s) { return clip(rings_of(s), cuts, lower, upper); }, shape);
}

template <>
ClippedBox<3> clip_box<3>(const Region<3>& shape, const std::vector<HalfSpace<3>>& cuts,
                          const Vector<3>& lower, const Vector<3>& upper) {
  if (const auto* solid = std::get_if<Solid>(&shape)) return clip(*solid, cuts, lower, upper);
  const auto* block = std::get_if<Block<3>>(&shape);
  if (!block)
    input_error("shape: points cannot be cut at a ball; give a box with cuts, an STL file, or clip = false");
  const Vector<3> a = lower.cwiseMax(block->lower), b = upper.cwiseMin(block->upper);
  if (!((b - a).minCoeff() > 0.0)) return {};
  std::vector<Corners<3>> faces = faces_of(a, b);
  for (const auto& half : cuts) cut_polyhedron(faces, half);
  const Vector<3> origin = 0.5 * (a + b);
  Integrals<3> sum;
  for (const auto& face : faces)
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
      sum.add({face[0] - origin, face[k] - origin, face[k + 1] - origin});
  return sum.about(origin);
}

}  // namespace wisp
