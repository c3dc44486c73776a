// A block of points with random motion and stress on an unequal grid, for every basis.
#pragma once
#include <random>

#include "particle/order.h"
#include "particle/sampling.h"
#include "transfer/explicit_transfer.h"
#include "transfer/implicit_transfer.h"
#include "transfer/mass.h"

namespace wisp::transfer_test {

class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}
  double operator()(double amplitude) {
    return std::uniform_real_distribution<double>(-amplitude, amplitude)(generator_);
  }
  template <int dim>
  Vec<dim> vector(double amplitude) {
    Vec<dim> v;
    for (int d = 0; d < dim; ++d) v[d] = (*this)(amplitude);
    return v;
  }
  template <int dim>
  Mat<dim> matrix(double amplitude) {
    Mat<dim> m;
    for (int d = 0; d < dim; ++d) m.col(d) = vector<dim>(amplitude);
    return m;
  }
  std::vector<double> field(std::size_t n, double amplitude) {
    std::vector<double> f(n);
    for (double& v : f) v = (*this)(amplitude);
    return f;
  }

 private:
  std::mt19937 generator_;
};

template <int dim>
struct Scene {
  std::unique_ptr<Space<dim>> space;
  std::vector<Body<dim>> bodies;

  Body<dim>& body() { return bodies[0]; }
  Particles<dim>& points() { return bodies[0].points; }
  std::size_t n() const { return static_cast<std::size_t>(space->n_functions()); }
  /// n_functions x dim numbers u(x_i) of a field.
  template <class F>
  std::vector<double> at_nodes(F&& field) const {
    std::vector<double> u(n() * dim);
    for (int i = 0; i < space->n_functions(); ++i)
      Eigen::Map<Vec<dim>>(u.data() + i * dim) = field(space->node_position(i));
    return u;
  }
};

inline Hencky sample_hencky() { return {800.0, 1000.0, 0.3}; }
inline LinearElastic sample_linear() { return {800.0, 1000.0, 0.3}; }
inline VonMises sample_von_mises() { return {800.0, 1000.0, 0.3, 8.0, 60.0}; }

/// `width` functions a direction: 2 linear, 3 and 5 GIMP. Points do not sit on grid lines; their domains,
/// with random sizes that the width carries, lie inside the grid.
template <int dim>
Scene<dim> scene(const AnyLaw& law, int width, unsigned seed = 7) {
  std::array<std::vector<double>, dim> lines;
  for (int d = 0; d < dim; ++d) lines[static_cast<std::size_t>(d)] = {0.0, 0.5, 1.0, 1.4, 2.0, 2.5, 3.0};
  const StructuredGrid<dim> grid(lines);
  Scene<dim> s;
  s.space = std::make_unique<Space<dim>>(grid, BoxPartition<dim>(grid.cells()), width > 2);
  if (width > 2) s.space->set_width(width);
  BodyOptions options;
  options.label = "block";
  options.shape = Box{std::vector<double>(dim, 1.0), std::vector<double>(dim, 2.0)};
  options.material = law;
  s.bodies.push_back(sample<dim>(options, grid, width > 2, 0, {}));
  Random random(seed);
  auto& points = s.points();
  for (auto& x : points.position) x += random.vector<dim>(0.05);
  for (auto& v : points.velocity) v = random.vector<dim>(2.0);
  for (auto& m : points.mass) m *= 1.0 + random(0.3);
  if (width > 2) {
    const double mean = width == 3 ? 0.14 : 0.4;
    for (auto& l : points.half_length) l = Vec<dim>::Constant(mean) + random.vector<dim>(0.4 * mean);
    points.initial_half_length = points.half_length;
  }
  locate(points, s.space->grid(), s.space->window());
  OrderMemory memory;
  reorder(s.body(), s.space->window().n_cells(), memory);
  // Give every point a stress by a random strain.
  std::visit(
      [&](auto& group) {
        for (auto& state : group.old)
          group.law.template stress<dim>(
              Kinematics<dim>{Mat<dim>::Identity() + random.matrix<dim>(0.01), 0.0}, state, state);
      },
      s.body().material);
  return s;
}

/// Kirchhoff stresses of the last finished step, or of the trial one.
template <int dim>
std::vector<Sym<dim>> stresses(const Body<dim>& body, bool trial = false) {
  std::vector<Sym<dim>> list;
  std::visit(
      [&](const auto& group) {
        for (const auto& s : trial ? group.now : group.old) list.push_back(s.stress);
      },
      body.material);
  return list;
}

/// Strain energy of the trial states, J.
template <int dim>
double trial_energy(const Body<dim>& body) {
  return std::visit(
      [&](const auto& group) {
        double sum = 0.0;
        for (std::size_t p = 0; p < group.now.size(); ++p)
          sum += body.points.volume[p] * group.law.template strain_energy<dim>(group.now[p]);
        return sum;
      },
      body.material);
}

inline double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}
inline double largest(std::span<const double> a) {
  double m = 0.0;
  for (const double v : a) m = std::max(m, std::abs(v));
  return m;
}

/// Calls f.template operator()<dim, width>() for both dimensions and every width.
template <class F>
void for_each_basis(F&& f) {
  f.template operator()<2, 2>();
  f.template operator()<2, 3>();
  f.template operator()<2, 5>();
  f.template operator()<3, 2>();
  f.template operator()<3, 3>();
  f.template operator()<3, 5>();
}

}  // namespace wisp::transfer_test
