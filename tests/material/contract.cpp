// What every law of the list promises, in two and three dimensions. A new law is tested here by being in the
// list.
#include "material/samples.h"

namespace wisp::test {
namespace {

template <class P>
class Contract : public ::testing::Test {
 public:
  using Law = typename P::law_type;
  static constexpr int dim = P::dim;
  using State = typename Law::template State<dim>;

  /// Motion varied by `size` in the direction `g`: a gradient in the current configuration for finite strain,
  /// on the start-of-step configuration otherwise.
  static Kinematics<dim> varied(const Kinematics<dim>& k, const Mat<dim>& g, double size) {
    if constexpr (Law::finite_strain) return {(Mat<dim>::Identity() + size * g) * k.dF, k.dt};
    return {k.dF + size * g, k.dt};
  }

  /// tau_ij pulled back so that only it and the gradients N_,j of the current configuration vary.
  static Mat<dim> force(const Law& law, const Kinematics<dim>& k, const State& old,
                        const Kinematics<dim>& base) {
    const Mat<dim> tau = matrix<dim>(after<dim>(law, k, old).stress);
    if constexpr (Law::finite_strain) return tau * k.dF.inverse().transpose() * base.dF.transpose();
    return tau;
  }

  /// Largest difference between c : g and fourth-order central differences, relative to the stiffness.
  static double tangent_error(const Law& law, const Kinematics<dim>& k, const State& old, Random& random) {
    const State now = after<dim>(law, k, old);
    Tangent<dim> c;
    law.template tangent<dim>(k, old, now, c);
    double error = 0.0;
    for (int trial = 0; trial < 3; ++trial) {
      const Mat<dim> g = random.matrix<dim>(1.0);
      const auto at = [&](double size) { return force(law, varied(k, g, size), old, k); };
      const double h = 2e-4;
      const Mat<dim> numeric = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
      Mat<dim> ours = Mat<dim>::Zero();
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          for (int m = 0; m < dim; ++m)
            for (int l = 0; l < dim; ++l) ours(i, j) += c(i * dim + j, m * dim + l) * g(m, l);
      error = std::max(error, (ours - numeric).norm() / law.p_wave_modulus());
    }
    return error;
  }

  /// A state reached from rest through steps of the given amplitude.
  static State walked(const Law& law, Random& random, double amplitude, int steps) {
    State state = law.template initial<dim>(Sym<dim>::Zero());
    for (int s = 0; s < steps; ++s) law.template stress<dim>(random.motion<dim>(amplitude), state, state);
    return state;
  }
};
TYPED_TEST_SUITE(Contract, AllPairs);

TYPED_TEST(Contract, TangentIsTheDerivativeOfTheForceInLargeSteps) {
  using C = Contract<TypeParam>;
  const auto law = sample_law<typename C::Law>();
  Random random(7);
  for (double before : {0.0, 0.003, 0.1})
    for (int i = 0; i < 40; ++i) {
      const auto old = C::walked(law, random, before, 2);
      EXPECT_LT(C::tangent_error(law, random.motion<C::dim>(0.2), old, random), 1e-9) << "before " << before;
    }
}

TYPED_TEST(Contract, TangentIsTheDerivativeOfTheForceBesideEqualEigenvalues) {
  using C = Contract<TypeParam>;
  const auto law = sample_law<typename C::Law>();
  Random random(8);
  Mat<C::dim> pair = Mat<C::dim>::Identity();  // two equal stretches, the third one different
  pair(0, 0) = pair(1, 1) = 1.1;
  for (double size : {0.0, 1e-160, 1e-17, 1e-15, 1e-12, 1e-10, 1e-8, 1e-7, 1e-5, 1e-3})
    for (int i = 0; i < 5; ++i) {
      const auto rest = law.template initial<C::dim>(Sym<C::dim>::Zero());
      Kinematics<C::dim> k = random.motion<C::dim>(size);
      EXPECT_LT(C::tangent_error(law, k, rest, random), 1e-9) << "all equal, disturbed by " << size;
      k.dF = k.dF * pair;
      EXPECT_LT(C::tangent_error(law, k, rest, random), 1e-9) << "two equal, disturbed by " << size;
    }
}

TYPED_TEST(Contract, StressFollowsASuperposedRotation) {
  using C = Contract<TypeParam>;
  const auto law = sample_law<typename C::Law>();
  Random random(9);
  if constexpr (!C::Law::finite_strain) {  // these only promise not to see a small rotation
    for (int i = 0; i < 50; ++i) {
      const auto k = random.motion<C::dim>(0.01);
      const Mat<C::dim> spin = random.matrix<C::dim>(0.01);
      const auto plain = after<C::dim>(law, k, {});
      const auto turned = after<C::dim>(law, {k.dF + spin - spin.transpose(), k.dt}, {});
      EXPECT_LT((turned.stress - plain.stress).norm(), 1e-14 * law.p_wave_modulus());
    }
    return;
  }
  if constexpr (in_small_steps<typename C::Law>) {
    // A turn of a radian in n steps under initial stress: the error falls as 1/n.
    Sym<C::dim> sigma = -7.0 * sym_identity<C::dim>();
    sigma[1] = -12.0, sigma[3] = 2.0;
    double before = 0.0;
    for (int n : {500, 1000}) {
      Mat<C::dim> step = Mat<C::dim>::Identity(), whole = step;
      const auto turn = [](Mat<C::dim>& m, double angle) {
        m(0, 0) = m(1, 1) = std::cos(angle), m(1, 0) = std::sin(angle), m(0, 1) = -m(1, 0);
      };
      turn(step, 1.0 / n), turn(whole, 1.0);
      auto state = law.template initial<C::dim>(sigma);
      for (int i = 0; i < n; ++i) law.template stress<C::dim>({step, 0.01}, state, state);
      const double error = (state.stress - congruence<C::dim>(whole, sigma)).norm();
      if (n == 500)
        before = error;
      else
        EXPECT_NEAR(before / error, 2.0, 0.02);
    }
    return;
  }
  for (int i = 0; i < 50; ++i) {
    auto plain = law.template initial<C::dim>(Sym<C::dim>::Zero());
    auto turned = plain;
    Mat<C::dim> before = Mat<C::dim>::Identity();
    for (int step = 0; step < 4; ++step) {
      const auto k = random.motion<C::dim>(0.15);
      const Mat<C::dim> q = random.rotation<C::dim>();
      law.template stress<C::dim>(k, plain, plain);
      law.template stress<C::dim>({q * k.dF * before.transpose(), k.dt}, turned, turned);
      before = q;
    }
    const Sym<C::dim> expected = congruence<C::dim>(before, plain.stress);
    EXPECT_LT((turned.stress - expected).norm(), 1e-11 * law.p_wave_modulus());
    EXPECT_NEAR(law.template plastic_strain<C::dim>(turned), law.template plastic_strain<C::dim>(plain),
                1e-12);
    EXPECT_NEAR(law.template strain_energy<C::dim>(turned), law.template strain_energy<C::dim>(plain), 1e-10);
    EXPECT_NEAR(law.template dissipation<C::dim>(turned), law.template dissipation<C::dim>(plain), 1e-10);
  }
}

TYPED_TEST(Contract, StressIsTheDerivativeOfStoredAndDissipatedEnergy) {
  using C = Contract<TypeParam>;
  const auto law = sample_law<typename C::Law>();
  Random random(10);
  // Per unit of motion the power is M times the strain; a rate form misses it by a share of the strain.
  constexpr bool small = in_small_steps<typename C::Law>;
  for (double before : small ? std::vector{0.0, 1e-4, 1e-3} : std::vector{0.0, 0.003, 0.1})
    for (int i = 0; i < 40; ++i) {
      const double step = small ? std::max(before, 1e-5) : 0.2;
      const double tolerance = small ? 100.0 * step * step : 1e-10;
      const auto old = C::walked(law, random, before, 2);
      const auto k = random.motion<C::dim>(step);
      const Mat<C::dim> g = random.matrix<C::dim>(1.0);
      const auto energy = [&](double size) {
        const auto now = after<C::dim>(law, C::varied(k, g, size), old);
        return law.template strain_energy<C::dim>(now) + law.template dissipation<C::dim>(now);
      };
      const double h = small ? 1e-3 * step : 2e-4;
      const double numeric =
          (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h))) / (12.0 * h);
      const double power = matrix<C::dim>(after<C::dim>(law, k, old).stress).cwiseProduct(g).sum();
      EXPECT_NEAR(power, numeric, tolerance * law.p_wave_modulus());
    }
}

TYPED_TEST(Contract, NeitherDissipationNorPlasticStrainEverDecreases) {
  using C = Contract<TypeParam>;
  const auto law = sample_law<typename C::Law>();
  Random random(11);
  auto state = law.template initial<C::dim>(Sym<C::dim>::Zero());
  for (int step = 0; step < 500; ++step) {
    const auto old = state;
    law.template stress<C::dim>(random.motion<C::dim>(step % 2 == 0 ? 0.05 : 1e-3), state, state);
    EXPECT_GE(law.template dissipation<C::dim>(state), law.template dissipation<C::dim>(old));
    EXPECT_GE(law.template plastic_strain<C::dim>(state), law.template plastic_strain<C::dim>(old));
    EXPECT_GE(law.template strain_energy<C::dim>(state), 0.0);
  }
}

TYPED_TEST(Contract, UpdatingInPlaceGivesTheSameBits) {
  using C = Contract<TypeParam>;
  const auto law = sample_law<typename C::Law>();
  Random random(12);
  for (int i = 0; i < 50; ++i) {
    auto old = C::walked(law, random, 0.1, 1);
    const auto k = random.motion<C::dim>(0.1);
    auto apart = after<C::dim>(law, k, old);
    law.template stress<C::dim>(k, old, old);
    for (int again = 0; again < 2;
         ++again) {  // the second time shows whatever the first left elsewhere in the state
      EXPECT_EQ(apart.stress, old.stress);
      EXPECT_EQ(law.template plastic_strain<C::dim>(apart), law.template plastic_strain<C::dim>(old));
      EXPECT_EQ(law.template dissipation<C::dim>(apart), law.template dissipation<C::dim>(old));
      EXPECT_EQ(law.template strain_energy<C::dim>(apart), law.template strain_energy<C::dim>(old));
      const auto next = random.motion<C::dim>(0.1);
      apart = after<C::dim>(law, next, apart);
      law.template stress<C::dim>(next, old, old);
    }
  }
}

TYPED_TEST(Contract, InitialStressStaysUntilThePointMoves) {
  using C = Contract<TypeParam>;
  const auto law = sample_law<typename C::Law>();
  Sym<C::dim> sigma = -7.0 * sym_identity<C::dim>();
  sigma[1] = -12.0;
  sigma[3] = 2.0;
  const auto state = law.template initial<C::dim>(sigma);
  EXPECT_EQ(state.stress, sigma);
  const auto now = after<C::dim>(law, {}, state);
  EXPECT_LT((now.stress - sigma).norm(), 1e-12 * law.p_wave_modulus());
  EXPECT_GT(law.template strain_energy<C::dim>(state), 0.0);
  EXPECT_EQ(law.template plastic_strain<C::dim>(now), 0.0);
  EXPECT_EQ(law.template dissipation<C::dim>(now), 0.0);
  Random random(13);  // and the tangent is right there, with det(b) away from 1
  EXPECT_LT(C::tangent_error(law, random.motion<C::dim>(1e-3), state, random), 1e-9);
}

TYPED_TEST(Contract, NoStiffnessMeansNoStressNoTangentNoEnergy) {
  using C = Contract<TypeParam>;
  auto law = sample_law<typename C::Law>();
  set(law, "young_modulus", 0.0);
  Random random(14);
  auto state = law.template initial<C::dim>(Sym<C::dim>::Zero());
  for (int step = 0; step < 5; ++step) {
    const auto k = random.motion<C::dim>(0.2);
    const auto now = after<C::dim>(law, k, state);
    Tangent<C::dim> c;
    law.template tangent<C::dim>(k, state, now, c);
    EXPECT_EQ(now.stress, Sym<C::dim>::Zero());
    EXPECT_EQ(c, Tangent<C::dim>::Zero());
    EXPECT_EQ(law.template strain_energy<C::dim>(now), 0.0);
    EXPECT_EQ(law.template dissipation<C::dim>(now), 0.0);
    EXPECT_EQ(law.p_wave_modulus(), 0.0);
    state = now;
  }
}

TYPED_TEST(Contract, TheFirstMemberOfAStateIsItsStress) {
  using C = Contract<TypeParam>;
  typename C::State state{};
  EXPECT_EQ(static_cast<void*>(&state), static_cast<void*>(&state.stress));
}

template <class P>
class PlaneStrain : public ::testing::Test {};
template <class List>
struct LawsOf;
template <class... Laws>
struct LawsOf<std::variant<Laws...>> {
  using type = ::testing::Types<Laws...>;
};
TYPED_TEST_SUITE(PlaneStrain, LawsOf<AnyLaw>::type);

TYPED_TEST(PlaneStrain, IsThreeDimensionsWithoutMotionOutOfPlane) {
  const auto law = sample_law<TypeParam>();
  Random random(15);
  for (int walk = 0; walk < 20; ++walk) {
    auto flat = law.template initial<2>(Sym<2>(-5.0, -3.0, -4.0, 1.0));
    Sym<3> sigma;
    sigma << -5.0, -3.0, -4.0, 1.0, 0.0, 0.0;
    auto solid = law.template initial<3>(sigma);
    for (int step = 0; step < 5; ++step) {
      const auto k = random.motion<2>(0.1);
      Kinematics<3> k3;
      k3.dF.topLeftCorner<2, 2>() = k.dF;
      const auto flat_old = flat;
      const auto solid_old = solid;
      law.template stress<2>(k, flat_old, flat);
      law.template stress<3>(k3, solid_old, solid);
      const double scale = law.p_wave_modulus();
      for (int a = 0; a < 4; ++a) EXPECT_NEAR(flat.stress[a], solid.stress[a], 1e-12 * scale);
      EXPECT_NEAR(solid.stress[4], 0.0, 1e-12 * scale);
      EXPECT_NEAR(solid.stress[5], 0.0, 1e-12 * scale);
      EXPECT_NEAR(law.template plastic_strain<2>(flat), law.template plastic_strain<3>(solid), 1e-13);
      EXPECT_NEAR(law.template strain_energy<2>(flat), law.template strain_energy<3>(solid), 1e-12 * scale);
      EXPECT_NEAR(law.template dissipation<2>(flat), law.template dissipation<3>(solid), 1e-12 * scale);
      Tangent<2> c2;
      Tangent<3> c3;
      law.template tangent<2>(k, flat_old, flat, c2);
      law.template tangent<3>(k3, solid_old, solid, c3);
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
          EXPECT_NEAR(c2(i, j), c3(i / 2 * 3 + i % 2, j / 2 * 3 + j % 2), 1e-11 * scale);
    }
  }
}

}  // namespace
}  // namespace wisp::test
