// Shapes checked and ready for loops over points: the values of a case file become fixed-size numbers once.
#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <numbers>
#include <type_traits>
#include <variant>

#include "geometry/block.h"
#include "geometry/list.h"
#include "geometry/outline.h"
#include "geometry/solid.h"

namespace wisp {

/// Ball (disc in 2D), boundary included.
template <int dim>
struct Sphere {
  using Vector = Eigen::Matrix<double, dim, 1>;
  Vector centre;  ///< m
  double radius;  ///< m

  bool contains(const Vector& x) const { return (x - centre).squaredNorm() <= radius * radius; }
};

/// A shape with an inside. Visit it once, around the loop over the points:
///     std::visit([&](const auto& r) { for (...) if (r.contains(x)) ...; }, region);
template <int dim>
using Region = std::conditional_t<dim == 2, std::variant<Block<dim>, Sphere<dim>, Outline>,
                                  std::variant<Block<dim>, Sphere<dim>, Solid>>;

/// Checks a shape and makes it ready. `folder` is where relative file names start from. Throws InputError,
/// which names shape and key, for a wrong number of values, numbers that are not finite, lower >= upper, a
/// radius that is not positive, a polygon in 3D or one that is not simple, an STL file in 2D or a faulty one,
/// and for PointFile, which has no inside.
template <int dim>
Region<dim> region(const AnyShape& shape, const std::filesystem::path& folder = {});
template <int dim>
Region<dim> region(const AnyRegion& shape, const std::filesystem::path& folder = {});

/// Smallest axis-aligned box around.
template <int dim>
Block<dim> bounds(const Block<dim>& block) {
  return block;
}
template <int dim>
Block<dim> bounds(const Sphere<dim>& sphere) {
  return {sphere.centre.array() - sphere.radius, sphere.centre.array() + sphere.radius};
}
inline Block<2> bounds(const Outline& outline) { return {outline.lower(), outline.upper()}; }
inline Block<3> bounds(const Solid& solid) { return solid.surface().bounds(); }
/// Of points: their domains included if they have half-lengths.
template <int dim>
Block<dim> bounds(const PointTable<dim>& table);

/// Exact area (2D, m²) or volume (3D, m³).
template <int dim>
double measure(const Block<dim>& block) {
  return (block.upper - block.lower).prod();
}
template <int dim>
double measure(const Sphere<dim>& sphere) {
  const double r = sphere.radius;
  return dim == 2 ? std::numbers::pi * r * r : 4.0 / 3.0 * std::numbers::pi * r * r * r;
}
inline double measure(const Outline& outline) { return outline.area(); }
inline double measure(const Solid& solid) { return solid.volume(); }
/// Of points: the sum of their volumes.
template <int dim>
double measure(const PointTable<dim>& table);

/// The same for any region; for single questions, not for loops.
template <class... R>
bool contains(const std::variant<R...>& any, const auto& x) {
  return std::visit([&](const auto& r) { return r.contains(x); }, any);
}
template <class... R>
auto bounds(const std::variant<R...>& any) {
  return std::visit([](const auto& r) { return bounds(r); }, any);
}
template <class... R>
double measure(const std::variant<R...>& any) {
  return std::visit([](const auto& r) { return measure(r); }, any);
}

}  // namespace wisp
