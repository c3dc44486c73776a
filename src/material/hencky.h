// Hencky's law: linear elasticity between logarithmic strain and Kirchhoff stress.
#pragma once
#include <tuple>

#include "material/finite_strain.h"

namespace wisp {

/// tau = lambda tr(eps) I + 2 mu eps with eps = ln(b)/2, the derivative of W = lambda tr(eps)^2/2 + mu
/// eps:eps per initial volume.
struct Hencky {
  static constexpr std::string_view name = "hencky";
  static constexpr std::string_view summary =
      "isotropic elasticity in logarithmic strain and Kirchhoff stress";
  static constexpr std::string_view source = "Hencky 1928; Anand 1979";
  static constexpr bool finite_strain = true;

  double density = 1000.0;
  double young_modulus = 1e6;
  double poisson_ratio = 0.0;

  static constexpr auto keys() {
    return std::tuple{
        key("density", &Hencky::density, "kg/m3", "initial mass density").at_least(0.0).required(),
        key("young_modulus", &Hencky::young_modulus, "Pa", "Young's modulus").at_least(0.0).required(),
        key("poisson_ratio", &Hencky::poisson_ratio, "-", "Poisson's ratio").above(-1.0).below(0.5)};
  }

  template <int dim>
  struct State {
    Sym<dim> stress = Sym<dim>::Zero();        ///< Kirchhoff stress [Pa]
    Sym<dim> elastic_b = sym_identity<dim>();  ///< left Cauchy-Green tensor exp(2 eps) [-]
  };

  constexpr Elasticity elasticity() const { return Elasticity::from(young_modulus, poisson_ratio); }

  /// The initial volume is the one at F = I, under the initial stress: there J = 1, tau = sigma, and W counts
  /// per that volume, so the elastic strain is D^-1 sigma although det(b) differs from 1.
  template <int dim>
  State<dim> initial(const Sym<dim>& cauchy_stress) const {
    return {cauchy_stress, initial_elastic_b<dim>(elasticity(), cauchy_stress, name)};
  }

  template <int dim>
  void stress(const Kinematics<dim>& kinematics, const State<dim>& old, State<dim>& now) const {
    const TrialStrain<dim> trial(kinematics, old.elastic_b);
    now.elastic_b = trial.b;
    now.stress = trial.on_axes(elasticity().principal_stress(trial.principal));
  }

  template <int dim>
  void tangent(const Kinematics<dim>& kinematics, const State<dim>& old, const State<dim>& now,
               Tangent<dim>& c) const {
    spatial_tangent<dim>(elasticity().map<dim>(), TrialStrain<dim>(kinematics, old.elastic_b), now.stress, c);
  }

  template <int dim>
  double strain_energy(const State<dim>& state) const {
    return elasticity().energy<dim>(state.stress);
  }
  template <int dim>
  double dissipation(const State<dim>&) const {
    return 0.0;
  }
  template <int dim>
  double plastic_strain(const State<dim>&) const {
    return 0.0;
  }
  constexpr double p_wave_modulus() const { return elasticity().p_wave_modulus(); }
};

static_assert(Material<Hencky>);

}  // namespace wisp
