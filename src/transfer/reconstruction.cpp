#include "transfer/reconstruction.h"

#include <Eigen/Cholesky>

#include "transfer/explicit_transfer.h"
#include "transfer/filled_cells.h"

namespace wisp {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr auto to_force_degree = [](const auto& basis) {
  return force_degree<std::decay_t<decltype(basis)>>;
};

/// Coefficients of the fit to the points' Cauchy stress. Leaves in `own`, for each point of the cell, minus
/// its initial volume times its Kirchhoff stress.
template <int dim>
std::array<Mat<dim>, dim + 1> fit_stress(const Body<dim>& body, const FilledCell<dim>& cell,
                                         std::vector<Mat<dim>>& own) {
  const Particles<dim>& points = body.points;
  std::array<Mat<dim>, dim + 1> right{}, coefficient{};
  for (auto& r : right) r.setZero();
  own.clear();
  std::visit(
      [&](const auto& group) {
        using Law = std::decay_t<decltype(group.law)>;
        for (const int q : cell.points) {
          const auto p = static_cast<std::size_t>(q);
          const Mat<dim> tau = matrix<dim>(group.old[p].stress);
          const auto t = cell.taylor.at(points.position[p]);
          for (int a = 0; a <= dim; ++a)
            right[at(a)] += t[a] / volume_ratio(points, Law::finite_strain, p) * tau;
          own.push_back(-points.volume[p] * tau);
        }
      },
      body.material);
  for (int a = 0; a <= dim; ++a) {
    coefficient[at(a)].setZero();
    for (int b = 0; b <= dim; ++b) coefficient[at(a)] += cell.inverse(a, b) * right[at(b)];
  }
  return coefficient;
}

template <int dim, class Stencil>
void add_force(const Stencil& stencil, const Mat<dim>& stress_times_volume, std::span<double> sums) {
  stencil.for_each([&](int, int i, double, const Vec<dim>& dphi) {
    const Vec<dim> f = stress_times_volume * dphi;
    double* const out = sums.data() + static_cast<std::ptrdiff_t>(i) * sums_stride<dim> + 1 + dim;
    for (int d = 0; d < dim; ++d) out[d] -= f[d];
  });
}

}  // namespace

template <int dim>
void add_reconstruction(const Space<dim>& space, const std::vector<Body<dim>>& bodies,
                        const ActiveCells& cells, std::span<double> sums) {
  const Vec<dim> none = Vec<dim>::Zero();
  std::vector<Mat<dim>> own;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Particles<dim>& points = bodies[b].points;
    for_each_filled<dim>(space, bodies[b], cells_inside(space, cells, b), to_force_degree,
                         [&](const auto& basis, const FilledCell<dim>& cell) {
                           const auto coefficient = fit_stress(bodies[b], cell, own);
                           for (std::size_t k = 0; k < own.size(); ++k)
                             add_force<dim>(basis.tabulate(points.position[at(cell.points[k])], none), own[k],
                                            sums);
                           for (const auto& g : cell.gauss) {
                             const auto t = cell.taylor.at(g.x);
                             Mat<dim> sigma = Mat<dim>::Zero();
                             for (int a = 0; a <= dim; ++a) sigma += t[a] * coefficient[at(a)];
                             add_force<dim>(basis.tabulate(g.x, none), Mat<dim>(g.weight * sigma), sums);
                           }
                         });
  }
}

template <int dim>
void smooth_gradients(const Space<dim>& space, const std::vector<Body<dim>>& bodies, std::size_t body,
                      const ActiveCells& cells, std::span<const double> velocity, std::size_t stride,
                      std::vector<double>& gradients) {
  constexpr int terms = TaylorBasis<dim>::terms;
  const Particles<dim>& points = bodies[body].points;
  gradients.resize(points.position.size() * dim * dim);
  const Vec<dim> none = Vec<dim>::Zero();
  const auto gradient_at = [&](const auto& basis, const Vec<dim>& x) {
    Mat<dim> gradient = Mat<dim>::Zero();
    basis.tabulate(x, none).for_each([&](int, int i, double, const Vec<dim>& dphi) {
      for (int d = 0; d < dim; ++d) gradient.row(d) += velocity[at(i) * stride + at(d)] * dphi.transpose();
    });
    return gradient;
  };
  const auto set = [&](std::size_t p, const Mat<dim>& gradient) {
    for (int d = 0; d < dim; ++d)
      for (int e = 0; e < dim; ++e) gradients[p * dim * dim + at(d * dim + e)] = gradient(d, e);
  };
  std::visit(
      [&](const auto& basis) {
        for (std::size_t p = 0; p < points.position.size(); ++p)
          set(p, gradient_at(basis, points.position[p]));
      },
      space.basis());
  for_each_filled<dim>(
      space, bodies[body], cells_inside(space, cells, body), to_force_degree,
      [&](const auto& basis, const FilledCell<dim>& cell) {
        typename TaylorBasis<dim>::Square normal = TaylorBasis<dim>::Square::Zero();
        Eigen::Matrix<double, terms, dim* dim> right = Eigen::Matrix<double, terms, dim * dim>::Zero();
        for (const auto& g : cell.gauss) {
          const Mat<dim> gradient = gradient_at(basis, g.x);
          const auto t = cell.taylor.at(g.x);
          normal += g.weight * t * t.transpose();
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e) right.col(d * dim + e) += g.weight * gradient(d, e) * t;
        }
        const Eigen::Matrix<double, terms, dim* dim> coefficient = normal.ldlt().solve(right);
        for (const int q : cell.points) {
          const auto p = static_cast<std::size_t>(q);
          const Eigen::Matrix<double, 1, dim* dim> own =
              cell.taylor.at(points.position[p]).transpose() * coefficient;
          set(p, Eigen::Map<const Mat<dim>>(own.data()).transpose());
        }
      });
}

template void smooth_gradients<2>(const Space<2>&, const std::vector<Body<2>>&, std::size_t,
                                  const ActiveCells&, std::span<const double>, std::size_t,
                                  std::vector<double>&);
template void smooth_gradients<3>(const Space<3>&, const std::vector<Body<3>>&, std::size_t,
                                  const ActiveCells&, std::span<const double>, std::size_t,
                                  std::vector<double>&);
template void add_reconstruction<2>(const Space<2>&, const std::vector<Body<2>>&, const ActiveCells&,
                                    std::span<double>);
template void add_reconstruction<3>(const Space<3>&, const std::vector<Body<3>>&, const ActiveCells&,
                                    std::span<double>);

}  // namespace wisp
