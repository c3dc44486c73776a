// Hypoelasticity: a linear law between the Jaumann rate of stress and the rate of strain.
#pragma once
#include <tuple>

#include "material/elasticity.h"
#include "material/kinematics.h"

namespace wisp {

/// One explicit step of d(sigma) = D:de - tr(de) sigma + dw sigma - sigma dw and dV = tr(de) V, with de and
/// dw the symmetric and the skew part of dt grad v: the law, the spin and the volume of the thesis behind de
/// Koster et al. 2021 (its equation numbers below). Points carry tau = (V/V0) sigma, so that V0 tau is that
/// method's V sigma. The law is neither exactly objective nor exactly conservative in finite steps (both hold
/// to first order in the step), so it wants small ones; a closed cycle of large strain leaves stress behind.
/// Hencky's law has neither defect.
struct JaumannElastic {
  static constexpr std::string_view name = "jaumann-elastic";
  static constexpr std::string_view summary = "isotropic hypoelasticity with the Jaumann rate, small steps";
  static constexpr std::string_view source = "de Koster et al. 2021; thesis, eq. 2.4, 2.40-2.45";
  static constexpr bool finite_strain = true;
  /// What holds for finite steps in the other laws holds for small ones here.
  static constexpr bool rate_form = true;

  double density = 1000.0;
  double young_modulus = 1e6;
  double poisson_ratio = 0.0;

  static constexpr auto keys() {
    using L = JaumannElastic;
    return std::tuple{
        key("density", &L::density, "kg/m3", "initial mass density").at_least(0.0).required(),
        key("young_modulus", &L::young_modulus, "Pa", "Young's modulus").at_least(0.0).required(),
        key("poisson_ratio", &L::poisson_ratio, "-", "Poisson's ratio").above(-1.0).below(0.5)};
  }

  template <int dim>
  struct State {
    Sym<dim> stress = Sym<dim>::Zero();  ///< Kirchhoff stress, volume_ratio times the Cauchy stress [Pa]
    double volume_ratio = 1.0;           ///< V/V0 by the sum of volumetric strain increments [-]
  };

  constexpr Elasticity elasticity() const { return Elasticity::from(young_modulus, poisson_ratio); }

  template <int dim>
  State<dim> initial(const Sym<dim>& cauchy_stress) const {
    return {cauchy_stress, 1.0};
  }

  template <int dim>
  void stress(const Kinematics<dim>& kinematics, const State<dim>& old, State<dim>& now) const {
    const Increment<dim> in(kinematics.dF);
    const double ratio = old.volume_ratio * (1.0 + in.volume);
    now.stress = ratio * cauchy<dim>(elasticity(), in, old);
    now.volume_ratio = ratio;
  }

  template <int dim>
  void tangent(const Kinematics<dim>& kinematics, const State<dim>& old, const State<dim>& now,
               Tangent<dim>& c) const {
    const Elasticity e = elasticity();
    const Increment<dim> in(kinematics.dF);
    const Sym<dim> sigma = cauchy<dim>(e, in, old);
    const Sym<dim> sigma_old = old.stress / old.volume_ratio;
    const Mat<dim> s = matrix<dim>(sigma_old), tau = matrix<dim>(now.stress);
    for (int k = 0; k < dim; ++k)
      for (int l = 0; l < dim; ++l) {
        // dF changes by e_k (row l of dF) for du_k,l = 1 in the current configuration.
        Mat<dim> change = Mat<dim>::Zero();
        change.row(k) = kinematics.dF.row(l);
        const Mat<dim> spin = 0.5 * (change - change.transpose());
        const double volume = change.trace();
        const Sym<dim> rate = e.stress<dim>(symmetric<dim>(change)) - volume * sigma_old +
                              symmetric<dim>(Mat<dim>(spin * s - s * spin));
        const Mat<dim> d =
            matrix<dim>(Sym<dim>(old.volume_ratio * (volume * sigma + (1.0 + in.volume) * rate)));
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j) c(i * dim + j, k * dim + l) = d(i, j) - (j == k ? tau(i, l) : 0.0);
      }
  }

  /// Of the present stress by linear elasticity: what the stress could give back in a small unloading.
  template <int dim>
  double strain_energy(const State<dim>& state) const {
    return elasticity().energy<dim>(state.stress) / state.volume_ratio;
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
  template <int dim>
  struct Increment {
    Sym<dim> strain;  ///< de, eq. 2.40
    Mat<dim> spin;    ///< dw, eq. 2.42
    double volume;    ///< tr(de)

    explicit Increment(const Mat<dim>& dF)
        : strain(symmetric<dim>(Mat<dim>(dF - Mat<dim>::Identity()))),
          spin(0.5 * (dF - dF.transpose())),
          volume(trace<dim>(strain)) {}
  };

  /// Eq. 2.41 and 2.43.
  template <int dim>
  static Sym<dim> cauchy(const Elasticity& e, const Increment<dim>& in, const State<dim>& old) {
    const Sym<dim> sigma = old.stress / old.volume_ratio;
    const Mat<dim> s = matrix<dim>(sigma);
    return (1.0 - in.volume) * sigma + e.stress<dim>(in.strain) +
           symmetric<dim>(Mat<dim>(in.spin * s - s * in.spin));
  }
};

static_assert(Material<JaumannElastic>);

}  // namespace wisp
