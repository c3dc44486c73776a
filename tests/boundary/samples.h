// A grid with one body for the tests of conditions and loads.
#pragma once
#include <memory>

#include "particle/order.h"
#include "particle/sampling.h"

namespace wisp::boundary_test {

template <int dim>
struct Scene {
  std::unique_ptr<Space<dim>> space;
  std::vector<Body<dim>> bodies;
};

/// A block [1, 2]^dim in a grid [0, 4]^dim of unequal lines; `width` 2 is linear, 3 and 5 GIMP.
template <int dim>
Scene<dim> scene(int width) {
  std::array<std::vector<double>, dim> lines;
  for (int d = 0; d < dim; ++d) lines[static_cast<std::size_t>(d)] = {0.0, 0.4, 1.0, 1.5, 2.0, 2.8, 3.3, 4.0};
  const StructuredGrid<dim> grid(lines);
  Scene<dim> s;
  s.space = std::make_unique<Space<dim>>(grid, BoxPartition<dim>(grid.cells()), width > 2);
  if (width > 2) s.space->set_width(width);
  BodyOptions body;
  body.label = "block";
  body.shape = Box{std::vector<double>(dim, 1.0), std::vector<double>(dim, 2.0)};
  body.material = Hencky{1000.0, 1e6, 0.3};
  s.bodies.push_back(sample<dim>(body, grid, width > 2, 100, {}));
  if (width == 5)
    for (auto& l : s.bodies[0].points.half_length) l *= 3.0;
  locate(s.bodies[0].points, grid, s.space->window());
  return s;
}

/// Sum of n_functions x dim forces, and of their moments x ^ f.
template <int dim>
struct Resultant {
  Vec<dim> force = Vec<dim>::Zero();
  Mat<dim> moment = Mat<dim>::Zero();
};
template <int dim>
Resultant<dim> resultant(const Space<dim>& space, const std::vector<double>& force) {
  Resultant<dim> r;
  for (int i = 0; i < space.n_functions(); ++i) {
    const Vec<dim> f = Eigen::Map<const Vec<dim>>(force.data() + i * dim), x = space.node_position(i);
    r.force += f;
    r.moment += x * f.transpose() - f * x.transpose();
  }
  return r;
}

}  // namespace wisp::boundary_test
