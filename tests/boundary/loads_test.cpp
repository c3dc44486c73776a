// Point loads and tractions: resultants for every basis, following pressure, rotation.
#include "boundary/list.h"

#include <gtest/gtest.h>

#include "boundary/samples.h"

namespace wisp {
namespace {

/// F at the surface points, as checkpoints keep them.
std::vector<Mat<2>> deformation_gradients(Traction<2>& traction) {
  std::vector<Mat<2>> result;
  traction.for_each_field([&](std::string_view name, const auto& field) {
    if constexpr (std::is_same_v<std::decay_t<decltype(field)>, std::vector<Mat<2>>>)
      if (name == "deformation_gradient") result = field;
  });
  return result;
}

using namespace boundary_test;

constexpr int widths[] = {2, 3, 5};

template <int dim>
std::vector<double> field(const Space<dim>& space, const Mat<dim>& gradient, const Vec<dim>& shift) {
  std::vector<double> u(static_cast<std::size_t>(space.n_functions()) * dim);
  for (int i = 0; i < space.n_functions(); ++i)
    Eigen::Map<Vec<dim>>(u.data() + i * dim) = gradient * space.node_position(i) + shift;
  return u;
}

TEST(PointLoad, ActsAtItsPointsWithItsTotal) {
  for (const int width : widths) {
    const auto s = scene<2>(width);
    PointLoadOptions o;
    o.label = "tip", o.body = "block", o.nearest = {{2.0, 1.4}, {2.0, 1.6}}, o.force = {3.0, -8.0};
    o.factor.times = {0.0, 1.0}, o.factor.values = {0.0, 2.0};
    const PointLoad<2> load(o, s.bodies, *s.space);
    ASSERT_EQ(load.ids().size(), 2U);
    std::vector<double> force(static_cast<std::size_t>(s.space->n_functions()) * 2, 0.0);
    load.add_force(*s.space, s.bodies, 0.25, force);
    const auto r = resultant(*s.space, force);
    EXPECT_LT((r.force - Vec<2>(1.5, -4.0)).norm(), 1e-13);
    // The two points are mirror images about y = 1.5, at x = 1.875.
    const Vec<2> x(1.875, 1.5);
    EXPECT_NEAR(r.moment(0, 1), x[0] * r.force[1] - x[1] * r.force[0], 1e-12);
    for (const auto id : load.ids()) EXPECT_GE(id, 100);
  }
}

TEST(PointLoad, WrongDescriptionsAreInputErrors) {
  const auto s = scene<2>(2);
  PointLoadOptions o;
  o.label = "tip", o.body = "block", o.nearest = {{2.0, 1.4}}, o.force = {3.0, -8.0};
  const auto wrong = [&](auto&& change) {
    PointLoadOptions w = o;
    change(w);
    EXPECT_THROW(PointLoad<2>(w, s.bodies, *s.space), InputError);
  };
  wrong([](auto& w) { w.body = "blok"; });
  wrong([](auto& w) { w.nearest = {}; });
  wrong([](auto& w) { w.nearest = {{1.0}}; });
  wrong([](auto& w) { w.nearest = {{2.0, 1.4}, {2.0, 1.41}}; });
  wrong([](auto& w) { w.force = {1.0, 2.0, 3.0}; });
}

template <int dim>
TractionOptions side(int points) {
  TractionOptions o;
  o.label = "load", o.body = "block";
  if (dim == 2) {  // the side x = 2, upwards: its outward normal is +x
    o.corner = {2.0, 1.0}, o.edges = {{0.0, 1.0}}, o.points = {points};
  } else {
    o.corner = {2.0, 1.0, 1.0}, o.edges = {{0.0, 1.0, 0.0}, {0.0, 0.0, 0.5}}, o.points = {points, points + 1};
  }
  return o;
}

template <int dim>
void total_is_traction_times_area() {
  for (const int width : widths) {
    const auto s = scene<dim>(width);
    TractionOptions o = side<dim>(5);
    o.traction = dim == 2 ? std::vector<double>{3.0, 1.0} : std::vector<double>{3.0, 1.0, -2.0};
    o.factor = Curve(2.0);
    const Traction<dim> traction(o, s.bodies, *s.space);
    std::vector<double> force(static_cast<std::size_t>(s.space->n_functions()) * dim, 0.0);
    traction.add_force(*s.space, s.bodies, 0.0, force);
    const auto r = resultant<dim>(*s.space, force);
    const Vec<dim> t = 2.0 * (dim == 2 ? 1.0 : 0.5) * Eigen::Map<const Vec<dim>>(o.traction.data());
    Vec<dim> centre = Vec<dim>::Constant(1.5);
    centre[0] = 2.0;
    if constexpr (dim == 3) centre[2] = 1.25;
    EXPECT_LT((r.force - t).norm(), 1e-13);
    EXPECT_LT((r.moment - (centre * t.transpose() - t * centre.transpose())).norm(), 1e-12);
  }
}
TEST(Traction, TotalIsTractionTimesArea2D) { total_is_traction_times_area<2>(); }
TEST(Traction, TotalIsTractionTimesArea3D) { total_is_traction_times_area<3>(); }

TEST(Traction, ADeadLoadKeepsItsDirectionAPressureFollows) {
  for (const int width : widths) {
    auto s = scene<2>(width);
    TractionOptions dead = side<2>(4), pressure = side<2>(4);
    dead.traction = {5.0, 0.0};
    pressure.pressure = Curve(5.0);
    // A rotation about (1.5, 1.5) with a stretch of 2 along the side.
    const double c = std::cos(0.6), sn = std::sin(0.6);
    Mat<2> rotation, stretch = Mat<2>::Identity();
    rotation << c, -sn, sn, c;
    stretch(1, 1) = 2.0;
    const Mat<2> F = rotation * stretch;
    const Vec<2> centre(1.5, 1.5);
    const auto u = field<2>(*s.space, F - Mat<2>::Identity(), centre - F * centre);
    for (auto* options : {&dead, &pressure}) {
      Traction<2> traction(*options, s.bodies, *s.space);
      const Vec<2> before = traction.positions()[0];
      traction.move(*s.space, u, 2, 1.0);
      EXPECT_LT((traction.positions()[0] - centre - F * (before - centre)).norm(), 1e-13);
      EXPECT_LT((deformation_gradients(traction)[0] - F).norm(), 1e-13);
      std::vector<double> force(u.size(), 0.0);
      traction.add_force(*s.space, s.bodies, 0.0, force);
      const Vec<2> expected = options == &dead ? Vec<2>(5.0, 0.0) : Vec<2>(-5.0 * 2.0 * rotation.col(0));
      EXPECT_LT((resultant(*s.space, force).force - expected).norm(), 1e-12);
    }
  }
}

template <int dim>
void closed_surface_has_no_net_pressure() {
  auto s = scene<dim>(3);
  std::vector<TractionOptions> faces;
  const auto face = [&](std::vector<double> corner, std::vector<std::vector<double>> edges) {
    TractionOptions o;
    o.label = "face", o.body = "block", o.corner = std::move(corner), o.edges = std::move(edges);
    o.points = std::vector<int>(dim - 1, 3), o.pressure = Curve(7.0);
    faces.push_back(o);
  };
  if constexpr (dim == 2) {
    face({1, 1}, {{1, 0}}), face({2, 1}, {{0, 1}}), face({2, 2}, {{-1, 0}}), face({1, 2}, {{0, -1}});
  } else {
    face({1, 1, 1}, {{0, 1, 0}, {1, 0, 0}}), face({1, 1, 2}, {{1, 0, 0}, {0, 1, 0}});
    face({1, 1, 1}, {{1, 0, 0}, {0, 0, 1}}), face({1, 2, 1}, {{0, 0, 1}, {1, 0, 0}});
    face({1, 1, 1}, {{0, 0, 1}, {0, 1, 0}}), face({2, 1, 1}, {{0, 1, 0}, {0, 0, 1}});
  }
  Mat<dim> gradient;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) gradient(i, j) = 0.1 * std::sin(1.0 + 3 * i + 5 * j);
  const auto u = field<dim>(*s.space, gradient, Vec<dim>::Zero());
  std::vector<double> force(u.size(), 0.0);
  double strongest = 0.0;
  for (const auto& o : faces) {
    Traction<dim> traction(o, s.bodies, *s.space);
    traction.move(*s.space, u, dim, 1.0);
    std::vector<double> one(u.size(), 0.0);
    traction.add_force(*s.space, s.bodies, 0.0, one);
    strongest = std::max(strongest, resultant<dim>(*s.space, one).force.norm());
    for (std::size_t k = 0; k < force.size(); ++k) force[k] += one[k];
  }
  EXPECT_GT(strongest, 5.0);
  EXPECT_LT(resultant<dim>(*s.space, force).force.norm(), 1e-12);
  EXPECT_LT(resultant<dim>(*s.space, force).moment.norm(), 1e-11);
}
TEST(Traction, PressureOnAClosedSurfaceHasNoResultant2D) { closed_surface_has_no_net_pressure<2>(); }
TEST(Traction, PressureOnAClosedSurfaceHasNoResultant3D) { closed_surface_has_no_net_pressure<3>(); }

TEST(Traction, ActsThroughTheNearestActiveCell) {
  auto s = scene<2>(2);
  TractionOptions o = side<2>(4);
  o.traction = {5.0, 1.0};
  Traction<2> traction(o, s.bodies, *s.space);
  Mat<2> gradient;
  gradient << 0.02, 0.1, -0.05, 0.03;
  // First on the line x = 2, where the active cells end, then beyond it.
  for (int k = 0; k < 2; ++k) {
    traction.settle(*s.space, active_cells(*s.space, s.bodies));
    std::vector<double> force(static_cast<std::size_t>(s.space->n_functions()) * 2, 0.0);
    traction.add_force(*s.space, s.bodies, 0.0, force);
    EXPECT_LT((resultant(*s.space, force).force - Vec<2>(5.0, 1.0)).norm(), 1e-13);
    for (int i = 0; i < s.space->n_functions(); ++i)
      if (s.space->node_position(i)[0] > 2.0) {
        EXPECT_EQ(force[static_cast<std::size_t>(2 * i)], 0.0) << "no function without mass carries a load";
      }
    // A linear field that the functions without mass do not know is continued.
    auto u = field<2>(*s.space, gradient, Vec<2>(0.1, 0.0));
    for (int i = 0; i < s.space->n_functions(); ++i)
      if (s.space->node_position(i)[0] > 2.0)
        u[static_cast<std::size_t>(2 * i)] = u[static_cast<std::size_t>(2 * i + 1)] = 0.0;
    const Vec<2> before = traction.positions()[1];
    const Mat<2> F = deformation_gradients(traction)[1];
    traction.move(*s.space, u, 2, 1.0);
    EXPECT_LT((traction.positions()[1] - before - gradient * before - Vec<2>(0.1, 0.0)).norm(), 1e-12);
    EXPECT_LT((deformation_gradients(traction)[1] - (Mat<2>::Identity() + gradient) * F).norm(), 1e-12);
  }
}

TEST(Traction, WrongDescriptionsAreInputErrors) {
  const auto s = scene<2>(2);
  TractionOptions o = side<2>(3);
  o.traction = {1.0, 0.0};
  EXPECT_NO_THROW(Traction<2>(o, s.bodies, *s.space));
  const auto wrong = [&](auto&& change) {
    TractionOptions w = o;
    change(w);
    EXPECT_THROW(Traction<2>(w, s.bodies, *s.space), InputError);
  };
  wrong([](auto& w) { w.body = "other"; });
  wrong([](auto& w) { w.traction = {}; });
  wrong([](auto& w) { w.pressure = Curve(1.0); });
  wrong([](auto& w) { w.edges = {}; });
  wrong([](auto& w) { w.edges = {{0.0, 0.0}}; });
  wrong([](auto& w) { w.corner = {3.9, 3.5}; });
  wrong([](auto& w) { w.points = {3, 3}; });
}

TEST(Traction, ASurfaceThatLeavesTheGridIsARunError) {
  auto s = scene<2>(2);
  TractionOptions o = side<2>(3);
  o.traction = {1.0, 0.0};
  Traction<2> traction(o, s.bodies, *s.space);
  const auto u = field<2>(*s.space, Mat<2>::Zero(), Vec<2>(3.0, 0.0));
  EXPECT_THROW(traction.move(*s.space, u, 2, 1.0), RunError);
}

}  // namespace
}  // namespace wisp
