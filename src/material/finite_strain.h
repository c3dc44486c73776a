// The kinematics that every finite-strain law on logarithmic strains shares: b_trial = dF b_e dF^T, eps =
// ln(b)/2, and the step from d(tau)/d(eps) to the spatial tangent (Charlton, Coombs and Augarde 2017; Simo
// 1992).
#pragma once
#include <cmath>
#include <string_view>

#include "core/error.h"
#include "material/elasticity.h"
#include "material/kinematics.h"
#include "tensor/spectral.h"

namespace wisp {

/// Trial elastic left Cauchy-Green tensor of a step and its logarithmic strain in principal values.
template <int dim>
struct TrialStrain {
  Sym<dim> b;          ///< dF b_e dF^T
  Spectrum<dim> base;  ///< spectrum of b
  Vec<3> principal;    ///< principal logarithmic strains ln(b_k)/2 on the axes of `base`

  TrialStrain(const Kinematics<dim>& kinematics, const Sym<dim>& elastic_b)
      : b(congruence<dim>(kinematics.dF, elastic_b)), base(spectrum<dim>(b)) {
    for (int k = 0; k < 3; ++k) principal[k] = 0.5 * std::log(base.values[k]);
  }

  /// The tensor with the given principal values on the trial axes.
  Sym<dim> on_axes(const Vec<3>& values) const { return compose<dim>(values, base.axes); }
};

/// Elastic left Cauchy-Green tensor exp(2 D^-1 sigma) of an initial stress. Input error if there is no
/// stiffness to carry a stress with.
template <int dim>
inline Sym<dim> initial_elastic_b(const Elasticity& elasticity, const Sym<dim>& sigma, std::string_view law) {
  if (elasticity.mu <= 0.0 && sigma.squaredNorm() > 0.0)
    input_error("a body of '{}' without stiffness (young_modulus = 0) cannot carry an initial stress", law);
  return tensor_exp<dim>(2.0 * elasticity.strain<dim>(sigma));
}

/// c = D : (1/2 d ln b/db) : B - tau_il delta_jk, with B_mnkl = delta_mk b_nl + delta_nk b_ml, for
/// `d` = d(tau)/d(eps) as a symmetric map.
template <int dim>
inline void spatial_tangent(const SymMap<dim>& d, const TrialStrain<dim>& trial, const Sym<dim>& tau,
                            Tangent<dim>& c) {
  constexpr int n = sym_size<dim>;
  SymMap<dim> l = log_derivative<dim>(trial.base);
  const Mat<dim> b = matrix<dim>(trial.b);
  // engineering(db) for du_k,l = 1; the halves of ln(b)/2 go into the first factor
  Eigen::Matrix<double, n, dim * dim> db;
  for (int a = 0; a < n; ++a) {
    const int i = sym_i<dim>[a];
    const int j = sym_j<dim>[a];
    const double factor = a < 3 ? 0.5 : 1.0;
    for (int k = 0; k < dim; ++k)
      for (int m = 0; m < dim; ++m) {
        double v = 0.0;
        if (i == k && j < dim) v += b(j % dim, m);
        if (j == k && i < dim) v += b(i % dim, m);
        db(a, k * dim + m) = factor * v;
      }
  }
  Eigen::Matrix<double, n, dim* dim> strain = l * db;
  strain.template bottomRows<n - 3>() *= 2.0;
  const Eigen::Matrix<double, n, dim* dim> stress = d * strain;
  const Mat<dim> t = matrix<dim>(tau);
  constexpr int pair[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      for (int k = 0; k < dim; ++k)
        for (int m = 0; m < dim; ++m)
          c(i * dim + j, k * dim + m) = stress(pair[i][j], k * dim + m) - (j == k ? t(i, m) : 0.0);
}

}  // namespace wisp
