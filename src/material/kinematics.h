// What a material law is, and what it is told about the motion of its point.
#pragma once
#include <concepts>
#include <type_traits>

#include "core/describe.h"
#include "tensor/tensor.h"

namespace wisp {

/// The motion of one point over one step.
template <int dim>
struct Kinematics {
  Mat<dim> dF = Mat<dim>::Identity();  ///< I + u (x) grad phi on the start-of-step configuration
  double dt = 0.0;                     ///< s; zero where time plays no part
};

/// A law in one dimension. Its `State<dim>` is a plain record of bytes (no pointers) whose first member is
/// `Sym<dim> stress`: the Kirchhoff stress of a finite-strain law, the Cauchy stress of a small-strain one.
/// Volumes that go with it are always the initial ones.
/// - `initial(sigma)`: the state at rest under a Cauchy stress, at F = I. Input error if the law cannot carry
/// it.
/// - `stress(kinematics, old, now)`: writes every member of `now`; `old` and `now` may be the same object.
/// - `tangent(kinematics, old, now, c)`: consistent with `stress`: d(sum_j tau_ij N_,j) = sum_jkl N_,j c_ijkl
/// du_k,l
///   with gradients in the current configuration; so c, per initial volume, contains the geometric term
///   -tau_il d_jk of a finite-strain law. `old` must be the state before the step.
/// - `strain_energy`, `dissipation` per initial volume [J/m3], `plastic_strain` (equivalent) [-],
///   `p_wave_modulus` lambda + 2 mu [Pa].
template <class M, int dim>
concept MaterialIn = requires(const M law, const Kinematics<dim> kinematics, const Sym<dim> sigma,
                              const typename M::template State<dim> old, typename M::template State<dim> now,
                              Tangent<dim> c) {
  requires std::is_trivially_destructible_v<typename M::template State<dim>>;
  requires std::is_standard_layout_v<typename M::template State<dim>>;
  { now.stress } -> std::same_as<Sym<dim>&>;
  { M::finite_strain } -> std::convertible_to<bool>;
  { law.density } -> std::convertible_to<double>;
  { law.template initial<dim>(sigma) } -> std::same_as<typename M::template State<dim>>;
  { law.template stress<dim>(kinematics, old, now) } -> std::same_as<void>;
  { law.template tangent<dim>(kinematics, old, now, c) } -> std::same_as<void>;
  { law.template strain_energy<dim>(old) } -> std::same_as<double>;
  { law.template dissipation<dim>(old) } -> std::same_as<double>;
  { law.template plastic_strain<dim>(old) } -> std::same_as<double>;
  { law.p_wave_modulus() } -> std::same_as<double>;
};

template <class M>
concept Material = Described<M> && std::is_aggregate_v<M> && MaterialIn<M, 2> && MaterialIn<M, 3>;

}  // namespace wisp
