// Vibrating bars: frequency, amplitude and energies of every explicit scheme and of Newmark's method.
#include "analysis/fixtures.h"

namespace wisp {
namespace {

using namespace analysis_test;

constexpr double E = 1e4, rho = 100.0, length = 1.0, amplitude = 1e-4;
const double omega = 0.5 * M_PI / length * std::sqrt(E / rho);  // first mode, fixed at x = 0, free at x = 1

/// A bar along x in its first mode, moving through its undeformed state.
ModelOptions bar(int n, bool gimp, const AnyLaw& law) {
  const double h = length / n;
  auto o = on_grid<2>({0, 0}, {length + 2 * h, h}, {n + 2, 1}, gimp);
  add_box<2>(o, {0, 0}, {length, h}, law);
  hold(o, "x", 0.0, "x"), hold(o, "y", 0.0, "y"), hold(o, "y", h, "y");
  return o;
}
void start(Model<2>& model, double size = amplitude) {
  for (auto& body : model.bodies)
    for (std::size_t p = 0; p < body.points.position.size(); ++p)
      body.points.velocity[p] = Vec<2>(size * omega * std::sin(0.5 * M_PI * body.points.position[p][0]), 0.0);
}

struct Vibration {
  std::vector<double> times, momenta, energies;

  void add(const Model<2>& model, const EnergyRecord& record) {
    times.push_back(model.time), momenta.push_back(momentum(model)[0]);
    energies.push_back(record.kinetic + record.strain);
  }
  double frequency() const {
    const auto zero = sign_changes(times, momenta);
    return M_PI * static_cast<double>(zero.size() - 1) / (zero.back() - zero.front());
  }
  /// Least momentum over the first: -1 without damping.
  double turn() const { return *std::min_element(momenta.begin(), momenta.end()) / momenta.front(); }
};

Vibration run_explicit(int n, bool gimp, MassKind kind, StressUpdate scheme, VelocityUpdate update,
                       double periods) {
  auto o = bar(n, gimp, Hencky{rho, E, 0.0});
  const Mass mass = apply(kind, o);
  Model<2> model(o);
  start(model);
  const double dt = 0.2 * length / n / std::sqrt(E / rho);
  Explicit<2> run(model, explicit_steps(dt, mass, scheme, update));
  Vibration v;
  EnergyRecord record;
  while (model.time < periods * 2 * M_PI / omega) run.step(dt, &record), v.add(model, record);
  return v;
}

TEST(VibratingBar, HasItsFrequencyAndAmplitudeInEveryExplicitScheme) {
  for (const bool gimp : {false, true})
    for (const MassKind kind : all_masses)
      for (const StressUpdate scheme : all_schemes) {
        if (!solvable(kind, gimp)) continue;
        const auto v = run_explicit(16, gimp, kind, scheme, VelocityUpdate::flip, 2.2);
        EXPECT_NEAR(v.frequency() / omega, 1.0, 5e-3)
            << gimp << static_cast<int>(kind) << static_cast<int>(scheme);
        EXPECT_NEAR(v.turn(), -1.0, 2e-2) << gimp << static_cast<int>(kind) << static_cast<int>(scheme);
      }
}

TEST(VibratingBar, FrequencyConvergesAtSecondOrder) {
  for (const MassKind kind : all_masses) {
    const double coarse =
        run_explicit(8, false, kind, StressUpdate::usl, VelocityUpdate::flip, 2.2).frequency();
    const double fine =
        run_explicit(16, false, kind, StressUpdate::usl, VelocityUpdate::flip, 2.2).frequency();
    EXPECT_GT(order(std::abs(coarse - omega), std::abs(fine - omega)), 1.5)
        << static_cast<int>(kind) << " " << coarse << " " << fine;
  }
}

TEST(VibratingBar, EnergyRecordsOfTheSchemes) {
  const double first =
      0.25 * rho * length * (length / 16) * std::pow(amplitude * omega, 2);  // integral of sin^2 is 1/2
  for (const StressUpdate scheme : all_schemes) {
    const auto v = run_explicit(16, true, MassKind::lumped, scheme, VelocityUpdate::flip, 2.0);
    EXPECT_NEAR(v.energies.front() / first, 1.0, 1e-2);
    for (const double e : v.energies) ASSERT_NEAR(e / first, 1.0, 4e-2) << static_cast<int>(scheme);
  }
  // Bardenhagen 2002: stress first keeps the energy, stress last loses some of what the grid does not
  // resolve.
  const auto usf = run_explicit(16, true, MassKind::lumped, StressUpdate::usf, VelocityUpdate::flip, 4.0);
  const auto usl = run_explicit(16, true, MassKind::lumped, StressUpdate::usl, VelocityUpdate::flip, 4.0);
  EXPECT_LE(usl.energies.back(), usf.energies.back());
}

TEST(VibratingBar, PicDampsAndApicLess) {
  const auto flip = run_explicit(16, true, MassKind::lumped, StressUpdate::usl, VelocityUpdate::flip, 1.0);
  const auto apic = run_explicit(16, true, MassKind::lumped, StressUpdate::usl, VelocityUpdate::apic, 1.0);
  const auto pic = run_explicit(16, true, MassKind::lumped, StressUpdate::usl, VelocityUpdate::pic, 1.0);
  EXPECT_LT(pic.energies.back(), 0.9 * apic.energies.back());
  EXPECT_LT(apic.energies.back(), 1.001 * flip.energies.back());
  EXPECT_GT(pic.energies.back(), 0.0);
}

Vibration run_newmark(double damping, int steps_per_period, double periods, bool gimp, bool ghost) {
  auto o = bar(16, gimp, LinearElastic{rho, E, 0.0});
  if (ghost) o.stabilisation = GhostOptions{};
  Model<2> model(o);
  start(model, 0.1 * amplitude);  // points move in their cells, which changes the energy by a part of this
  ImplicitDynamicOptions options;
  options.numerical_damping = damping, options.tolerance = 1e-10;
  Implicit<2> run(model, options);
  Vibration v;
  EnergyRecord record;
  const int steps = static_cast<int>(periods * steps_per_period);
  for (int k = 0; k < steps; ++k)
    run.step(2 * M_PI / omega / steps_per_period, &record), v.add(model, record);
  return v;
}

TEST(Newmark, HasTheFrequencyOfTheTrapezoidalRule) {
  for (const bool gimp : {false, true})
    for (const bool ghost : {false, true}) {
      if (gimp && !ghost) continue;
      const auto v = run_newmark(0.0, 40, 2.2, gimp, ghost);
      const double step = 2 * M_PI / 40;  // omega dt; the rule's own frequency is 2 atan(omega dt / 2) / dt
      EXPECT_NEAR(v.frequency() / omega, 2 * std::atan(0.5 * step) / step, 2e-3);
    }
}

TEST(Newmark, KeepsTheEnergyWithoutAndLosesItWithNumericalDamping) {
  for (const bool gimp : {false, true}) {
    const auto kept = run_newmark(0.0, 40, 2.0, gimp, gimp);
    // The rule keeps the energy of fixed stencils; points that move in their cells change it by a few 1e-6 a
    // period.
    for (const double e : kept.energies)
      ASSERT_NEAR(e / kept.energies.front(), 1.0, gimp ? 1e-4 : 1e-5) << gimp;
    const auto lost = run_newmark(0.1, 20, 3.0, gimp, gimp);
    for (std::size_t k = 1; k < lost.energies.size(); ++k)
      ASSERT_LE(lost.energies[k], lost.energies[k - 1] * (1 + 1e-3));
    // Numerical damping ratio alpha omega dt / 2 (Hughes 1987), so the energy falls by exp(-alpha omega dt
    // omega t).
    const double fall = std::exp(-0.1 * (2 * M_PI / 20) * (2 * M_PI * 3.0));
    EXPECT_NEAR(lost.energies.back() / lost.energies.front(), fall, 0.05) << gimp;
    EXPECT_GT(lost.energies.back(), 0.0);
  }
}

TEST(Newmark, FreeFlightKeepsTheMomentumAndFallsExactly) {
  auto o = on_grid<2>({-2, -2}, {2, 2}, {16, 16}, true);
  add_box<2>(o, {-0.5, -0.5}, {0.5, 0.5}, Hencky{1000.0, 1e5, 0.3});
  o.bodies[0].velocity = {1.0, 2.0};
  o.stabilisation = GhostOptions{};
  add_gravity(o, {0.0, -10.0});
  Model<2> model(o);
  // Free fall has its acceleration from the start.
  Implicit<2> run(model, ImplicitDynamicOptions{});
  for (auto& a : model.bodies[0].points.acceleration) a = Vec<2>(0.0, -10.0);
  const Vec<2> p = momentum(model);
  for (int k = 0; k < 20; ++k) run.step(0.01);
  const double m = total_mass(model);
  EXPECT_LT((momentum(model) - p - m * Vec<2>(0.0, -2.0)).norm(), 1e-6 * m);
  for_each_point(model, [&](const auto& body, std::size_t k) {
    ASSERT_LT((body.points.displacement[k] - Vec<2>(0.2, 0.4 - 0.5 * 10 * 0.04)).norm(), 1e-7);
  });
}

TEST(Walls, ThatMoveCarryABodyAlong) {
  // All that a block touches moves with one velocity: so does the block, without stress, in every scheme.
  for (const bool by_displacement : {false, true})
    for (const MassKind kind : all_masses)
      for (const StressUpdate scheme : all_schemes) {
        auto o = on_grid<2>({0, 0}, {1, 1}, {4, 4}, kind != MassKind::consistent);
        add_box<2>(o, {0.25, 0.25}, {0.75, 0.75}, Hencky{1000.0, 1e5, 0.3});
        o.bodies[0].velocity = {0.2, 0.0};
        Curve position;
        position.times = {-10.0, 10.0}, position.values = {-2.0, 2.0};
        for (const double x : {0.0, 0.25, 0.75, 1.0}) {
          auto& wall = hold(o, "x", x, "x");
          by_displacement ? wall.displacement = position : wall.velocity = Curve(0.2);
        }
        const Mass mass = apply(kind, o);
        Model<2> model(o);
        Explicit<2> run(model, explicit_steps(1e-3, mass, scheme));
        for (int k = 0; k < 20; ++k) run.step(1e-3);
        for_each_point(model, [&](const auto& body, std::size_t p) {
          ASSERT_LT((body.points.velocity[p] - Vec<2>(0.2, 0.0)).norm(), 1e-9);
          ASSERT_LT(stress_of(body, p).norm(), 1e-5) << static_cast<int>(kind) << static_cast<int>(scheme);
        });
        for (const auto& r : model.reactions) EXPECT_LT(r.norm(), 1e-6);
      }
}

TEST(Walls, DoTheWorkThatTheBodyGains) {
  for (const bool by_displacement : {false, true})
    for (const MassKind kind : all_masses) {
      auto o = bar(16, kind != MassKind::consistent, Hencky{rho, E, 0.0});
      // From rest to 0.1 m/s in 0.01 s, then steady; the bar is hit at x = 0.
      Curve velocity;
      velocity.times = {0.0, 0.01, 1.0}, velocity.values = {0.0, 0.1, 0.1};
      if (by_displacement) {
        std::get<ConformingOptions>(o.boundaries[0]).displacement = Curve();
        auto& curve = *std::get<ConformingOptions>(o.boundaries[0]).displacement;
        curve.times.clear(), curve.values.clear();
        for (int k = 0; k <= 400; ++k) {
          const double t = 1e-3 * k;
          curve.times.push_back(t), curve.values.push_back(t < 0.01 ? 5.0 * t * t : 5e-4 + 0.1 * (t - 0.01));
        }
      } else {
        std::get<ConformingOptions>(o.boundaries[0]).velocity = velocity;
      }
      const Mass mass = apply(kind, o);
      Model<2> model(o);
      const double dt = 1e-3;
      Explicit<2> run(model, explicit_steps(dt, mass));
      EnergyRecord record;
      for (int k = 0; k < 150; ++k) run.step(dt, &record);
      const double before = record.external_work;
      EXPECT_NEAR((record.kinetic + record.strain) / before, 1.0, 0.03)
          << by_displacement << static_cast<int>(kind);
      EXPECT_GT(before, 0.0);
    }
}

TEST(Tractions, GiveTheirImpulse) {
  for (const MassKind kind : all_masses) {
    auto o = on_grid<2>({-1, -1}, {2, 2}, {12, 12}, kind != MassKind::consistent);
    add_box<2>(o, {0, 0}, {1, 1}, Hencky{1000.0, 1e5, 0.3});
    TractionOptions t;
    t.label = "push", t.body = "body 0", t.corner = {1, 0}, t.edges = {{0, 1}}, t.points = {8},
    t.traction = {300.0, 70.0};
    o.loads.push_back(t);
    const Mass mass = apply(kind, o);
    Model<2> model(o);
    Explicit<2> run(model, explicit_steps(1e-3, mass));
    for (int k = 0; k < 50; ++k) run.step(1e-3);
    EXPECT_LT((momentum(model) - 0.05 * Vec<2>(300.0, 70.0)).norm(), 1e-8) << static_cast<int>(kind);
    // The surface has stayed at the end of the block, half a point's size from its last points.
    const auto& points = model.bodies[0].points;
    double last = 0.0;
    for (std::size_t p = 0; p < points.position.size(); ++p) last = std::max(last, points.displacement[p][0]);
    for (const auto& x : std::get<Traction<2>>(model.loads[0]).positions())
      EXPECT_NEAR(x[0] - 1.0, last, 0.3 * last);
  }
}

}  // namespace
}  // namespace wisp
