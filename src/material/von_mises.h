// Von Mises plasticity at finite strain: logarithmic strain, Kirchhoff stress, exponential-map radial return.
#pragma once
#include <cmath>
#include <tuple>

#include "material/finite_strain.h"

namespace wisp {

/// f = sqrt(2 J2(tau)) - rho_y(alpha) <= 0 on Kirchhoff stress, associated flow, with
///     rho_y(alpha) = yield_stress + sqrt(2/3) hardening_modulus alpha,
/// alpha the equivalent plastic logarithmic strain, d(alpha) = sqrt(2/3 dep:dep). So yield_stress is
/// sqrt(2/3) of the yield stress in uniaxial tension and sqrt(2) of that in shear, and hardening_modulus is
/// the slope d(sigma_y)/d(alpha) of the uniaxial yield stress. The return is radial in the principal
/// logarithmic strains of b_trial and closed.
struct VonMises {
  static constexpr std::string_view name = "von-mises";
  static constexpr std::string_view summary =
      "von Mises plasticity on Kirchhoff stress, perfect or linear hardening";
  static constexpr std::string_view source =
      "Simo 1992; de Souza Neto, Peric and Owen 2008, sections 7.3 and 14.5";
  static constexpr bool finite_strain = true;

  double density = 1000.0;
  double young_modulus = 1e6;
  double poisson_ratio = 0.0;
  double yield_stress = 1e4;
  double hardening_modulus = 0.0;

  static constexpr auto keys() {
    return std::tuple{
        key("density", &VonMises::density, "kg/m3", "initial mass density").at_least(0.0).required(),
        key("young_modulus", &VonMises::young_modulus, "Pa", "Young's modulus").at_least(0.0).required(),
        key("poisson_ratio", &VonMises::poisson_ratio, "-", "Poisson's ratio").above(-1.0).below(0.5),
        key("yield_stress", &VonMises::yield_stress, "Pa",
            "rho_y = sqrt(2 J2) of the Kirchhoff stress at first yield: sqrt(2/3) of the uniaxial yield "
            "stress")
            .positive()
            .required(),
        key("hardening_modulus", &VonMises::hardening_modulus, "Pa",
            "slope of the uniaxial yield stress over the equivalent plastic strain")
            .at_least(0.0)};
  }

  template <int dim>
  struct State {
    Sym<dim> stress = Sym<dim>::Zero();        ///< Kirchhoff stress [Pa]
    Sym<dim> elastic_b = sym_identity<dim>();  ///< elastic left Cauchy-Green tensor exp(2 eps_e) [-]
    double plastic_strain = 0.0;               ///< alpha, equivalent plastic logarithmic strain [-]
    double dissipation = 0.0;                  ///< plastic work per initial volume [J/m3]
  };

  constexpr Elasticity elasticity() const { return Elasticity::from(young_modulus, poisson_ratio); }

  /// rho_y [Pa] at an equivalent plastic strain.
  constexpr double yield_radius(double alpha) const {
    return yield_stress + root_two_thirds * hardening_modulus * alpha;
  }

  /// As for Hencky's law. Input error if the stress lies outside the yield surface.
  template <int dim>
  State<dim> initial(const Sym<dim>& cauchy_stress) const {
    const Sym<dim> s = deviator<dim>(cauchy_stress);
    const double radius = std::sqrt(contract<dim>(s, s));
    if (radius > yield_stress * (1.0 + 1e-12))
      input_error("initial stress of '{}': sqrt(2 J2) = {:g} Pa is above yield_stress = {:g} Pa", name,
                  radius, yield_stress);
    return {cauchy_stress, initial_elastic_b<dim>(elasticity(), cauchy_stress, name), 0.0, 0.0};
  }

  template <int dim>
  void stress(const Kinematics<dim>& kinematics, const State<dim>& old, State<dim>& now) const {
    const Elasticity e = elasticity();
    const TrialStrain<dim> trial(kinematics, old.elastic_b);
    const Return r = return_map(e, trial.principal, old.plastic_strain);
    const double alpha = old.plastic_strain + root_two_thirds * r.multiplier;
    // the exact integral of rho_y over the multiplier, which is the plastic work since tau:dep = rho_y
    // d(multiplier)
    now.dissipation =
        old.dissipation + 0.5 * r.multiplier * (yield_radius(old.plastic_strain) + yield_radius(alpha));
    now.plastic_strain = alpha;
    const Vec<3> elastic = trial.principal - r.multiplier * r.normal;
    if (r.multiplier > 0.0) {
      const Vec<3> b(std::exp(2.0 * elastic[0]), std::exp(2.0 * elastic[1]), std::exp(2.0 * elastic[2]));
      now.elastic_b = trial.on_axes(b);
    } else {
      now.elastic_b = trial.b;
    }
    now.stress = trial.on_axes(e.principal_stress(elastic));
  }

  template <int dim>
  void tangent(const Kinematics<dim>& kinematics, const State<dim>& old, const State<dim>& now,
               Tangent<dim>& c) const {
    const Elasticity e = elasticity();
    const TrialStrain<dim> trial(kinematics, old.elastic_b);
    const Return r = return_map(e, trial.principal, old.plastic_strain);
    SymMap<dim> d = e.map<dim>();
    if (r.multiplier > 0.0) {
      // D_ep = K I(x)I + 2 mu theta I_dev - 2 mu theta' n(x)n (Simo and Hughes 1998, box 3.2, on logarithmic
      // strains)
      const double shrink = 2.0 * e.mu * r.multiplier / r.trial_radius;  // 1 - theta
      const double flow = 2.0 * e.mu / (2.0 * e.mu + 2.0 / 3.0 * hardening_modulus) - shrink;
      const Sym<dim> n = trial.on_axes(r.normal);
      d -= (2.0 * e.mu * flow) * n * n.transpose();
      for (int a = 0; a < sym_size<dim>; ++a) d(a, a) -= a < 3 ? 2.0 * e.mu * shrink : e.mu * shrink;
      d.template topLeftCorner<3, 3>().array() += 2.0 / 3.0 * e.mu * shrink;
    }
    spatial_tangent<dim>(d, trial, now.stress, c);
  }

  template <int dim>
  double strain_energy(const State<dim>& state) const {
    return elasticity().energy<dim>(state.stress);
  }
  template <int dim>
  double dissipation(const State<dim>& state) const {
    return state.dissipation;
  }
  template <int dim>
  double plastic_strain(const State<dim>& state) const {
    return state.plastic_strain;
  }
  constexpr double p_wave_modulus() const { return elasticity().p_wave_modulus(); }

 private:
  static constexpr double root_two_thirds = 0.81649658092772603;

  struct Return {
    double multiplier = 0.0;         ///< |plastic strain increment|; zero in an elastic step
    double trial_radius = 0.0;       ///< sqrt(2 J2) of the trial stress [Pa]
    Vec<3> normal = Vec<3>::Zero();  ///< flow direction, unit length
  };

  /// Radial return of principal logarithmic strains.
  Return return_map(const Elasticity& e, const Vec<3>& strain, double alpha) const {
    const double mean = strain.sum() / 3.0;
    const Vec<3> s = 2.0 * e.mu * (strain.array() - mean).matrix();
    Return r;
    r.trial_radius = s.norm();
    const double f = r.trial_radius - yield_radius(alpha);
    if (f > 0.0) {
      r.multiplier = f / (2.0 * e.mu + 2.0 / 3.0 * hardening_modulus);
      r.normal = s / r.trial_radius;
    }
    return r;
  }
};

static_assert(Material<VonMises>);

}  // namespace wisp
