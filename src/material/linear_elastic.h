// Small-strain linear elasticity.
#pragma once
#include <array>
#include <tuple>

#include "material/elasticity.h"
#include "material/kinematics.h"

namespace wisp {

/// sigma += lambda tr(de) I + 2 mu de with de = sym(dF) - I. Rotations are not seen: small displacements
/// only.
struct LinearElastic {
  static constexpr std::string_view name = "linear-elastic";
  static constexpr std::string_view summary = "isotropic linear elasticity, small strains and rotations";
  static constexpr std::string_view source = "";
  static constexpr bool finite_strain = false;

  double density = 1000.0;
  double young_modulus = 1e6;
  double poisson_ratio = 0.0;

  static constexpr auto keys() {
    return std::tuple{
        key("density", &LinearElastic::density, "kg/m3", "initial mass density").at_least(0.0).required(),
        key("young_modulus", &LinearElastic::young_modulus, "Pa", "Young's modulus").at_least(0.0).required(),
        key("poisson_ratio", &LinearElastic::poisson_ratio, "-", "Poisson's ratio").above(-1.0).below(0.5)};
  }

  template <int dim>
  struct State {
    Sym<dim> stress = Sym<dim>::Zero();  ///< Cauchy stress [Pa]
  };

  /// A loop over points should call this on a local copy of the law: then the compiler knows that no stress
  /// it writes can change the parameters, and computes the constants once.
  constexpr Elasticity elasticity() const { return Elasticity::from(young_modulus, poisson_ratio); }

  template <int dim>
  State<dim> initial(const Sym<dim>& cauchy_stress) const {
    return {cauchy_stress};
  }

  template <int dim>
  void stress(const Kinematics<dim>& kinematics, const State<dim>& old, State<dim>& now) const {
    const Elasticity e = elasticity();
    const Mat<dim>& f = kinematics.dF;
    const double two_mu = 2.0 * e.mu;
    if constexpr (dim == 2) {
      const double exx = f(0, 0) - 1.0;
      const double eyy = f(1, 1) - 1.0;
      const double pressure = e.lambda * (exx + eyy);
      add(old, now, {pressure + two_mu * exx, pressure + two_mu * eyy, pressure, e.mu * (f(0, 1) + f(1, 0))});
    } else {
      const double exx = f(0, 0) - 1.0;
      const double eyy = f(1, 1) - 1.0;
      const double ezz = f(2, 2) - 1.0;
      const double pressure = e.lambda * (exx + eyy + ezz);
      add(old, now,
          {pressure + two_mu * exx, pressure + two_mu * eyy, pressure + two_mu * ezz,
           e.mu * (f(0, 1) + f(1, 0)), e.mu * (f(1, 2) + f(2, 1)), e.mu * (f(2, 0) + f(0, 2))});
    }
  }

  template <int dim>
  void tangent(const Kinematics<dim>&, const State<dim>&, const State<dim>&, Tangent<dim>& c) const {
    expand<dim>(elasticity().map<dim>(), c);
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

 private:
  /// Number by number: a vector built from its numbers and then read in one piece makes the machine wait.
  template <int dim>
  static void add(const State<dim>& old, State<dim>& now, const std::array<double, sym_size<dim>>& d) {
    for (int a = 0; a < sym_size<dim>; ++a) now.stress[a] = old.stress[a] + d[static_cast<std::size_t>(a)];
  }
};

static_assert(Material<LinearElastic>);

}  // namespace wisp
