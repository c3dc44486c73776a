#include "transfer/implicit_transfer.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

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

/// dense[i][k][a][b] += sum_jl g_j(a) c_ijkl g_l(b) for one point; `g` holds component j of all gradients
/// side by side, so that the innermost loops run over contiguous functions.
template <int dim, int n>
void add_point_stiffness(const Tangent<dim>& c, const double (&g)[dim][n], double* dense) {
  for (int i = 0; i < dim; ++i)
    for (int k = 0; k < dim; ++k) {
      double t[dim][n];
      for (int j = 0; j < dim; ++j)
        for (int b = 0; b < n; ++b) {
          double sum = 0.0;
          for (int l = 0; l < dim; ++l) sum += c(i * dim + j, k * dim + l) * g[l][b];
          t[j][b] = sum;
        }
      double* const block = dense + (i * dim + k) * n * n;
      for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) {
          double sum = 0.0;
          for (int j = 0; j < dim; ++j) sum += g[j][a] * t[j][b];
          block[a * n + b] += sum;
        }
    }
}

template <int dim, int n, class Group>
void add_group_stiffness(const StoredStencils<dim>& stencils, const Group& group,
                         const std::vector<double>& volume, const double* u, double dt,
                         BlockMatrix& stiffness) {
  using Law = std::decay_t<decltype(group.law)>;
  const Law law = group.law;
  StencilBlocks blocks(n, dim, n > 27 ? 4 : 16);
  std::vector<double> interleaved(static_cast<std::size_t>(n * dim) * n * dim);
  const auto flush = [&](std::span<const int> functions, const double* dense) {
    for (int i = 0; i < dim; ++i)
      for (int k = 0; k < dim; ++k)
        for (int a = 0; a < n; ++a)
          for (int b = 0; b < n; ++b)
            interleaved[static_cast<std::size_t>((a * dim + i) * n * dim + b * dim + k)] =
                dense[((i * dim + k) * n + a) * n + b];
    stiffness.add(functions, interleaved.data());
  };
  for (std::size_t p = 0; p < group.old.size(); ++p) {
    const Kinematics<dim> kinematics{increment<dim>(stencils, p, u), dt};
    Tangent<dim> c;
    law.template tangent<dim>(kinematics, group.old[p], group.now[p], c);
    c *= volume[p];
    Mat<dim> push = Mat<dim>::Identity();
    if constexpr (Law::finite_strain) push = kinematics.dF.inverse().transpose();
    double g[dim][n];
    for (int k = 0; k < n; ++k) {
      const Vec<dim> gradient = push * stencils.dphi[p * n + static_cast<std::size_t>(k)];
      for (int d = 0; d < dim; ++d) g[d][k] = gradient[d];
    }
    const auto functions = [&](int* out) {
      std::copy_n(stencils.function.begin() + static_cast<std::ptrdiff_t>(p) * n, n, out);
    };
    add_point_stiffness<dim, n>(c, g, blocks.find(stencils.key[p], functions, flush));
  }
  blocks.finish(flush);
}

/// Calls f(std::integral_constant<int, n>) for every number n of functions that stencils of the bases have.
template <int dim, class F>
void for_each_size(F&& f) {
  const auto all = [&]<class... Basis>(const std::variant<Basis...>*) {
    constexpr int n_bases = sizeof...(Basis);
    static constexpr std::array<int, n_bases> size{Basis::Stencil::max_functions...};
    [&]<int... k>(std::integer_sequence<int, k...>) {
      const auto once = [&]<int i>(std::integral_constant<int, i>) {
        constexpr auto here = size.begin() + i;
        if constexpr (std::find(size.begin(), here, *here) == here) f(std::integral_constant<int, *here>());
      };
      (once(std::integral_constant<int, k>()), ...);
    }
    (std::make_integer_sequence<int, n_bases>());
  };
  all(static_cast<const AnyBasis<dim>*>(nullptr));
}

}  // namespace

template <int dim>
void add_stiffness(const StoredStencils<dim>& stencils, const Body<dim>& body, std::span<const double> u,
                   double dt, BlockMatrix& stiffness) {
  std::visit(
      [&](const auto& group) {
        bool done = false;
        for_each_size<dim>([&]<int n>(std::integral_constant<int, n>) {
          if (stencils.n != n) return;
          add_group_stiffness<dim, n>(stencils, group, body.points.volume, u.data(), dt, stiffness);
          done = true;
        });
        if (!done) throw std::logic_error("add_stiffness: stencils of a size that no basis has");
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
                right_stretch<dim>(points.deformation_gradient[p]).diagonal());
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
