// From shapes to points, and keeping points in order.
#include "particle/sampling.h"

#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "core/error.h"
#include "particle/order.h"

namespace wisp {
namespace {

template <int dim>
StructuredGrid<dim> unequal() {
  std::array<std::vector<double>, dim> lines;
  for (auto& l : lines) l = {0.0, 0.5, 0.8, 1.5, 2.0, 3.0};
  return StructuredGrid<dim>(lines);
}

template <int dim>
BodyOptions box(double lower, double upper, int points = 2) {
  BodyOptions o;
  o.label = "block";
  o.shape = Box{std::vector<double>(dim, lower), std::vector<double>(dim, upper)};
  o.sampling.points_per_cell = points;
  o.material = Hencky{1000.0, 1e6, 0.3};
  return o;
}

template <int dim>
double total_volume(const Body<dim>& body) {
  double sum = 0.0;
  for (const double v : body.points.volume) sum += v;
  return sum;
}

template <int dim>
void fills_cells(SamplingMethod method) {
  for (int m = 1; m <= 4; ++m) {
    auto o = box<dim>(0.5, 2.0, m);
    o.sampling.method = method;
    const auto body = sample<dim>(o, unequal<dim>(), true, 10, {});
    const auto& points = body.points;
    ASSERT_EQ(points.size(), static_cast<int>(std::pow(3 * m, dim)));
    EXPECT_NEAR(total_volume(body), std::pow(1.5, dim), 1e-13);
    for (std::size_t p = 0; p < points.position.size(); ++p) {
      EXPECT_NEAR((2.0 * points.half_length[p]).prod(), points.volume[p], 1e-15) << "domains tile the body";
      EXPECT_NEAR(points.mass[p], 1000.0 * points.volume[p], 1e-10);
      EXPECT_EQ(points.id[p], 10 + static_cast<std::int64_t>(p));
    }
  }
}
TEST(Sampling, FillsCellsEvenly) {
  fills_cells<2>(SamplingMethod::cells), fills_cells<3>(SamplingMethod::cells);
}
TEST(Sampling, FillsCellsAtGaussPoints) {
  fills_cells<2>(SamplingMethod::gauss), fills_cells<3>(SamplingMethod::gauss);
}

TEST(Sampling, GaussPointsIntegratePolynomials) {
  for (int m = 1; m <= 5; ++m) {
    auto o = box<2>(0.5, 2.0, m);
    o.sampling.method = SamplingMethod::gauss;
    const auto body = sample<2>(o, unequal<2>(), false, 0, {});
    const int power = 2 * m - 1;
    double sum = 0.0;
    for (std::size_t p = 0; p < body.points.volume.size(); ++p)
      sum += body.points.volume[p] * std::pow(body.points.position[p][0], power);
    const double exact = 1.5 * (std::pow(2.0, power + 1) - std::pow(0.5, power + 1)) / (power + 1);
    EXPECT_NEAR(sum, exact, 1e-12 * exact);
    EXPECT_TRUE(body.points.half_length.empty());
  }
}

TEST(Sampling, DividesTheBoundingBox) {
  auto o = box<2>(0.4, 1.9);
  o.sampling.method = SamplingMethod::divisions, o.sampling.divisions = {5, 3};
  const auto body = sample<2>(o, unequal<2>(), true, 0, {});
  ASSERT_EQ(body.points.size(), 15);
  EXPECT_LT((body.points.position[0] - Vec<2>(0.55, 0.65)).norm(), 1e-14);
  EXPECT_NEAR(total_volume(body), 1.5 * 1.5, 1e-14);
  EXPECT_LT((body.points.half_length[7] - Vec<2>(0.15, 0.25)).norm(), 1e-14);
  o.sampling.divisions = {5};
  EXPECT_THROW(sample<2>(o, unequal<2>(), true, 0, {}), InputError);
}

TEST(Sampling, OfABallComesNearItsVolume) {
  const StructuredGrid<3> grid(Vec<3>::Zero(), Vec<3>::Constant(2.0), MultiIndex<3>::Constant(16));
  BodyOptions o = box<3>(0, 1);
  o.shape = Ball{{1.0, 1.0, 1.0}, 0.7};
  const auto body = sample<3>(o, grid, false, 0, {});
  const double exact = 4.0 / 3.0 * std::numbers::pi * 0.343;
  EXPECT_NEAR(total_volume(body), exact, 0.02 * exact);
  for (const auto& x : body.points.position) EXPECT_LE((x - Vec<3>::Ones()).norm(), 0.7);
}

TEST(Sampling, GivesVelocitiesAndStress) {
  auto o = box<2>(0.5, 2.0);
  o.velocity = {1.0, -2.0}, o.velocity_gradient = {{0.0, 3.0}, {-1.0, 0.5}}, o.velocity_centre = {1.0, 1.0};
  o.k0 = InitialK0{0.5, 2.0, 10.0};
  const auto body = sample<2>(o, unequal<2>(), true, 0, {});
  for_each_state<2>(body, [&](int p, const auto&, const auto& state) {
    const Vec<2> x = body.points.position[static_cast<std::size_t>(p)];
    const Vec<2> v(1.0 + 3.0 * (x[1] - 1.0), -2.0 - (x[0] - 1.0) + 0.5 * (x[1] - 1.0));
    EXPECT_LT((body.points.velocity[static_cast<std::size_t>(p)] - v).norm(), 1e-14);
    const double vertical = -1000.0 * 10.0 * (2.0 - x[1]);
    EXPECT_LT((state.stress - Sym<2>(0.5 * vertical, vertical, 0.5 * vertical, 0.0)).norm(), 1e-10);
  });
  o.initial_stress = {1.0, 2.0, 3.0, 4.0};
  EXPECT_THROW(sample<2>(o, unequal<2>(), true, 0, {}), InputError);
  o.k0.reset();
  const auto constant = sample<2>(o, unequal<2>(), true, 0, {});
  for_each_state<2>(
      constant, [&](int, const auto&, const auto& state) { EXPECT_EQ(state.stress, Sym<2>(1, 2, 3, 4)); });
}

TEST(Sampling, WrongDescriptionsAreInputErrors) {
  const auto wrong = [](auto&& change) {
    auto o = box<2>(0.5, 2.0);
    change(o);
    EXPECT_THROW(sample<2>(o, unequal<2>(), true, 0, {}), InputError);
  };
  wrong([](auto& o) { o.shape = Box{{4.0, 4.0}, {5.0, 5.0}}; });
  wrong([](auto& o) { o.shape = Ball{{0.5, 0.5}, 1e-6}; });
  wrong([](auto& o) { o.velocity = {1.0}; });
  wrong([](auto& o) { o.velocity_gradient = {{1.0, 0.0}}; });
  wrong([](auto& o) { o.velocity_centre = {1.0, 2.0, 3.0}; });
  wrong([](auto& o) { o.initial_stress = {1.0, 2.0}; });
  wrong([](auto& o) { o.shape = PointFile{"no-such-file.csv"}; });
}

TEST(Order, PutsPointsOfOneCellTogetherAndKeepsFieldsTogether) {
  const auto grid = unequal<2>();
  const Window<2> window(grid.cells(), IndexBox<2>{MultiIndex<2>::Zero(), grid.cells()});
  auto body = sample<2>(box<2>(0.0, 3.0, 3), grid, true, 0, {});
  auto& points = body.points;
  for (std::size_t p = 0; p < points.id.size(); ++p) {
    std::swap(points.position[p], points.position[(7 * p + 3) % points.id.size()]);
    points.displacement[p] = Vec<2>(static_cast<double>(points.id[p]), 0.0);
  }
  std::get<MaterialStates<Hencky, 2>>(body.material).old[5].stress[0] = 42.0;
  const auto before = points;
  Location found = locate(points, grid, window);
  EXPECT_EQ(found.outside, 0);
  EXPECT_GT(found.disorder, 0);
  OrderMemory memory;
  reorder(body, window.n_cells(), memory);
  EXPECT_TRUE(std::is_sorted(points.cell.begin(), points.cell.end()));
  found = locate(points, grid, window);
  EXPECT_EQ(found.disorder, 0);
  for (std::size_t p = 0; p < points.id.size(); ++p) {
    const auto old = static_cast<std::size_t>(points.id[p]);
    EXPECT_EQ(points.position[p], before.position[old]);
    EXPECT_EQ(points.half_length[p], before.half_length[old]);
    EXPECT_EQ(points.mass[p], before.mass[old]);
    EXPECT_EQ(points.displacement[p][0], static_cast<double>(old));
    EXPECT_EQ((std::get<MaterialStates<Hencky, 2>>(body.material).old[p].stress[0]), old == 5 ? 42.0 : 0.0);
    if (p > 0 && points.cell[p] == points.cell[p - 1]) {
      EXPECT_GT(points.id[p], points.id[p - 1]) << "points of a cell keep their order";
    }
  }
}

TEST(Order, RemovesPointsAndNoticesThoseOutside) {
  const auto grid = unequal<2>();
  const Window<2> window(grid.cells(), IndexBox<2>{MultiIndex<2>::Zero(), grid.cells()});
  auto body = sample<2>(box<2>(0.0, 3.0, 1), grid, true, 0, {});
  body.points.position[3] = Vec<2>(3.1, 1.0);
  body.points.position[7] = Vec<2>(1.0, std::nan(""));
  const Location found = locate(body.points, grid, window);
  EXPECT_EQ(found.outside, 2);
  std::vector<char> gone(25);
  for (std::size_t p = 0; p < gone.size(); ++p) gone[p] = body.points.cell[p] < 0;
  remove(body, gone);
  EXPECT_EQ(body.points.size(), 23);
  body.for_each_field(
      [](std::string_view, const auto& field) { EXPECT_TRUE(field.empty() || field.size() == 23); });
  for (const auto id : body.points.id) EXPECT_TRUE(id != 3 && id != 7);
}

}  // namespace
}  // namespace wisp
