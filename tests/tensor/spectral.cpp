#include "tensor/spectral.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace wisp {
namespace {

/// Nodes and weights of Gauss-Legendre quadrature on [0, 1].
struct Gauss {
  std::vector<double> x, w;
  explicit Gauss(int n) {
    for (int i = 0; i < n; ++i) {
      double z = std::cos(M_PI * (i + 0.75) / (n + 0.5));
      double slope = 1.0;
      for (int it = 0; it < 50; ++it) {
        double p = 1.0;
        double q = 0.0;
        for (int k = 1; k <= n; ++k) {
          const double r = q;
          q = p;
          p = ((2.0 * k - 1.0) * z * q - (k - 1.0) * r) / k;
        }
        slope = n * (z * p - q) / (z * z - 1.0);
        z -= p / slope;
      }
      x.push_back(0.5 * (1.0 - z));
      w.push_back(1.0 / ((1.0 - z * z) * slope * slope));
    }
  }
};

/// Block form with the out-of-plane component, 3x3, so that both dimensions meet the same references.
template <int dim>
Mat<3> full(const Sym<dim>& s) {
  Mat<3> a = Mat<3>::Zero();
  a.template topLeftCorner<dim, dim>() = matrix<dim>(s);
  if constexpr (dim == 2) a(2, 2) = s[2];
  return a;
}
template <int dim>
Sym<dim> folded(const Mat<3>& a) {
  if constexpr (dim == 3) return symmetric<3>(a);
  Sym<dim> s;
  for (int c = 0; c < sym_size<dim>; ++c)
    s[c] = 0.5 * (a(sym_i<dim>[c], sym_j<dim>[c]) + a(sym_j<dim>[c], sym_i<dim>[c]));
  return s;
}

/// ln b = int_0^1 (b - I) (t (b - I) + I)^-1 dt, and its derivative, need no eigenvalues at all.
template <int dim>
Sym<dim> log_by_quadrature(const Sym<dim>& b) {
  static const Gauss gauss(40);
  const Mat<3> d = full<dim>(b) - Mat<3>::Identity();
  Mat<3> sum = Mat<3>::Zero();
  for (std::size_t q = 0; q < gauss.x.size(); ++q)
    sum += gauss.w[q] * d * (gauss.x[q] * d + Mat<3>::Identity()).inverse();
  return folded<dim>(sum);
}
template <int dim>
Sym<dim> log_derivative_by_quadrature(const Sym<dim>& b, const Sym<dim>& db) {
  static const Gauss gauss(40);
  const Mat<3> d = full<dim>(b) - Mat<3>::Identity();
  Mat<3> sum = Mat<3>::Zero();
  for (std::size_t q = 0; q < gauss.x.size(); ++q) {
    const Mat<3> inverse = (gauss.x[q] * d + Mat<3>::Identity()).inverse();
    sum += gauss.w[q] * inverse * full<dim>(db) * inverse;
  }
  return folded<dim>(sum);
}

std::mt19937& rng() {
  static std::mt19937 generator(12345);
  return generator;
}
template <int dim>
Sym<dim> random_sym(double amplitude) {
  std::uniform_real_distribution<double> u(-amplitude, amplitude);
  Sym<dim> s;
  for (int a = 0; a < sym_size<dim>; ++a) s[a] = u(rng());
  return s;
}
template <int dim>
Mat<dim> random_matrix(double amplitude) {
  std::uniform_real_distribution<double> u(-amplitude, amplitude);
  Mat<dim> m;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) m(i, j) = u(rng());
  return m;
}

/// Positive tensors: general ones, multiples of the identity, and both disturbed by every size down to
/// rounding.
template <int dim>
std::vector<Sym<dim>> positive_tensors() {
  std::vector<Sym<dim>> list;
  for (double scale : {0.6, 1.0, 1.7}) {
    list.push_back(scale * sym_identity<dim>());
    for (double size : {1e-160, 1e-17, 1e-16, 1e-15, 1e-13, 1e-11, 1e-9, 1e-8, 1e-7, 1e-5, 1e-3, 0.1}) {
      for (int i = 0; i < 5; ++i) list.push_back(scale * sym_identity<dim>() + random_sym<dim>(size));
      Sym<dim> shear = scale * sym_identity<dim>();
      shear[3] = size;  // equal diagonal, one pair of eigenvalues split by 2 size
      list.push_back(shear);
      Sym<dim> two = scale * sym_identity<dim>();
      two[2] += 0.3;  // two eigenvalues nearly equal, the third far off
      list.push_back(congruence<dim>(Mat<dim>(Mat<dim>::Identity() + random_matrix<dim>(size)), two));
    }
  }
  for (int i = 0; i < 200; ++i)
    list.push_back(
        congruence<dim>(Mat<dim>(Mat<dim>::Identity() + random_matrix<dim>(0.25)), sym_identity<dim>()));
  return list;
}

template <class T>
class Spectral : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Spectral, Dimensions);

TYPED_TEST(Spectral, SpectrumRebuildsTheTensorOnOrthonormalAxes) {
  constexpr int dim = TypeParam::value;
  for (const Sym<dim>& b : positive_tensors<dim>()) {
    const Spectrum<dim> e = spectrum<dim>(b);
    EXPECT_LT((e.axes.transpose() * e.axes - Mat<dim>::Identity()).norm(), 2e-15);
    EXPECT_LT((compose<dim>(e.values, e.axes) - b).norm(), 4e-15) << b.transpose();
  }
}

TYPED_TEST(Spectral, LogarithmAgreesWithQuadrature) {
  constexpr int dim = TypeParam::value;
  for (const Sym<dim>& b : positive_tensors<dim>())
    EXPECT_LT((tensor_log<dim>(b) - log_by_quadrature<dim>(b)).norm(), 2e-14) << b.transpose();
}

TYPED_TEST(Spectral, LogarithmDerivativeAgreesWithQuadratureForAnyDistanceOfEigenvalues) {
  constexpr int dim = TypeParam::value;
  for (const Sym<dim>& b : positive_tensors<dim>()) {
    const SymMap<dim> map = log_derivative<dim>(spectrum<dim>(b));
    EXPECT_LT((map - map.transpose()).norm(), 1e-14);
    for (int i = 0; i < 3; ++i) {
      const Sym<dim> db = random_sym<dim>(1.0);
      const Sym<dim> ours = map * engineering<dim>(db);
      EXPECT_LT((ours - log_derivative_by_quadrature<dim>(b, db)).norm(), 5e-14 * map.norm())
          << b.transpose();
    }
  }
}

TYPED_TEST(Spectral, ExponentialInvertsLogarithm) {
  constexpr int dim = TypeParam::value;
  for (int i = 0; i < 300; ++i) {
    const Sym<dim> e = random_sym<dim>(i % 3 == 0 ? 1.5 : 1e-4);
    EXPECT_LT((tensor_log<dim>(tensor_exp<dim>(e)) - e).norm(), 2e-13);
  }
  EXPECT_EQ(tensor_exp<dim>(Sym<dim>::Zero()), sym_identity<dim>());
  EXPECT_EQ(tensor_log<dim>(sym_identity<dim>()), Sym<dim>::Zero());
}

TYPED_TEST(Spectral, SquareRootSquares) {
  constexpr int dim = TypeParam::value;
  for (const Sym<dim>& b : positive_tensors<dim>()) {
    const Mat<3> root = full<dim>(tensor_sqrt<dim>(b));
    EXPECT_LT((root * root - full<dim>(b)).norm(), 1e-14);
  }
  EXPECT_EQ(tensor_sqrt<dim>(Sym<dim>::Zero()), Sym<dim>::Zero());
}

TYPED_TEST(Spectral, RightStretchIsTheSymmetricFactorOfThePolarDecomposition) {
  constexpr int dim = TypeParam::value;
  for (int i = 0; i < 300; ++i) {
    const Mat<dim> f = Mat<dim>::Identity() + random_matrix<dim>(i % 2 == 0 ? 0.4 : 1e-9);
    const Mat<dim> u = right_stretch<dim>(f);
    EXPECT_LT((u - u.transpose()).norm(), 1e-15);
    const Mat<dim> r = f * u.inverse();
    EXPECT_LT((r.transpose() * r - Mat<dim>::Identity()).norm(), 1e-12);
    EXPECT_GT(u.determinant(), 0.0);
    EXPECT_NEAR(u.determinant(), std::abs(f.determinant()), 1e-13);
  }
  Mat<dim> turn = Mat<dim>::Identity();
  turn.template topLeftCorner<2, 2>() << std::cos(0.7), -std::sin(0.7), std::sin(0.7), std::cos(0.7);
  Mat<dim> stretch = Mat<dim>::Identity();
  stretch(0, 0) = 1.8;
  stretch(1, 1) = 0.4;
  EXPECT_LT((right_stretch<dim>(turn * stretch) - stretch).norm(), 1e-14);
}

TYPED_TEST(Spectral, NotANumberEndsAndIsPassedOn) {
  constexpr int dim = TypeParam::value;
  Sym<dim> b = sym_identity<dim>();
  b[0] = std::nan("");
  EXPECT_TRUE(std::isnan(tensor_log<dim>(b).sum()));
}

TEST(LogDividedDifference, AgreesWithExtendedPrecision) {
  for (double a : {0.01, 0.9, 1.0, 3.0}) {
    for (int k = -60; k < 8; ++k) {
      const double b = a + a * std::ldexp(1.0, k);
      const long double gap = static_cast<long double>(b) - a;
      const long double exact = gap > 0 ? std::log1p(gap / a) / gap : 1.0L / a;
      EXPECT_NEAR(log_divided_difference(a, b), static_cast<double>(exact),
                  4e-16 * static_cast<double>(exact));
      EXPECT_EQ(log_divided_difference(a, b), log_divided_difference(b, a));
    }
  }
  EXPECT_DOUBLE_EQ(log_divided_difference(4.0, 4.0), 0.25);
  EXPECT_DOUBLE_EQ(log_divided_difference(1.0, std::exp(1.0)), 1.0 / (std::exp(1.0) - 1.0));
}

}  // namespace
}  // namespace wisp
