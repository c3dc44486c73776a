#include "transfer/density.h"

#include <vector>

#include "parallel/session.h"
#include "particle/mean_motion.h"
#include "transfer/explicit_transfer.h"
#include "transfer/filled_cells.h"
#include "transfer/stencil_blocks.h"

namespace wisp {

namespace {

constexpr auto to_mass_degree = [](const auto& basis) { return mass_degree<std::decay_t<decltype(basis)>>; };

/// rho_h of a filled cell.
template <int dim>
struct Density {
  typename TaylorBasis<dim>::Terms coefficient;

  Density(const Particles<dim>& points, bool finite_strain, const FilledCell<dim>& cell) {
    typename TaylorBasis<dim>::Terms right = TaylorBasis<dim>::Terms::Zero();
    double mass = 0.0;
    for (const int q : cell.points) {
      const auto p = static_cast<std::size_t>(q);
      const double volume = points.volume[p] * volume_ratio(points, finite_strain, p);
      right += points.mass[p] / volume * cell.taylor.at(points.position[p]);
      mass += points.mass[p];
    }
    coefficient = cell.inverse * right;
    coefficient[0] = mass / cell.taylor.volume;
    for (const auto& g : cell.gauss)
      if (!(at(cell, g.x) > 0.0)) {
        coefficient.template tail<dim>().setZero();
        break;
      }
  }
  double at(const FilledCell<dim>& cell, const Vec<dim>& x) const {
    return coefficient.dot(cell.taylor.at(x));
  }
};

/// Calls f(basis, x, mass) for every Gauss point with its mass and every point with minus
/// its mass, in the filled cells.
template <int dim, class F>
void for_each_exchange(const Space<dim>& space, const Body<dim>& body, const std::vector<char>& inside,
                       F&& f) {
  for_each_filled<dim>(space, body, inside, to_mass_degree,
                       [&](const auto& basis, const FilledCell<dim>& cell) {
                         const Density<dim> density(body.points, body.finite_strain(), cell);
                         for (const auto& g : cell.gauss) f(basis, g.x, g.weight * density.at(cell, g.x));
                         for (const int q : cell.points) {
                           const auto p = static_cast<std::size_t>(q);
                           f(basis, body.points.position[p], -body.points.mass[p]);
                         }
                       });
}

/// Centre of mass of points on all ranks. Collective.
template <int dim>
Vec<dim> centre_of(const Particles<dim>& points) {
  double mass = 0.0;
  Vec<dim> first = Vec<dim>::Zero();
  for (std::size_t p = 0; p < points.mass.size(); ++p)
    mass += points.mass[p], first += points.mass[p] * points.position[p];
  return Vec<dim>(Session::sum(first) / Session::sum(mass));
}

}  // namespace

template <int dim>
void add_density_pattern(const Space<dim>& space, const std::vector<Body<dim>>& bodies,
                         const ActiveCells& cells, BlockMatrix& matrix) {
  const Vec<dim> none = Vec<dim>::Zero();
  StencilSets sets(space.n_keys());
  std::visit(
      [&](const auto& basis) {
        if constexpr (!std::decay_t<decltype(basis)>::uses_domains) {
          for (std::size_t b = 0; b < bodies.size(); ++b)
            for_each_cell<dim>(space, basis, cells_inside(space, cells, b), to_mass_degree(basis),
                               [&](int, const std::vector<GaussPoint<dim>>& gauss) {
                                 for (const auto& g : gauss)
                                   sets.add(basis.tabulate(g.x, none),
                                            [&](const auto& functions) { matrix.add_element(functions); });
                               });
        }
      },
      space.basis());
}

template <int dim>
void exchange_mass(const Space<dim>& space, const std::vector<Body<dim>>& bodies, const ActiveCells& cells,
                   BlockMatrix& mass) {
  const Vec<dim> none = Vec<dim>::Zero();
  const auto flush = [&](std::span<const int> functions, const double* dense) {
    mass.add_scalar(functions, dense);
  };
  const int n = std::visit(
      [](const auto& basis) { return std::decay_t<decltype(basis)>::Stencil::max_functions; }, space.basis());
  StencilBlocks blocks(n, 1);
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for_each_exchange<dim>(space, bodies[b], cells_inside(space, cells, b),
                           [&](const auto& basis, const Vec<dim>& x, double m) {
                             add_products(blocks, basis.tabulate(x, none), m, flush);
                           });
  blocks.finish(flush);
}

template <int dim>
void exchange_weight(const Space<dim>& space, const std::vector<Body<dim>>& bodies, const ActiveCells& cells,
                     const Vec<dim>& gravity, std::span<double> sums) {
  const Vec<dim> none = Vec<dim>::Zero();
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for_each_exchange<dim>(
        space, bodies[b], cells_inside(space, cells, b), [&](const auto& basis, const Vec<dim>& x, double m) {
          basis.tabulate(x, none).for_each([&](int, int i, double phi, const Vec<dim>&) {
            double* const out = sums.data() + static_cast<std::ptrdiff_t>(i) * sums_stride<dim> + 1 + dim;
            for (int d = 0; d < dim; ++d) out[d] += phi * m * gravity[d];
          });
        });
}

template <int dim>
void balance_momentum(const Space<dim>& space, std::vector<Body<dim>>& bodies, const ActiveCells& cells,
                      std::span<const double> motion, double dt) {
  using Sums = MotionSums<dim>;
  const Vec<dim> none = Vec<dim>::Zero();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    Particles<dim>& points = bodies[b].points;
    const Vec<dim> centre = centre_of(points);
    std::vector<double> sums(Sums::count, 0.0);
    bool any = false;
    for_each_exchange<dim>(space, bodies[b], cells_inside(space, cells, b),
                           [&](const auto& basis, const Vec<dim>& x, double m) {
                             Vec<dim> a = Vec<dim>::Zero();
                             basis.tabulate(x, none).for_each([&](int, int i, double phi, const Vec<dim>&) {
                               const double* const record = motion.data() + i * motion_stride<dim>;
                               for (int d = 0; d < dim; ++d) a[d] += phi * record[dim + d];
                             });
                             Sums::add_momentum(m * dt * a, x - centre, sums.data());
                             any = true;
                           });
    if (!Session::any_of(any)) continue;
    for (std::size_t p = 0; p < points.mass.size(); ++p)
      Sums::add_mass(points.mass[p], points.position[p] - centre, sums.data());
    Session::sum_in_place(sums);
    const MeanMotion<dim> rigid = Sums::motion(sums.data());
    for (std::size_t p = 0; p < points.velocity.size(); ++p)
      points.velocity[p] += rigid.velocity(points.position[p] - centre);
  }
}

template void add_density_pattern<2>(const Space<2>&, const std::vector<Body<2>>&, const ActiveCells&,
                                     BlockMatrix&);
template void add_density_pattern<3>(const Space<3>&, const std::vector<Body<3>>&, const ActiveCells&,
                                     BlockMatrix&);
template void exchange_mass<2>(const Space<2>&, const std::vector<Body<2>>&, const ActiveCells&,
                               BlockMatrix&);
template void exchange_mass<3>(const Space<3>&, const std::vector<Body<3>>&, const ActiveCells&,
                               BlockMatrix&);
template void exchange_weight<2>(const Space<2>&, const std::vector<Body<2>>&, const ActiveCells&,
                                 const Vec<2>&, std::span<double>);
template void exchange_weight<3>(const Space<3>&, const std::vector<Body<3>>&, const ActiveCells&,
                                 const Vec<3>&, std::span<double>);
template void balance_momentum<2>(const Space<2>&, std::vector<Body<2>>&, const ActiveCells&,
                                  std::span<const double>, double);
template void balance_momentum<3>(const Space<3>&, std::vector<Body<3>>&, const ActiveCells&,
                                  std::span<const double>, double);

}  // namespace wisp
