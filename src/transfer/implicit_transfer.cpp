#include "transfer/implicit_transfer.h"

#include <Eigen/LU>

#include "tensor/spectral.h"
#include "transfer/stencil_blocks.h"

namespace wisp {

template <int dim>
void tabulate(const Space<dim>& space, const Particles<dim>& points, StoredStencils<dim>& stencils) {
  std::visit(
      [&](const auto& basis) {
        using Basis = std::decay_t<decltype(basis)>;
        constexpr int n = Basis::Stencil::max_functions;
        const std::size_t count = points.position.size();
        stencils.n = n;
        stencils.key.resize(count), stencils.function.resize(count * n);
        stencils.phi.resize(count * n), stencils.dphi.resize(count * n);
        const Vec<dim> none = Vec<dim>::Zero();
        for (std::size_t p = 0; p < count; ++p) {
          const auto stencil =
              basis.tabulate(points.position[p], Basis::uses_domains ? points.half_length[p] : none);
          stencils.key[p] = stencil.key();
          stencil.for_each([&](int k, int i, double phi, const Vec<dim>& dphi) {
            const std::size_t at = p * n + static_cast<std::size_t>(k);
            stencils.function[at] = i, stencils.phi[at] = phi, stencils.dphi[at] = dphi;
          });
        }
      },
      space.basis());
}

namespace {

/// dF = I + sum_i u_i (x) grad phi_i of point p.
template <int dim>
Mat<dim> increment(const StoredStencils<dim>& stencils, std::size_t p, const double* u) {
  const auto n = static_cast<std::size_t>(stencils.n);
  Mat<dim> dF = Mat<dim>::Identity();
  for (std::size_t k = p * n; k < (p + 1) * n; ++k)
    dF += Eigen::Map<const Vec<dim>>(u + stencils.function[k] * dim) * stencils.dphi[k].transpose();
  return dF;
}

}  // namespace

template <int dim>
int add_internal_force(const StoredStencils<dim>& stencils, Body<dim>& body, std::span<const double> u,
                       double dt, std::span<double> force) {
  return std::visit(
      [&](auto& group) {
        using Law = std::decay_t<decltype(group.law)>;
        const Law law = group.law;
        const auto n = static_cast<std::size_t>(stencils.n);
        group.now.resize(group.old.size());
        int inverted = 0;
        for (std::size_t p = 0; p < group.old.size(); ++p) {
          const Kinematics<dim> kinematics{increment<dim>(stencils, p, u.data()), dt};
          if (Law::finite_strain && !(kinematics.dF.determinant() > 0.0)) {
            ++inverted;
            continue;
          }
          law.template stress<dim>(kinematics, group.old[p], group.now[p]);
          Mat<dim> s = body.points.volume[p] * matrix<dim>(group.now[p].stress);
          if constexpr (Law::finite_strain) s = s * kinematics.dF.inverse().transpose();
          for (std::size_t k = p * n; k < (p + 1) * n; ++k)
            Eigen::Map<Vec<dim>>(force.data() + stencils.function[k] * dim) += s * stencils.dphi[k];
        }
        return inverted;
      },
      body.material);
}

namespace {

/// dense += V grad^T c grad for one point: g holds the gradients as columns (dim x n).
template <int dim>
void add_point_stiffness(const Tangent<dim>& c,
                         const Eigen::Matrix<double, dim, Eigen::Dynamic, Eigen::ColMajor, dim, 125>& g,
                         double* dense) {
  const int n = static_cast<int>(g.cols());
  const int rows = n * dim;
  for (int b = 0; b < n; ++b) {
    // t(i*dim + j, k) = sum_l c_ijkl g_l(b)
    Eigen::Matrix<double, dim * dim, dim> t;
    for (int k = 0; k < dim; ++k) t.col(k) = c.template middleCols<dim>(k * dim) * g.col(b);
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < dim; ++i) {
        const Eigen::Matrix<double, 1, dim> row = g.col(a).transpose() * t.template middleRows<dim>(i * dim);
        double* const out = dense + (a * dim + i) * rows + b * dim;
        for (int k = 0; k < dim; ++k) out[k] += row[k];
      }
  }
}

}  // namespace

template <int dim>
void add_stiffness(const StoredStencils<dim>& stencils, const Body<dim>& body, std::span<const double> u,
                   double dt, BlockMatrix& stiffness) {
  std::visit(
      [&](const auto& group) {
        using Law = std::decay_t<decltype(group.law)>;
        const auto n = static_cast<std::size_t>(stencils.n);
        StencilBlocks blocks(stencils.n, dim, stencils.n > 27 ? 4 : 16);
        const auto flush = [&](std::span<const int> functions, const double* dense) {
          stiffness.add(functions, dense);
        };
        Eigen::Matrix<double, dim, Eigen::Dynamic, Eigen::ColMajor, dim, 125> g(dim, stencils.n);
        for (std::size_t p = 0; p < group.old.size(); ++p) {
          const Kinematics<dim> kinematics{increment<dim>(stencils, p, u.data()), dt};
          Tangent<dim> c;
          group.law.template tangent<dim>(kinematics, group.old[p], group.now[p], c);
          c *= body.points.volume[p];
          Mat<dim> push = Mat<dim>::Identity();
          if constexpr (Law::finite_strain) push = kinematics.dF.inverse().transpose();
          for (std::size_t k = 0; k < n; ++k) g.col(static_cast<int>(k)) = push * stencils.dphi[p * n + k];
          double* const dense = blocks.find(
              stencils.key[p],
              [&](int* functions) {
                std::copy_n(stencils.function.begin() + static_cast<std::ptrdiff_t>(p * n), n, functions);
              },
              flush);
          add_point_stiffness<dim>(c, g, dense);
        }
        blocks.finish(flush);
      },
      body.material);
}

template <int dim>
void commit(const StoredStencils<dim>& stencils, Body<dim>& body, std::span<const double> u) {
  std::visit(
      [&](auto& group) {
        using Law = std::decay_t<decltype(group.law)>;
        Particles<dim>& points = body.points;
        const auto n = static_cast<std::size_t>(stencils.n);
        for (std::size_t p = 0; p < group.old.size(); ++p) {
          group.old[p] = group.now[p];
          points.deformation_gradient[p] =
              increment<dim>(stencils, p, u.data()) * points.deformation_gradient[p];
          if (Law::finite_strain && !points.half_length.empty())
            points.half_length[p] = points.initial_half_length[p].cwiseProduct(
                right_stretch(points.deformation_gradient[p]).diagonal());
          Vec<dim> displacement = Vec<dim>::Zero();
          for (std::size_t k = p * n; k < (p + 1) * n; ++k)
            displacement +=
                stencils.phi[k] * Eigen::Map<const Vec<dim>>(u.data() + stencils.function[k] * dim);
          points.position[p] += displacement;
          points.displacement[p] += displacement;
        }
      },
      body.material);
}

template void tabulate<2>(const Space<2>&, const Particles<2>&, StoredStencils<2>&);
template void tabulate<3>(const Space<3>&, const Particles<3>&, StoredStencils<3>&);
template int add_internal_force<2>(const StoredStencils<2>&, Body<2>&, std::span<const double>, double,
                                   std::span<double>);
template int add_internal_force<3>(const StoredStencils<3>&, Body<3>&, std::span<const double>, double,
                                   std::span<double>);
template void add_stiffness<2>(const StoredStencils<2>&, const Body<2>&, std::span<const double>, double,
                               BlockMatrix&);
template void add_stiffness<3>(const StoredStencils<3>&, const Body<3>&, std::span<const double>, double,
                               BlockMatrix&);
template void commit<2>(const StoredStencils<2>&, Body<2>&, std::span<const double>);
template void commit<3>(const StoredStencils<3>&, Body<3>&, std::span<const double>);

}  // namespace wisp
