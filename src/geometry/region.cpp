#include "geometry/region.h"

#include <cmath>

#include "core/error.h"

namespace wisp {
namespace {

template <int dim>
Eigen::Matrix<double, dim, 1> vector(const std::vector<double>& values, std::string_view shape,
                                     std::string_view key) {
  if (values.size() != static_cast<std::size_t>(dim))
    input_error("{}: '{}' has {} {}, expected {} in {}D", shape, key, values.size(),
                values.size() == 1 ? "value" : "values", dim, dim);
  for (const double v : values)
    if (!std::isfinite(v)) input_error("{}: '{}' holds {}, expected finite numbers", shape, key, v);
  return Eigen::Map<const Eigen::Matrix<double, dim, 1>>(values.data());
}

template <int dim>
Region<dim> make(const Box& box, const std::filesystem::path&) {
  const Block<dim> block{vector<dim>(box.lower, Box::name, "lower"),
                         vector<dim>(box.upper, Box::name, "upper")};
  for (int i = 0; i < dim; ++i)
    if (!(block.lower[i] < block.upper[i]))
      input_error("box: 'lower' is {} and 'upper' is {} in direction {}, expected lower < upper",
                  block.lower[i], block.upper[i], "xyz"[i]);
  return block;
}

template <int dim>
Region<dim> make(const Ball& ball, const std::filesystem::path&) {
  const auto centre = vector<dim>(ball.centre, Ball::name, "centre");
  if (!(ball.radius > 0.0) || !std::isfinite(ball.radius))
    input_error("ball: 'radius' is {}, expected a positive finite number", ball.radius);
  return Sphere<dim>{centre, ball.radius};
}

template <int dim>
Region<dim> make(const Polygon& polygon, const std::filesystem::path& folder) {
  if constexpr (dim == 2) {
    return outline(polygon, folder);
  } else {
    input_error("polygon: a shape for 2D, but the case is 3D; expected box, ball, stl or points");
  }
}

template <int dim>
Region<dim> make(const StlSolid& stl, const std::filesystem::path& folder) {
  if constexpr (dim == 3) {
    if (!(stl.scale > 0.0) || !std::isfinite(stl.scale))
      input_error("stl: 'scale' is {}, expected a positive finite number", stl.scale);
    const auto offset = vector<3>(stl.offset, StlSolid::name, "offset");
    Triangles mesh = read_stl(folder / stl.file);
    for (auto& x : mesh.vertices) x = stl.scale * x + offset;
    return Solid(std::move(mesh));
  } else {
    input_error("stl: a shape for 3D, but the case is 2D; expected box, ball, polygon or points");
  }
}

template <int dim>
Region<dim> make(const PointFile&, const std::filesystem::path&) {
  input_error("points: a list of points has no inside; expected box, ball or polygon");
}

template <int dim>
Region<dim> make(const MeshShape&, const std::filesystem::path&) {
  input_error(
      "mesh: points are put into its triangles, which needs a grid of triangles; expected box, ball or "
      "polygon");
}

}  // namespace

template <int dim>
Region<dim> region(const AnyShape& shape, const std::filesystem::path& folder) {
  return std::visit([&](const auto& s) { return make<dim>(s, folder); }, shape);
}
template <int dim>
Region<dim> region(const AnyRegion& shape, const std::filesystem::path& folder) {
  return std::visit([&](const auto& s) { return make<dim>(s, folder); }, shape);
}

template <int dim>
Block<dim> bounds(const PointTable<dim>& table) {
  if (table.positions.empty()) input_error("points: an empty list has no bounds");
  Block<dim> block{table.positions[0], table.positions[0]};
  for (std::size_t p = 0; p < table.positions.size(); ++p) {
    Eigen::Matrix<double, dim, 1> half = Eigen::Matrix<double, dim, 1>::Zero();
    if (!table.half_lengths.empty()) half = table.half_lengths[p];
    block.lower = block.lower.cwiseMin(table.positions[p] - half);
    block.upper = block.upper.cwiseMax(table.positions[p] + half);
  }
  return block;
}

template <int dim>
double measure(const PointTable<dim>& table) {
  double sum = 0.0;
  for (const double v : table.volumes) sum += v;
  return sum;
}

template Region<2> region<2>(const AnyShape&, const std::filesystem::path&);
template Region<3> region<3>(const AnyShape&, const std::filesystem::path&);
template Region<2> region<2>(const AnyRegion&, const std::filesystem::path&);
template Region<3> region<3>(const AnyRegion&, const std::filesystem::path&);
template Block<2> bounds<2>(const PointTable<2>&);
template Block<3> bounds<3>(const PointTable<3>&);
template double measure<2>(const PointTable<2>&);
template double measure<3>(const PointTable<3>&);

}  // namespace wisp
