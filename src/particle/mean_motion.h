// The rigid motion that weighted points have in the mean: what is left when everything but their momentum and
// angular momentum is taken away.
#pragma once
#include <Eigen/Eigenvalues>

#include "tensor/tensor.h"

namespace wisp {

/// v(r) = v_c + W (r - c), with W antisymmetric (1/s).
template <int dim>
struct MeanMotion {
  Vec<dim> centre = Vec<dim>::Zero();  ///< m
  Vec<dim> mean = Vec<dim>::Zero();    ///< m/s, at the centre
  Mat<dim> spin = Mat<dim>::Zero();    ///< 1/s

  Vec<dim> velocity(const Vec<dim>& r) const { return mean + spin * (r - centre); }
};

/// Sums over points from which their mean rigid motion follows; they may be added over ranks. `count`
/// numbers: mass (kg), momentum (N s), first moments (kg m), sum m v r^T and sum m r r^T, all about one
/// origin.
template <int dim>
struct MotionSums {
  static constexpr std::size_t count = 1 + 2 * dim + 2 * dim * dim;

  static void add(double mass, const Vec<dim>& r, const Vec<dim>& v, double* sums) {
    add_mass(mass, r, sums);
    add_momentum(mass * v, r, sums);
  }
  static void add_mass(double mass, const Vec<dim>& r, double* sums) {
    sums[0] += mass;
    Eigen::Map<Vec<dim>>(sums + 1 + dim) += mass * r;
    Eigen::Map<Mat<dim>>(sums + 1 + 2 * dim + dim * dim) += mass * r * r.transpose();
  }
  static void add_momentum(const Vec<dim>& momentum, const Vec<dim>& r, double* sums) {
    Eigen::Map<Vec<dim>>(sums + 1) += momentum;
    Eigen::Map<Mat<dim>>(sums + 1 + 2 * dim) += momentum * r.transpose();
  }

  /// The motion with the momentum and angular momentum of the points. Without mass all is zero; points in one
  /// place, or in 3D on one line, do not turn (about it).
  static MeanMotion<dim> motion(const double* sums) {
    MeanMotion<dim> result;
    const double mass = sums[0];
    if (!(mass > 0.0)) return result;
    result.mean = Eigen::Map<const Vec<dim>>(sums + 1) / mass;
    result.centre = Eigen::Map<const Vec<dim>>(sums + 1 + dim) / mass;
    const Mat<dim> mixed =
        Eigen::Map<const Mat<dim>>(sums + 1 + 2 * dim) - mass * result.mean * result.centre.transpose();
    const Mat<dim> second = Eigen::Map<const Mat<dim>>(sums + 1 + 2 * dim + dim * dim) -
                            mass * result.centre * result.centre.transpose();
    // W S + S W = A - A^T with A = sum m v r^T, S = sum m r r^T: in the axes of S, W_ab = (A_ab - A_ba)/(s_a
    // + s_b).
    Eigen::SelfAdjointEigenSolver<Mat<dim>> axes;
    axes.computeDirect(second);
    const Mat<dim>& q = axes.eigenvectors();
    const Mat<dim> turned = q.transpose() * mixed * q;
    const double least = 1e-10 * axes.eigenvalues().cwiseAbs().maxCoeff();
    Mat<dim> spin = Mat<dim>::Zero();
    for (int a = 0; a < dim; ++a)
      for (int b = a + 1; b < dim; ++b) {
        const double s = axes.eigenvalues()[a] + axes.eigenvalues()[b];
        if (s <= least) continue;
        spin(a, b) = (turned(a, b) - turned(b, a)) / s;
        spin(b, a) = -spin(a, b);
      }
    result.spin = q * spin * q.transpose();
    return result;
  }
};

}  // namespace wisp
