// Point drivers against closed forms, law by law.
#include "core/error.h"
#include "material/samples.h"

namespace wisp::test {
namespace {

template <class Law, int dim>
typename Law::template State<dim> rest(const Law& law) {
  return law.template initial<dim>(Sym<dim>::Zero());
}

template <int dim>
Mat<dim> diagonal(double x, double y) {
  Mat<dim> f = Mat<dim>::Identity();
  f(0, 0) = x;
  f(1, 1) = y;
  return f;
}

TEST(LinearElastic, ConfinedCompressionAndShear) {
  const auto law = sample_law<LinearElastic>();
  const double lambda = 1000.0 * 0.3 / (1.3 * 0.4);
  const double mu = 1000.0 / 2.6;
  Kinematics<3> k;
  k.dF(1, 1) = 0.99;
  k.dF(2, 1) = 0.004;
  auto state = rest<LinearElastic, 3>(law);
  for (int step = 0; step < 3; ++step) law.stress<3>(k, state, state);
  EXPECT_NEAR(state.stress[0], -0.03 * lambda, 1e-12);
  EXPECT_NEAR(state.stress[1], -0.03 * (lambda + 2.0 * mu), 1e-12);
  EXPECT_NEAR(state.stress[2], -0.03 * lambda, 1e-12);
  EXPECT_NEAR(state.stress[4], 0.012 * mu, 1e-12);
  EXPECT_EQ(state.stress[3], 0.0);
  EXPECT_EQ(state.stress[5], 0.0);
  const double energy = 0.5 * (lambda + 2.0 * mu) * 9e-4 + 0.5 * mu * 1.44e-4;
  EXPECT_NEAR(law.strain_energy<3>(state), energy, 1e-13);
  EXPECT_NEAR(law.p_wave_modulus(), lambda + 2.0 * mu, 1e-12);
}

TEST(LinearElastic, TangentIsTheTextbookMatrix) {
  auto law = sample_law<LinearElastic>();
  const double lambda = 1000.0 * 0.3 / (1.3 * 0.4);
  const double mu = 1000.0 / 2.6;
  Tangent<2> c;
  law.tangent<2>({}, {}, {}, c);
  Tangent<2> expected;
  expected << lambda + 2.0 * mu, 0, 0, lambda, 0, mu, mu, 0, 0, mu, mu, 0, lambda, 0, 0, lambda + 2.0 * mu;
  EXPECT_LT((c - expected).norm(), 1e-12);
}

TEST(Hencky, UniaxialStretchInOneAndInManySteps) {
  const auto law = sample_law<Hencky>();
  const double lambda = 1000.0 * 0.3 / (1.3 * 0.4);
  const double mu = 1000.0 / 2.6;
  for (double stretch : {0.3, 0.9, 1.0, 1.5, 4.0}) {
    for (int steps : {1, 100}) {
      auto state = rest<Hencky, 2>(law);
      for (int step = 0; step < steps; ++step)
        law.stress<2>({diagonal<2>(std::pow(stretch, 1.0 / steps), 1.0), 0.0}, state, state);
      const double strain = std::log(stretch);
      EXPECT_NEAR(state.stress[0], (lambda + 2.0 * mu) * strain, 1e-10);
      EXPECT_NEAR(state.stress[1], lambda * strain, 1e-10);
      EXPECT_NEAR(state.stress[2], lambda * strain, 1e-10);
      EXPECT_NEAR(state.stress[3], 0.0, 1e-12);
      EXPECT_NEAR(law.strain_energy<2>(state), 0.5 * (lambda + 2.0 * mu) * strain * strain, 1e-10);
    }
  }
}

TEST(Hencky, SimpleShear) {
  // Principal stretches of simple shear by g are s and 1/s, s = g/2 + sqrt(1 + g^2/4), on axes with tan(2
  // angle) = 2/g.
  const auto law = sample_law<Hencky>();
  const double mu = 1000.0 / 2.6;
  for (double g : {1e-6, 0.1, 1.0, 5.0}) {
    Kinematics<3> k;
    k.dF(0, 1) = g;
    const auto state = after<3>(law, k, rest<Hencky, 3>(law));
    const double strain = std::asinh(0.5 * g);
    const double hypotenuse = std::sqrt(4.0 + g * g);
    EXPECT_NEAR(state.stress[3], 2.0 * mu * strain * 2.0 / hypotenuse, 1e-11);
    EXPECT_NEAR(state.stress[0], 2.0 * mu * strain * g / hypotenuse, 1e-11);
    EXPECT_NEAR(state.stress[1], -2.0 * mu * strain * g / hypotenuse, 1e-11);
    EXPECT_NEAR(state.stress[2], 0.0, 1e-11);
  }
}

TEST(Hencky, ClosedCycleReturnsToRest) {
  const auto law = sample_law<Hencky>();
  Random random(21);
  for (int i = 0; i < 20; ++i) {
    auto state = rest<Hencky, 3>(law);
    Mat<3> total = Mat<3>::Identity();
    for (int step = 0; step < 10; ++step) {
      const auto k = random.motion<3>(0.05);
      total = k.dF * total;
      law.stress<3>(k, state, state);
    }
    law.stress<3>({total.inverse(), 0.0}, state, state);
    EXPECT_LT(state.stress.norm(), 1e-10);
  }
}

TEST(Hencky, InitialStressWithoutStiffnessIsAnInputError) {
  Hencky law;
  law.young_modulus = 0.0;
  EXPECT_THROW(law.initial<2>(Sym<2>(-1.0, -1.0, -1.0, 0.0)), InputError);
}

/// Properties of the von Mises law as its documentation defines them.
struct Plastic {
  VonMises law = sample_law<VonMises>();
  double mu = 1000.0 / 2.6;
  double bulk = 1000.0 / (3.0 * 0.4);

  explicit Plastic(double hardening) { law.hardening_modulus = hardening; }
};

template <int dim>
double radius(const Sym<dim>& stress) {
  const Sym<dim> s = deviator<dim>(stress);
  return std::sqrt(contract<dim>(s, s));
}

template <int dim>
void returns_to_the_surface(double hardening) {
  const Plastic plastic(hardening);
  Random random(22);
  int yielded = 0;
  for (int walk = 0; walk < 30; ++walk) {
    auto state = rest<VonMises, dim>(plastic.law);
    for (int step = 0; step < 20; ++step) {
      const auto old = state;
      const auto k = random.motion<dim>(step % 3 == 0 ? 0.2 : 0.01);
      plastic.law.template stress<dim>(k, state, state);
      const double limit = 20.0 + std::sqrt(2.0 / 3.0) * hardening * state.plastic_strain;
      EXPECT_LE(radius<dim>(state.stress), limit * (1.0 + 1e-13));
      if (state.plastic_strain > old.plastic_strain) {
        ++yielded;
        EXPECT_NEAR(radius<dim>(state.stress), limit, 1e-11 * limit);
      }
      // the elastic strain carries the stress, and plastic flow keeps the volume
      const Sym<dim> strain = 0.5 * tensor_log<dim>(state.elastic_b);
      EXPECT_LT((plastic.law.elasticity().template stress<dim>(strain) - state.stress).norm(), 1e-10);
      const double growth = trace<dim>(strain) - 0.5 * trace<dim>(tensor_log<dim>(old.elastic_b));
      EXPECT_NEAR(growth, std::log(k.dF.determinant()), 1e-13);
    }
  }
  EXPECT_GT(yielded, 200);
}
TEST(VonMises, ReturnsToTheYieldSurfaceIn2D) { returns_to_the_surface<2>(0.0); }
TEST(VonMises, ReturnsToTheYieldSurfaceIn3D) { returns_to_the_surface<3>(0.0); }
TEST(VonMises, ReturnsToTheHardenedSurfaceIn2D) { returns_to_the_surface<2>(50.0); }
TEST(VonMises, ReturnsToTheHardenedSurfaceIn3D) { returns_to_the_surface<3>(50.0); }

TEST(VonMises, ConfinedCompressionFollowsItsBilinearLaw) {
  // Uniaxial strain e: sqrt(2 J2) = 2 mu sqrt(2/3) |e| up to rho_y; then the multiplier g grows by
  // (2 mu sqrt(2/3) |e| - rho_y) / (2 mu + 2 H / 3), tau_axial = K e +- sqrt(2/3) (rho_y + 2 H g / 3).
  for (double hardening : {0.0, 50.0}) {
    const Plastic plastic(hardening);
    const double a = std::sqrt(2.0 / 3.0);
    auto state = rest<VonMises, 2>(plastic.law);
    double work = 0.0;
    double before = 0.0;
    const double step = -0.002;
    for (int n = 1; n <= 100; ++n) {
      plastic.law.stress<2>({diagonal<2>(1.0, std::exp(step)), 0.0}, state, state);
      const double e = step * n;
      const double g =
          std::max(0.0, (2.0 * plastic.mu * a * -e - 20.0) / (2.0 * plastic.mu + 2.0 / 3.0 * hardening));
      const double deviatoric =
          g > 0.0 ? a * (20.0 + 2.0 / 3.0 * hardening * g) : 2.0 * plastic.mu * 2.0 / 3.0 * -e;
      EXPECT_NEAR(state.stress[1], plastic.bulk * e - deviatoric, 1e-10);
      EXPECT_NEAR(state.stress[0], plastic.bulk * e + 0.5 * deviatoric, 1e-10);
      EXPECT_NEAR(state.stress[2], plastic.bulk * e + 0.5 * deviatoric, 1e-10);
      EXPECT_NEAR(state.plastic_strain, a * g, 1e-13);
      EXPECT_NEAR(state.dissipation, 20.0 * g + hardening * g * g / 3.0, 1e-11);
      work +=
          0.5 * (before + state.stress[1]) * step;  // trapezoids err only in the one step that crosses yield
      before = state.stress[1];
    }
    EXPECT_GT(state.plastic_strain, 0.1);
    EXPECT_NEAR(work, plastic.law.strain_energy<2>(state) + state.dissipation, 5e-3 * work / 100.0);
  }
}

TEST(VonMises, PureShearYieldsAtItsShearStrength) {
  const Plastic plastic(0.0);
  auto state = rest<VonMises, 3>(plastic.law);
  for (int n = 0; n < 200; ++n)
    plastic.law.stress<3>({diagonal<3>(std::exp(1e-3), std::exp(-1e-3)), 0.0}, state, state);
  EXPECT_NEAR(state.stress[0], 20.0 / std::sqrt(2.0), 1e-11);
  EXPECT_NEAR(state.stress[1], -20.0 / std::sqrt(2.0), 1e-11);
  EXPECT_NEAR(state.stress[2], 0.0, 1e-11);
}

TEST(VonMises, SteadySimpleShearIsItsClosedForm) {
  // Perfectly plastic simple shear at a constant rate settles where l b + b l^T = 2 (multiplier) n b with b
  // constant: with b = exp(2 e N) in the plane, e = rho_y / (2 sqrt(2) mu), N at the angle 2 theta, the (2,2)
  // component gives cos(2 theta) = tanh(2 e). So tau_xy = k / cosh(2 e) and tau_xx = -tau_yy = k tanh(2 e), k
  // = rho_y / sqrt(2).
  Plastic plastic(0.0);
  plastic.law.yield_stress = 300.0;
  const double k = 300.0 / std::sqrt(2.0);
  const double twice = k / plastic.mu;
  const auto settled = [&](double step) {
    auto state = rest<VonMises, 2>(plastic.law);
    Kinematics<2> kinematics;
    kinematics.dF(0, 1) = step;
    for (int n = 0; n < static_cast<int>(20.0 / step + 0.5); ++n)
      plastic.law.stress<2>(kinematics, state, state);
    EXPECT_NEAR(state.stress[0], -state.stress[1], 1e-9);
    return state.stress;
  };
  const Sym<2> coarse = settled(2e-3);
  const Sym<2> fine = settled(1e-3);
  const double shear = k / std::cosh(twice);
  const double normal = k * std::tanh(twice);
  EXPECT_NEAR((coarse[3] - shear) / (fine[3] - shear), 2.0,
              0.01);  // first order in the step, as backward Euler is
  EXPECT_NEAR((coarse[0] - normal) / (fine[0] - normal), 2.0, 0.01);
  EXPECT_NEAR(2.0 * fine[3] - coarse[3], shear, 1e-6 * k);
  EXPECT_NEAR(2.0 * fine[0] - coarse[0], normal, 1e-6 * k);
}

TEST(VonMises, UniaxialTensionFollowsTheUniaxialCurve) {
  // With free sides tau = E ln(stretch) up to sigma_Y = sqrt(3/2) yield_stress, then with slope E H / (E +
  // H). The free sides are found by Newton with the tangent, which must converge quadratically.
  for (double hardening : {0.0, 50.0, 400.0}) {
    const Plastic plastic(hardening);
    const double strength = std::sqrt(1.5) * 20.0;
    auto state = rest<VonMises, 3>(plastic.law);
    for (int n = 1; n <= 60; ++n) {
      Kinematics<3> k;
      k.dF(0, 0) = std::exp(0.01);
      VonMises::State<3> now;
      int iterations = 0;
      while (true) {
        plastic.law.stress<3>(k, state, now);
        const double residual = now.stress[1];
        if (std::abs(residual) < 1e-10) break;
        ASSERT_LT(++iterations, 8);
        Tangent<3> c;
        plastic.law.tangent<3>(k, state, now, c);
        // both sides stretch alike: d(tau_yy) for du_y,y = du_z,z = 1; tau_yy is the geometric term's
        // residual
        const double slope = c(4, 4) + c(4, 8) + residual;
        const double side = k.dF(1, 1) * (1.0 - residual / slope);
        k.dF(1, 1) = k.dF(2, 2) = side;
      }
      state = now;
      const double e = 0.01 * n;
      const double plastic_slope = 1000.0 * hardening / (1000.0 + hardening);
      const double first = strength / 1000.0;
      const double expected = e < first ? 1000.0 * e : strength + plastic_slope * (e - first);
      EXPECT_NEAR(state.stress[0], expected, 1e-8);
      EXPECT_NEAR(state.plastic_strain, e < first ? 0.0 : e - expected / 1000.0, 1e-11);
    }
  }
}

TEST(VonMises, InitialStressBeyondYieldIsAnInputError) {
  const Plastic plastic(0.0);
  EXPECT_NO_THROW(plastic.law.initial<2>(Sym<2>(-1e4, -1e4, -1e4, 14.0)));
  EXPECT_THROW(plastic.law.initial<2>(Sym<2>(0.0, 0.0, 0.0, 15.0)), InputError);
}

}  // namespace
}  // namespace wisp::test
