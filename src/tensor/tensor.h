// Small tensors: Eigen fixed-size types under the names that the rest of Wisp uses.
#pragma once
#include <Eigen/Core>
#include <Eigen/LU>  // inverse and determinant

namespace wisp {

/// Vector of `dim` components.
template <int dim>
using Vec = Eigen::Matrix<double, dim, 1>;

/// Second-order tensor, dim x dim, row i column j = T_ij.
template <int dim>
using Mat = Eigen::Matrix<double, dim, dim>;

/// Number of components of a symmetric tensor: plane strain keeps the out-of-plane component.
template <int dim>
inline constexpr int sym_size = dim == 2 ? 4 : 6;

/// Symmetric second-order tensor as tensor components (shear **without** a factor 2), in the one Voigt order
/// of Wisp: 2D plane strain xx, yy, zz, xy; 3D xx, yy, zz, xy, yz, zx.
template <int dim>
using Sym = Eigen::Matrix<double, sym_size<dim>, 1>;

/// Fourth-order map between symmetric tensors in the same order: d(tau_a) = D_ab d(eps_b) where both sides
/// hold tensor components; column b of a shear pair is the derivative with respect to the *engineering* shear
/// 2 eps_xy, so that D is the symmetric matrix of the textbooks and strains enter with their shear doubled
/// (`engineering`).
template <int dim>
using SymMap = Eigen::Matrix<double, sym_size<dim>, sym_size<dim>>;

/// Spatial tangent c_ijkl as a (dim*dim) x (dim*dim) matrix, row i*dim+j, column k*dim+l.
template <int dim>
using Tangent = Eigen::Matrix<double, dim * dim, dim * dim>;

/// The pair (i, j) that component a of `Sym<dim>` stands for.
template <int dim>
inline constexpr int sym_i[6] = {0, 1, 2, 0, 1, 2};
template <int dim>
inline constexpr int sym_j[6] = {0, 1, 2, 1, 2, 0};

/// The component of `Sym<dim>` that stands for the pair (i, j), both below dim.
template <int dim>
constexpr int component(int i, int j) {
  return i == j ? i : dim == 2 ? 3 : i + j == 1 ? 3 : i + j == 3 ? 4 : 5;
}

/// Symmetric part of an in-plane (dim x dim) tensor; the out-of-plane component of plane strain is zero.
template <int dim>
inline Sym<dim> symmetric(const Mat<dim>& a) {
  Sym<dim> s;
  if constexpr (dim == 2) {
    s << a(0, 0), a(1, 1), 0.0, 0.5 * (a(0, 1) + a(1, 0));
  } else {
    s << a(0, 0), a(1, 1), a(2, 2), 0.5 * (a(0, 1) + a(1, 0)), 0.5 * (a(1, 2) + a(2, 1)),
        0.5 * (a(2, 0) + a(0, 2));
  }
  return s;
}

/// The in-plane (dim x dim) matrix of a symmetric tensor.
template <int dim>
inline Mat<dim> matrix(const Sym<dim>& s) {
  Mat<dim> a;
  if constexpr (dim == 2) {
    a << s[0], s[3], s[3], s[1];
  } else {
    a << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  }
  return a;
}

/// Trace, out-of-plane component included.
template <int dim>
inline double trace(const Sym<dim>& s) {
  return s[0] + s[1] + s[2];
}

/// Double contraction s : t.
template <int dim>
inline double contract(const Sym<dim>& s, const Sym<dim>& t) {
  double sum = s[0] * t[0] + s[1] * t[1] + s[2] * t[2];
  for (int a = 3; a < sym_size<dim>; ++a) sum += 2.0 * s[a] * t[a];
  return sum;
}

/// The identity, out-of-plane component included.
template <int dim>
inline Sym<dim> sym_identity() {
  Sym<dim> s = Sym<dim>::Zero();
  s[0] = s[1] = s[2] = 1.0;
  return s;
}

/// Deviator s - tr(s)/3 I; three-dimensional trace in plane strain too.
template <int dim>
inline Sym<dim> deviator(const Sym<dim>& s) {
  Sym<dim> d = s;
  const double mean = trace<dim>(s) / 3.0;
  d[0] -= mean;
  d[1] -= mean;
  d[2] -= mean;
  return d;
}

/// The same tensor with its shear components doubled: what a `SymMap` is applied to, D * engineering(eps).
template <int dim>
inline Sym<dim> engineering(const Sym<dim>& s) {
  Sym<dim> e = s;
  for (int a = 3; a < sym_size<dim>; ++a) e[a] *= 2.0;
  return e;
}

/// a s a^T; in plane strain `a` acts in the plane and the out-of-plane component stays as it is.
template <int dim>
inline Sym<dim> congruence(const Mat<dim>& a, const Sym<dim>& s) {
  const Mat<dim> r = a * matrix<dim>(s) * a.transpose();
  Sym<dim> t = symmetric<dim>(r);
  if constexpr (dim == 2) t[2] = s[2];
  return t;
}

}  // namespace wisp
