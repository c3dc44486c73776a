#include "transfer/density.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "parallel/session.h"
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

/// Rigid motion, velocity c + w x (x - centre) of a body. In the plane w has one number.
template <int dim>
struct RigidMotion {
  static constexpr int spins = dim == 2 ? 1 : 3;
  using Spin = Eigen::Matrix<double, spins, 1>;
  Vec<dim> centre, c;
  Spin w;

  static Spin cross(const Vec<dim>& x, const Vec<dim>& v) {
    if constexpr (dim == 2)
      return Spin(x[0] * v[1] - x[1] * v[0]);
    else
      return x.cross(v);
  }
  Vec<dim> at(const Vec<dim>& x) const {
    if constexpr (dim == 2)
      return c + w[0] * Vec<2>(-(x - centre)[1], (x - centre)[0]);
    else
      return c + w.cross(x - centre);
  }
};

/// The motion of the points of a body (on all ranks) that has this momentum and moment of momentum about the
/// origin. Collective.
template <int dim>
RigidMotion<dim> motion_with(const Particles<dim>& points, const Vec<dim>& momentum,
                             const typename RigidMotion<dim>::Spin& moment) {
  using Motion = RigidMotion<dim>;
  double mass = 0.0;
  Vec<dim> first = Vec<dim>::Zero();
  for (std::size_t p = 0; p < points.mass.size(); ++p)
    mass += points.mass[p], first += points.mass[p] * points.position[p];
  mass = Session::sum(mass), first = Session::sum(first);
  Motion motion{first / mass, momentum / mass, {}};
  Eigen::Matrix<double, Motion::spins, Motion::spins> inertia;
  inertia.setZero();
  for (std::size_t p = 0; p < points.mass.size(); ++p) {
    const Vec<dim> r = points.position[p] - motion.centre;
    if constexpr (dim == 2)
      inertia(0, 0) += points.mass[p] * r.squaredNorm();
    else
      inertia += points.mass[p] * (r.squaredNorm() * Mat<3>::Identity() - r * r.transpose());
  }
  inertia = Session::sum(inertia);
  motion.w = inertia.ldlt().solve(moment - Motion::cross(motion.centre, momentum));
  return motion;
}

}  // namespace

template <int dim>
void add_density_pattern(const Space<dim>& space, const std::vector<Body<dim>>& bodies,
                         const ActiveCells& cells, BlockMatrix& matrix) {
  const Vec<dim> none = Vec<dim>::Zero();
  std::vector<int> functions;
  std::visit(
      [&](const auto& basis) {
        if constexpr (!std::decay_t<decltype(basis)>::uses_domains) {
          std::vector<char> seen(static_cast<std::size_t>(space.n_keys()), 0);
          for (std::size_t b = 0; b < bodies.size(); ++b)
            for_each_cell<dim>(space, basis, cells_inside(space, cells, b), to_mass_degree(basis),
                               [&](int, const std::vector<GaussPoint<dim>>& gauss) {
                                 for (const auto& g : gauss) {
                                   const auto stencil = basis.tabulate(g.x, none);
                                   char& flag = seen[static_cast<std::size_t>(stencil.key())];
                                   if (flag) continue;
                                   flag = 1;
                                   functions.resize(static_cast<std::size_t>(stencil.size()));
                                   stencil.for_each([&](int k, int i, double, const Vec<dim>&) {
                                     functions[static_cast<std::size_t>(k)] = i;
                                   });
                                   matrix.add_element(functions);
                                 }
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
  std::visit(
      [&](const auto& any) {
        constexpr int n = std::decay_t<decltype(any)>::Stencil::max_functions;
        StencilBlocks blocks(n, 1);
        for (std::size_t b = 0; b < bodies.size(); ++b)
          for_each_exchange<dim>(
              space, bodies[b], cells_inside(space, cells, b),
              [&](const auto& basis, const Vec<dim>& x, double m) {
                if constexpr (std::is_same_v<std::decay_t<decltype(basis)>, std::decay_t<decltype(any)>>) {
                  const auto stencil = basis.tabulate(x, none);
                  double* const dense = blocks.find(
                      stencil.key(),
                      [&](int* functions) {
                        stencil.for_each([&](int k, int i, double, const Vec<dim>&) { functions[k] = i; });
                      },
                      flush);
                  double phi[n];
                  stencil.for_each([&](int k, int, double value, const Vec<dim>&) { phi[k] = value; });
                  for (int i = 0; i < n; ++i)
                    for (int j = 0; j < n; ++j) dense[i * n + j] += m * phi[i] * phi[j];
                }
              });
        blocks.finish(flush);
      },
      space.basis());
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
  const Vec<dim> none = Vec<dim>::Zero();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    Particles<dim>& points = bodies[b].points;
    Vec<dim> momentum = Vec<dim>::Zero();
    typename RigidMotion<dim>::Spin moment = RigidMotion<dim>::Spin::Zero();
    bool any = false;
    for_each_exchange<dim>(space, bodies[b], cells_inside(space, cells, b),
                           [&](const auto& basis, const Vec<dim>& x, double m) {
                             Vec<dim> a = Vec<dim>::Zero();
                             basis.tabulate(x, none).for_each([&](int, int i, double phi, const Vec<dim>&) {
                               const double* const record = motion.data() + i * motion_stride<dim>;
                               for (int d = 0; d < dim; ++d) a[d] += phi * record[dim + d];
                             });
                             momentum += m * dt * a, moment += m * dt * RigidMotion<dim>::cross(x, a);
                             any = true;
                           });
    if (!Session::any_of(any)) continue;
    momentum = Session::sum(momentum), moment = Session::sum(moment);
    const RigidMotion<dim> rigid = motion_with<dim>(points, momentum, moment);
    for (std::size_t p = 0; p < points.velocity.size(); ++p)
      points.velocity[p] += rigid.at(points.position[p]);
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
