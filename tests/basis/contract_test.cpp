// What every basis promises: partition of unity, linear reproduction, gradients, signs, edges of the grid.
#include <gtest/gtest.h>

#include "basis/samples.h"

namespace wisp {
namespace {

using namespace basis_test;

template <class Basis>
struct DimensionOf;
template <int dim>
struct DimensionOf<Linear<dim>> {
  static constexpr int value = dim;
};
template <int dim, int width>
struct DimensionOf<Gimp<dim, width>> {
  static constexpr int value = dim;
};
template <int dim, int degree>
struct DimensionOf<BSpline<dim, degree>> {
  static constexpr int value = dim;
};

template <class Basis>
AnyBasisOptions options_of() {
  if (Basis::uses_domains) return GimpOptions{};
  BSplineOptions splines;
  splines.degree = Basis::degree;
  return Basis::degree == 1 ? AnyBasisOptions(LinearOptions{}) : AnyBasisOptions(splines);
}

/// Sanitizers make a sample a hundred times as dear; every seventh reads and writes the same places.
#ifdef __SANITIZE_ADDRESS__
constexpr std::size_t every_sample = 7;
#else
constexpr std::size_t every_sample = 1;
#endif

template <class Basis_>
struct BasisContract : testing::Test {
  using Basis = Basis_;
  static constexpr int dimension = DimensionOf<Basis>::value;

  /// Calls f(space, basis, x, l) for every combination of the samples.
  template <class F>
  void for_each_sample(F&& f) {
    constexpr int dim = dimension;
    for (const auto& grid : {equal_grid<dim>(), unequal_grid<dim>()}) {
      const Space<dim> space(grid, BoxPartition<dim>(grid.cells()), options_of<Basis>());
      const Basis basis(space.grid(), NodeNumbering<dim>(space.window()));
      const auto lengths = half_lengths(Basis::width, grid.shortest_side());
      const auto points = positions(grid, dim == 2 ? 60 : 20);
      std::size_t sample = 0;
      for (std::size_t k = 0; k < points.size(); ++k)
        for (std::size_t m = 0; m < (Basis::uses_domains ? lengths.size() : 1); ++m) {
          if (sample++ % every_sample != 0) continue;
          Vec<dim> l;
          for (int d = 0; d < dim; ++d)
            l[d] = lengths[(m + static_cast<std::size_t>(d) * (k % 3)) % lengths.size()];
          f(space, basis, points[k], l);
          if (testing::Test::HasFailure()) return;
        }
    }
  }
};

using Bases = testing::Types<Linear<2>, Linear<3>, Gimp<2, 3>, Gimp<3, 3>, Gimp<2, 5>, Gimp<3, 5>,
                             BSpline<2, 2>, BSpline<2, 3>, BSpline<2, highest_spline_degree(2)>,
                             BSpline<3, 2>, BSpline<3, highest_spline_degree(3)>>;
TYPED_TEST_SUITE(BasisContract, Bases);

TYPED_TEST(BasisContract, SumsToOneOnFunctionsOfTheGridOnly) {
  constexpr int dim = TestFixture::dimension;
  this->for_each_sample([](const auto& space, const auto& basis, const auto& x, const auto& l) {
    const auto e = evaluate<dim>(space, basis, x, l);
    double sum = 0.0;
    Vec<dim> gradient = Vec<dim>::Zero();
    for (int i = 0; i < space.n_functions(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (!space.grid_functions().contains(space.window().node_multi_index(i))) {
        ASSERT_EQ(e.phi[k], 0.0);
        ASSERT_EQ(e.dphi[k], Vec<dim>::Zero());
      }
      ASSERT_GE(e.phi[k], TypeParam::non_negative ? -1e-15 : -1.0);
      sum += e.phi[k], gradient += e.dphi[k];
    }
    EXPECT_NEAR(sum, 1.0, 4e-15);
    EXPECT_LT(gradient.norm() * space.grid().shortest_side(), 1e-14);
  });
}

TYPED_TEST(BasisContract, ReproducesLinearFieldsWhereTheDomainIsInside) {
  constexpr int dim = TestFixture::dimension;
  this->for_each_sample([](const auto& space, const auto& basis, const auto& x, const auto& l) {
    const Vec<dim> reach = TypeParam::uses_domains ? l : Vec<dim>::Zero().eval();
    if (((x - reach).array() < space.grid().lower().array()).any() ||
        ((x + reach).array() > space.grid().upper().array()).any())
      return;
    const auto e = evaluate<dim>(space, basis, x, l);
    Vec<dim> position = Vec<dim>::Zero();
    Mat<dim> gradient = Mat<dim>::Zero();
    for (int i = 0; i < space.n_functions(); ++i) {
      position += e.phi[static_cast<std::size_t>(i)] * space.node_position(i);
      gradient += space.node_position(i) * e.dphi[static_cast<std::size_t>(i)].transpose();
    }
    // Overlaps below 1e-12 of a cell count as touching: that is how exact the position can be.
    EXPECT_LT((position - x).norm(), 3e-12 * space.grid().shortest_side())
        << x.transpose() << " l " << l.transpose();
    EXPECT_LT((gradient - Mat<dim>::Identity()).norm(), 1e-13);
  });
}

TYPED_TEST(BasisContract, GradientsAreTheDerivativesOfTheValues) {
  constexpr int dim = TestFixture::dimension;
  this->for_each_sample([](const auto& space, const auto& basis, const auto& x, const auto& l) {
    const auto& grid = space.grid();
    const double step = 1e-7 * grid.shortest_side();
    if (TypeParam::uses_domains && l.minCoeff() < 1e-2 * grid.shortest_side()) return;  // as rough as linear
    for (int d = 0; d < dim; ++d) {
      Vec<dim> up = x, down = x;
      up[d] += step, down[d] -= step;
      if (grid.locate_inside(d, up[d]) >= grid.cells(d) || grid.locate_inside(d, down[d]) < 0) return;
      if (!TypeParam::uses_domains && grid.locate(d, up[d]) != grid.locate(d, down[d])) return;
    }
    const auto here = evaluate<dim>(space, basis, x, l);
    for (int d = 0; d < dim; ++d) {
      Vec<dim> up = x, down = x;
      up[d] += step, down[d] -= step;
      const auto above = evaluate<dim>(space, basis, up, l), below = evaluate<dim>(space, basis, down, l);
      for (std::size_t i = 0; i < here.phi.size(); ++i)
        ASSERT_NEAR((above.phi[i] - below.phi[i]) / (up[d] - down[d]), here.dphi[i][d],
                    2e-5 / grid.shortest_side())
            << "at " << x.transpose() << " l " << l.transpose();
    }
  });
}

TYPED_TEST(BasisContract, StoredSetsHaveTheirKey) {
  // Equal keys promise equal functions in the same order; the key must also be a local function's index.
  constexpr int dim = TestFixture::dimension;
  std::vector<std::vector<int>> functions;
  this->for_each_sample([&](const auto& space, const auto& basis, const auto& x, const auto& l) {
    functions.resize(static_cast<std::size_t>(space.n_functions()));
    const auto stencil = basis.tabulate(x, l);
    ASSERT_GE(stencil.key(), 0);
    ASSERT_LT(stencil.key(), space.n_functions());
    std::vector<int> list;
    stencil.for_each([&](int k, int i, double, const Vec<dim>&) {
      ASSERT_EQ(k, static_cast<int>(list.size()));
      ASSERT_GE(i, 0);
      ASSERT_LT(i, space.n_functions());
      list.push_back(i);
    });
    auto& known = functions[static_cast<std::size_t>(stencil.key())];
    if (known.empty()) known = list;
    EXPECT_EQ(known, list);
  });
}

}  // namespace
}  // namespace wisp
