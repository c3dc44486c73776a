// Spectra of symmetric tensors and the isotropic tensor functions built on them: fixed size, no allocation,
// and no tolerance that decides when two eigenvalues count as equal, so that tangents are smooth to rounding.
#pragma once
#include <algorithm>
#include <cmath>

#include "tensor/tensor.h"

namespace wisp {

/// Eigenvalues and axes of a symmetric tensor, not sorted. `values` holds three numbers in plane strain too,
/// the third one out of plane; column k of `axes` (dim x dim, orthonormal) belongs to `values[k]`.
template <int dim>
struct Spectrum {
  Vec<3> values;
  Mat<dim> axes;
};

/// (ln a - ln b) / (a - b) for a, b > 0, its limit 1/a where a = b. Accurate to rounding for any distance: a
/// - b is exact where a and b are close, and so is log1p of the small ratio.
inline double log_divided_difference(double a, double b) {
  const double least = std::min(a, b);
  const double gap = std::max(a, b) - least;
  return gap > 0.0 ? std::log1p(gap / least) / gap : 1.0 / a;
}

namespace detail {

/// One Jacobi rotation that annihilates a(p, q), p < q, r the third index; `axes` collects the rotations.
/// Squares of a(p, q) up to `negligible` are left alone.
inline void jacobi_rotate(Mat<3>& a, Mat<3>& axes, int p, int q, int r, double negligible) {
  const double apq = a(p, q);
  if (apq * apq <= negligible) return;
  const double difference = a(q, q) - a(p, p);
  // tan of the smaller angle, finite because apq is not negligible
  const double t =
      2.0 * apq /
      (difference + std::copysign(std::sqrt(difference * difference + 4.0 * apq * apq), difference));
  const double c = 1.0 / std::sqrt(1.0 + t * t);
  const double s = t * c;
  a(p, p) -= t * apq;
  a(q, q) += t * apq;
  a(p, q) = a(q, p) = 0.0;
  const double arp = a(r, p);
  const double arq = a(r, q);
  a(r, p) = a(p, r) = c * arp - s * arq;
  a(r, q) = a(q, r) = s * arp + c * arq;
  for (int i = 0; i < 3; ++i) {
    const double vip = axes(i, p);
    const double viq = axes(i, q);
    axes(i, p) = c * vip - s * viq;
    axes(i, q) = s * vip + c * viq;
  }
}

}  // namespace detail

/// Spectrum of a symmetric tensor. 2D: closed form. 3D: cyclic Jacobi, whose axes stay orthonormal to
/// rounding for equal and nearly equal eigenvalues, where closed forms lose half the digits (Golub and Van
/// Loan 2013, section 8.5).
template <int dim>
inline Spectrum<dim> spectrum(const Sym<dim>& s) {
  Spectrum<dim> result;
  if constexpr (dim == 2) {
    const double mean = 0.5 * (s[0] + s[1]);
    const double half = 0.5 * (s[0] - s[1]);
    // the larger of both scales the root, or b_xy = 1e-160 beside half = 0 would underflow
    const double scale = std::max(std::abs(half), std::abs(s[3]));
    double radius = 0.0;
    double c = 1.0;
    double n = 0.0;
    if (scale > 0.0) {
      const double root = std::sqrt(half / scale * (half / scale) + s[3] / scale * (s[3] / scale));
      radius = scale * root;
      const double cos2 = half / scale / root;
      const double sin2 = s[3] / scale / root;
      if (cos2 >= 0.0) {  // the half angle, from the larger of cosine and sine
        c = std::sqrt(0.5 * (1.0 + cos2));
        n = 0.5 * sin2 / c;
      } else {
        n = std::sqrt(0.5 * (1.0 - cos2));
        c = 0.5 * sin2 / n;
      }
    }
    result.values << mean + radius, mean - radius, s[2];
    result.axes << c, -n, n, c;
  } else {
    Mat<3> a = matrix<3>(s);
    result.axes.setIdentity();
    const double enough = 1e-33 * a.squaredNorm();  // what is left off the diagonal is below rounding
    for (int sweep = 0; sweep < 12; ++sweep) {
      const double rest = a(0, 1) * a(0, 1) + a(1, 2) * a(1, 2) + a(0, 2) * a(0, 2);
      if (!(rest > enough)) break;  // also ends on NaN
      detail::jacobi_rotate(a, result.axes, 0, 1, 2, 0.25 * enough);
      detail::jacobi_rotate(a, result.axes, 0, 2, 1, 0.25 * enough);
      detail::jacobi_rotate(a, result.axes, 1, 2, 0, 0.25 * enough);
    }
    result.values = a.diagonal();
  }
  return result;
}

/// The symmetric tensor with the given principal values on given axes: sum of values[k] n_k n_k^T.
template <int dim>
inline Sym<dim> compose(const Vec<3>& values, const Mat<dim>& axes) {
  Sym<dim> s;
  if constexpr (dim == 2) {
    const double c = axes(0, 0);
    const double n = axes(1, 0);
    s << values[0] * c * c + values[1] * n * n, values[0] * n * n + values[1] * c * c, values[2],
        (values[0] - values[1]) * c * n;
  } else {
    const Mat<3> scaled = axes * values.asDiagonal();
    for (int a = 0; a < 6; ++a) s[a] = scaled.row(sym_i<3>[a]).dot(axes.row(sym_j<3>[a]));
  }
  return s;
}

/// ln s of a positive definite tensor.
template <int dim>
inline Sym<dim> tensor_log(const Sym<dim>& s) {
  const Spectrum<dim> e = spectrum<dim>(s);
  return compose<dim>(Vec<3>(std::log(e.values[0]), std::log(e.values[1]), std::log(e.values[2])), e.axes);
}

/// exp s.
template <int dim>
inline Sym<dim> tensor_exp(const Sym<dim>& s) {
  const Spectrum<dim> e = spectrum<dim>(s);
  return compose<dim>(Vec<3>(std::exp(e.values[0]), std::exp(e.values[1]), std::exp(e.values[2])), e.axes);
}

/// Square root of a positive semi-definite tensor.
template <int dim>
inline Sym<dim> tensor_sqrt(const Sym<dim>& s) {
  const Spectrum<dim> e = spectrum<dim>(s);
  const auto root = [](double v) { return std::sqrt(std::max(v, 0.0)); };  // rounding may leave -1e-17
  return compose<dim>(Vec<3>(root(e.values[0]), root(e.values[1]), root(e.values[2])), e.axes);
}

/// d(ln s)/ds of a positive definite tensor with the spectrum `e`, as a symmetric map: d(ln s) = L
/// engineering(ds). On the axes it is 1/s_i on the diagonal and the divided difference of the logarithm for
/// each pair (Ogden 1997).
template <int dim>
inline SymMap<dim> log_derivative(const Spectrum<dim>& e) {
  SymMap<dim> map = SymMap<dim>::Zero();
  for (int k = 0; k < dim; ++k) {
    const Vec<dim> n = e.axes.col(k);
    Sym<dim> m = Sym<dim>::Zero();
    for (int a = 0; a < sym_size<dim>; ++a)
      if (dim == 3 || a != 2) m[a] = n[sym_i<dim>[a] % dim] * n[sym_j<dim>[a] % dim];
    map += (1.0 / e.values[k]) * m * m.transpose();
    for (int l = 0; l < k; ++l) {
      const Vec<dim> o = e.axes.col(l);
      Sym<dim> pair = Sym<dim>::Zero();
      for (int a = 0; a < sym_size<dim>; ++a) {
        const int i = sym_i<dim>[a] % dim;
        const int j = sym_j<dim>[a] % dim;
        if (dim == 3 || a != 2) pair[a] = n[i] * o[j] + n[j] * o[i];
      }
      map += (0.5 * log_divided_difference(e.values[k], e.values[l])) * pair * pair.transpose();
    }
  }
  if constexpr (dim == 2) map(2, 2) = 1.0 / e.values[2];
  return map;
}

/// Right stretch U = sqrt(F^T F) of a deformation gradient, dim x dim.
template <int dim>
inline Mat<dim> right_stretch(const Mat<dim>& f) {
  const Mat<dim> c = f.transpose() * f;
  if constexpr (dim == 2) {  // Cayley-Hamilton
    const double det = std::abs(f.determinant());
    const double tr = std::sqrt(c.trace() + 2.0 * det);
    Mat<2> u = c;
    u(0, 0) += det;
    u(1, 1) += det;
    return tr > 0.0 ? Mat<2>(u / tr) : Mat<2>(Mat<2>::Zero());
  } else {
    return matrix<3>(tensor_sqrt<3>(symmetric<3>(c)));
  }
}

}  // namespace wisp
