// Isotropic elasticity, shared by the laws: Lame's constants and what follows from them.
#pragma once
#include "tensor/tensor.h"

namespace wisp {

/// Lame's constants [Pa]. Zero stiffness is allowed everywhere.
struct Elasticity {
  double lambda = 0.0;
  double mu = 0.0;

  /// From Young's modulus [Pa] and Poisson's ratio in (-1, 0.5).
  static constexpr Elasticity from(double young_modulus, double poisson_ratio) {
    return {young_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio)),
            0.5 * young_modulus / (1.0 + poisson_ratio)};
  }

  constexpr double bulk() const { return lambda + 2.0 / 3.0 * mu; }
  constexpr double p_wave_modulus() const { return lambda + 2.0 * mu; }

  /// Stress of a strain, tensor components.
  template <int dim>
  Sym<dim> stress(const Sym<dim>& strain) const {
    Sym<dim> s = (2.0 * mu) * strain;
    const double pressure = lambda * trace<dim>(strain);
    s[0] += pressure;
    s[1] += pressure;
    s[2] += pressure;
    return s;
  }

  /// Principal stresses of principal strains.
  Vec<3> principal_stress(const Vec<3>& strain) const {
    const double pressure = lambda * strain.sum();
    return {pressure + 2.0 * mu * strain[0], pressure + 2.0 * mu * strain[1],
            pressure + 2.0 * mu * strain[2]};
  }

  /// Strain of a stress; zero if there is no stiffness.
  template <int dim>
  Sym<dim> strain(const Sym<dim>& stress) const {
    if (mu <= 0.0) return Sym<dim>::Zero();
    Sym<dim> e = deviator<dim>(stress) / (2.0 * mu);
    const double mean = trace<dim>(stress) / (9.0 * bulk());
    e[0] += mean;
    e[1] += mean;
    e[2] += mean;
    return e;
  }

  /// Energy stored by a stress [J/m3]; zero if there is no stiffness.
  template <int dim>
  double energy(const Sym<dim>& stress) const {
    if (mu <= 0.0) return 0.0;
    const Sym<dim> s = deviator<dim>(stress);
    const double tr = trace<dim>(stress);
    return contract<dim>(s, s) / (4.0 * mu) + tr * tr / (18.0 * bulk());
  }

  /// D with d(stress) = D engineering(d strain).
  template <int dim>
  SymMap<dim> map() const {
    SymMap<dim> d = SymMap<dim>::Zero();
    d.template topLeftCorner<3, 3>().setConstant(lambda);
    for (int a = 0; a < sym_size<dim>; ++a) d(a, a) += a < 3 ? 2.0 * mu : mu;
    return d;
  }
};

/// The spatial tangent of a symmetric map: c_ijkl = D_(ij)(kl), no geometric term.
template <int dim>
inline void expand(const SymMap<dim>& d, Tangent<dim>& c) {
  constexpr int pair[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};  // component of Sym for (i, j)
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l) c(i * dim + j, k * dim + l) = d(pair[i][j], pair[k][l]);
}

}  // namespace wisp
