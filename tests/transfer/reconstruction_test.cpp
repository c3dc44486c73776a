// Forces by Gauss points of a reconstructed stress: the patch test, linear stress, sums.
#include "transfer/reconstruction.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "transfer/explicit_transfer.h"
#include "transfer/unit_grids.h"

namespace wisp {
namespace {

using namespace transfer_test;

/// sigma(x) = constant + x gradient_x + y gradient_y, in the plane.
struct StressField {
  Mat<2> constant = Mat<2>::Zero(), gradient_x = Mat<2>::Zero(), gradient_y = Mat<2>::Zero();
  Sym<2> at(const Vec<2>& x) const {
    const Mat<2> s = constant + x[0] * gradient_x + x[1] * gradient_y;
    return {s(0, 0), s(1, 1), 0.0, 0.5 * (s(0, 1) + s(1, 0))};
  }
  Vec<2> divergence() const { return gradient_x.col(0) + gradient_y.col(1); }
};

StressField linear_field() {
  StressField f;
  f.constant << 3.0, 1.0, 1.0, -2.0;
  f.gradient_x << 0.7, 0.2, 0.2, -0.4;
  f.gradient_y << -0.3, 0.5, 0.5, 1.1;
  return f;
}

/// n x n cells of side 1 with 16 points each at random; a law whose stress is the Cauchy stress.
Body<2> random_body(int n, const StressField& field) {
  Body<2> body{"body", {}, make_material<2>(AnyLaw(LinearElastic{}))};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0.01, 0.99);
  auto& states = std::get<MaterialStates<LinearElastic, 2>>(body.material).old;
  for (int c = 0; c < n * n; ++c)
    for (int k = 0; k < 16; ++k) {
      // Four in each quarter that a split into four triangles makes.
      const double u = share(random), v = share(random) * std::min(u, 1.0 - u);
      const Vec<2> local = k % 4 == 0   ? Vec<2>(u, v)
                           : k % 4 == 1 ? Vec<2>(1.0 - v, u)
                           : k % 4 == 2 ? Vec<2>(u, 1.0 - v)
                                        : Vec<2>(v, u);
      body.points.position.push_back(Vec<2>(c % n, c / n) + local);
      body.points.volume.push_back(1.0 / 16), body.points.mass.push_back(1.0);
      body.points.velocity.push_back(Vec<2>::Zero());
      body.points.deformation_gradient.push_back(Mat<2>::Identity());
      states.push_back({field.at(body.points.position.back())});
    }
  return body;
}

/// Internal forces of all functions after reconstruction.
std::vector<Vec<2>> forces(const Space<2>& space, std::vector<Body<2>> bodies) {
  for (auto& body : bodies) {
    body.points.cell.clear();
    for (const auto& x : body.points.position) {
      if (space.structured()) {
        MultiIndex<2> c;
        for (int d = 0; d < 2; ++d) c[d] = space.grid().locate_inside(d, x[d]);
        body.points.cell.push_back(space.window().cell_index(c));
      } else {
        body.points.cell.push_back(space.triangulation().locate(x));
      }
    }
  }
  std::vector<double> sums(static_cast<std::size_t>(space.n_functions() * sums_stride<2>), 0.0);
  for (const auto& body : bodies) points_to_grid<2>(space, body, Gather::force, Vec<2>::Zero(), false, sums);
  add_reconstruction<2>(space, bodies, active_cells(space, bodies), sums);
  std::vector<Vec<2>> list;
  for (int i = 0; i < space.n_functions(); ++i)
    list.emplace_back(sums[static_cast<std::size_t>(i * sums_stride<2> + 3)],
                      sums[static_cast<std::size_t>(i * sums_stride<2> + 4)]);
  return list;
}

/// Functions of vertices that lie inside the grid.
bool inside(const Space<2>& space, int i, int n) {
  const Vec<2> x = space.node_position(i);
  return x[0] > 0.9 && x[0] < n - 0.9 && x[1] > 0.9 && x[1] < n - 0.9;
}

constexpr int n = 5;

TEST(Reconstruction, OfConstantStressLeavesNoForceInside) {
  StressField field = linear_field();
  field.gradient_x.setZero(), field.gradient_y.setZero();
  for (const auto& space :
       {squares(n), triangles(n, LinearOptions{}, 4), triangles(n, PowellSabinOptions{}, 4)}) {
    const auto f = forces(*space, {random_body(n, field)});
    double points_only = 0.0;
    std::vector<double> sums(static_cast<std::size_t>(space->n_functions() * sums_stride<2>), 0.0);
    points_to_grid<2>(*space, random_body(n, field), Gather::force, Vec<2>::Zero(), false, sums);
    for (int i = 0; i < space->n_functions(); ++i)
      if (inside(*space, i, n)) {
        EXPECT_LT(f[static_cast<std::size_t>(i)].norm(), 1e-13);
        points_only = std::max(points_only, std::abs(sums[static_cast<std::size_t>(i * sums_stride<2> + 3)]));
      }
    // Equal shares of a triangle integrate the constant gradients of linear functions exactly.
    const bool constant_gradients =
        !space->structured() && space->n_functions() == space->triangulation().n_vertices();
    if (!constant_gradients) {
      EXPECT_GT(points_only, 0.05) << "which the points by themselves do not manage";
    }
  }
}

TEST(Reconstruction, IntegratesLinearStressExactlyOnSquares) {
  const auto space = squares(n);
  const auto f = forces(*space, {random_body(n, linear_field())});
  for (int i = 0; i < space->n_functions(); ++i)
    if (inside(*space, i, n)) {
      EXPECT_LT((f[static_cast<std::size_t>(i)] - linear_field().divergence()).norm(), 1e-12)
          << "the hat's area is 1";
    }
}

TEST(Reconstruction, GivesTheDivergenceTimesTheFunctionsIntegralOnTriangles) {
  StressField one, two;
  one.gradient_x(0, 0) = 1.0;                          // divergence (1, 0)
  two.gradient_y(1, 1) = 2.0, two.constant(0, 0) = 9;  // divergence (0, 2)
  for (const AnyBasisOptions& basis :
       {AnyBasisOptions(LinearOptions{}), AnyBasisOptions(PowellSabinOptions{})}) {
    const auto space = triangles(n, basis, 4);
    const auto a = forces(*space, {random_body(n, one)}), b = forces(*space, {random_body(n, two)});
    for (int i = 0; i < space->n_functions(); ++i) {
      if (!inside(*space, i, n)) continue;
      const auto k = static_cast<std::size_t>(i);
      EXPECT_GT(a[k][0], 0.0);
      EXPECT_NEAR(a[k][1], 0.0, 1e-13);
      EXPECT_NEAR(b[k][1], 2.0 * a[k][0], 1e-12);  // stresses up to 19
      EXPECT_NEAR(b[k][0], 0.0, 1e-12);
    }
  }
}

TEST(Reconstruction, KeepsTheSumOfForcesAndLeavesTheEdgeOfTheBodyToThePoints) {
  const auto space = triangles(n, PowellSabinOptions{}, 4);
  Body<2> body = random_body(n, linear_field());
  // Without the points beyond x = 3.2 the triangles there are empty, and those beside them not filled.
  auto& states = std::get<MaterialStates<LinearElastic, 2>>(body.material).old;
  Body<2> part = body;
  auto& kept_states = std::get<MaterialStates<LinearElastic, 2>>(part.material).old;
  part.points = {};
  kept_states.clear();
  for (std::size_t p = 0; p < body.points.position.size(); ++p)
    if (body.points.position[p][0] < 3.2) {
      part.points.position.push_back(body.points.position[p]), part.points.volume.push_back(1.0 / 16);
      part.points.mass.push_back(1.0), part.points.velocity.push_back(Vec<2>::Zero());
      part.points.deformation_gradient.push_back(Mat<2>::Identity());
      kept_states.push_back(states[p]);
    }
  const auto f = forces(*space, {part});
  Vec<2> sum = Vec<2>::Zero();
  for (const auto& g : f) sum += g;
  EXPECT_LT(sum.norm(), 1e-11);
  std::vector<double> sums(static_cast<std::size_t>(space->n_functions() * sums_stride<2>), 0.0);
  points_to_grid<2>(*space, part, Gather::force, Vec<2>::Zero(), false, sums);
  int same = 0, changed = 0;
  for (int i = 0; i < space->n_functions(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double difference =
        (f[k] - Vec<2>(sums[k * sums_stride<2> + 3], sums[k * sums_stride<2> + 4])).norm();
    const double x = space->node_position(i)[0];
    if (x > 3.9) same += difference < 1e-14;
    if (x < 1.9) changed += difference > 1e-6;
  }
  EXPECT_GT(same, 10);
  EXPECT_GT(changed, 10);
}

/// Velocity gradients of points: smoothed where the cell is filled, else those of the functions.
std::vector<Mat<2>> strain_gradients(const Space<2>& space, const std::vector<Body<2>>& bodies,
                                     const std::vector<double>& velocity, int* smoothed) {
  std::vector<double> given;
  smooth_gradients<2>(space, bodies, 0, active_cells(space, bodies), velocity, 2, given);
  std::vector<Mat<2>> list;
  *smoothed = 0;
  for (std::size_t p = 0; p < bodies[0].points.position.size(); ++p) {
    Mat<2> g = Mat<2>::Zero();
    std::visit(
        [&](const auto& basis) {
          basis.tabulate(bodies[0].points.position[p], Vec<2>::Zero())
              .for_each([&](int, int i, double, const Vec<2>& dphi) {
                for (int d = 0; d < 2; ++d)
                  g.row(d) += velocity[static_cast<std::size_t>(2 * i + d)] * dphi.transpose();
              });
        },
        space.basis());
    if (!std::isnan(given[4 * p])) {
      ++*smoothed;
      g << given[4 * p], given[4 * p + 1], given[4 * p + 2], given[4 * p + 3];
    }
    list.push_back(g);
  }
  return list;
}

std::vector<Body<2>> located(const Space<2>& space, Body<2> body) {
  for (const auto& x : body.points.position) {
    MultiIndex<2> c;
    for (int d = 0; d < 2; ++d) c[d] = space.structured() ? space.grid().locate_inside(d, x[d]) : 0;
    body.points.cell.push_back(space.structured() ? space.window().cell_index(c)
                                                  : space.triangulation().locate(x));
  }
  return {std::move(body)};
}

TEST(Reconstruction, StrainsPointsByWhatItsForceWorksOn) {
  // Points at the Gauss points have the moments of the cell: then force times velocity is stress times the
  // gradients that points are strained by, whatever the stress and the velocity.
  const auto space = squares(n);
  Body<2> body = random_body(n, linear_field());
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  auto& states = std::get<MaterialStates<LinearElastic, 2>>(body.material).old;
  body.points = {};
  states.clear();
  for (int c = 0; c < n * n; ++c)
    for (int k = 0; k < 4; ++k) {
      const double root = 0.5 / std::sqrt(3.0);
      body.points.position.emplace_back(c % n + 0.5 + (k % 2 ? root : -root),
                                        c / n + 0.5 + (k / 2 ? root : -root));
      body.points.volume.push_back(0.25), body.points.mass.push_back(1.0);
      body.points.velocity.push_back(Vec<2>::Zero());
      body.points.deformation_gradient.push_back(Mat<2>::Identity());
      states.push_back({Sym<2>(any(random), any(random), 0.0, any(random))});
    }
  std::vector<double> velocity(static_cast<std::size_t>(2 * space->n_functions()));
  for (double& v : velocity) v = any(random);
  const auto bodies = located(*space, body);
  int smoothed = 0;
  const auto gradients = strain_gradients(*space, bodies, velocity, &smoothed);
  EXPECT_GT(smoothed, 4 * 9 - 1);
  const auto f = forces(*space, {body});
  double power = 0.0, stored = 0.0;
  for (std::size_t i = 0; i < f.size(); ++i)
    power += f[i][0] * velocity[2 * i] + f[i][1] * velocity[2 * i + 1];
  for (std::size_t p = 0; p < gradients.size(); ++p)
    stored += 0.25 * (matrix<2>(states[p].stress).cwiseProduct(gradients[p])).sum();
  EXPECT_NEAR(power, -stored, 1e-12);
}

TEST(Reconstruction, LeavesSmoothGradientsAsTheyAre) {
  // The coefficients of v = A x are A Q with Q the functions' places.
  for (const auto& space : {squares(n), triangles(n, LinearOptions{}, 4)}) {
    Mat<2> a;
    a << 0.3, -1.2, 0.8, 0.5;
    std::vector<double> velocity;
    for (int i = 0; i < space->n_functions(); ++i) {
      const Vec<2> v = a * space->node_position(i);
      velocity.push_back(v[0]), velocity.push_back(v[1]);
    }
    int smoothed = 0;
    const auto bodies = located(*space, random_body(n, linear_field()));
    for (const Mat<2>& g : strain_gradients(*space, bodies, velocity, &smoothed))
      EXPECT_LT((g - a).norm(), 1e-12);
    EXPECT_GT(smoothed, 100);
  }
}

}  // namespace
}  // namespace wisp
