#include "parallel/halo.h"

#include <gtest/gtest.h>

#include <random>

#include "core/error.h"

namespace wisp {
namespace {

template <int dim>
BoxPartition<dim> lopsided_partition(const MultiIndex<dim>& n_cells) {
  std::mt19937 random(11);
  std::vector<MultiIndex<dim>> points;
  for (int p = 0; p < 3000; ++p) {
    MultiIndex<dim> cell;
    for (int d = 0; d < dim; ++d) {
      const double x = std::uniform_real_distribution<double>(0.0, 1.0)(random);
      cell[d] = static_cast<int>(x * x * n_cells[d]);
    }
    if (p % Session::size() == Session::rank()) points.push_back(cell);
  }
  return BoxPartition<dim>(n_cells, points);
}

/// A number that differs between slots, components and (unless rank is 0 everywhere) contributing ranks.
template <int dim>
int mark(const MultiIndex<dim>& index, int component, int rank) {
  int result = 0;
  for (int d = 0; d < dim; ++d) result = 31 * result + index[d];
  return 1 + result * 7 + component + 1000 * rank;
}

template <int dim>
struct Slots {
  BoxPartition<dim> partition;
  Window<dim> window;
  bool nodes;  // otherwise cells
  Halo halo;

  Slots(const MultiIndex<dim>& n_cells, bool of_nodes)
      : partition(lopsided_partition<dim>(n_cells)),
        window(partition),
        nodes(of_nodes),
        halo(of_nodes ? make_node_halo(partition, window) : make_cell_halo(partition, window)) {}
  [[nodiscard]] const IndexBox<dim>& box(const Window<dim>& w) const { return nodes ? w.nodes() : w.cells(); }
  [[nodiscard]] bool in_grid(const MultiIndex<dim>& i) const {
    return nodes ? window.node_in_grid(i) : window.cell_in_grid(i);
  }
  [[nodiscard]] int owner(const MultiIndex<dim>& i) const {
    return nodes ? partition.owner_of_node(i) : partition.owner_of_cell(i);
  }
  [[nodiscard]] int slot(const MultiIndex<dim>& i) const {
    return nodes ? window.node_index(i) : window.cell_index(i);
  }
  /// What every rank that sees slot i gives, summed as one rank would that sees everything.
  [[nodiscard]] int whole_sum(const MultiIndex<dim>& i, int component) const {
    int sum = 0;
    for (int r = 0; r < Session::size(); ++r)
      if (box(Window<dim>(partition, r)).contains(i)) sum += mark<dim>(i, component, r);
    return sum;
  }
  template <class T>
  [[nodiscard]] std::vector<T> marks(int components) const {
    std::vector<T> result;
    for_each_in(box(window), [&](const MultiIndex<dim>& i) {
      for (int c = 0; c < components; ++c) result.push_back(static_cast<T>(mark<dim>(i, c, Session::rank())));
    });
    return result;
  }
};

template <int dim, class T>
void check_sums(const Slots<dim>& s) {
  for (const int components : {1, 2, 3, 5, 9}) {
    std::vector<T> values = s.template marks<T>(components);
    const std::vector<T> before = values;
    s.halo.add(values.data(), components);
    for_each_in(s.box(s.window), [&](const MultiIndex<dim>& i) {
      for (int c = 0; c < components; ++c) {
        const auto k = static_cast<std::size_t>(s.slot(i) * components + c);
        const T expected = s.halo.owns(s.slot(i)) ? static_cast<T>(s.whole_sum(i, c)) : before[k];
        ASSERT_EQ(values[k], expected) << i.transpose() << " component " << c;
      }
    });
    s.halo.update(values.data(), components);
    for_each_in(s.box(s.window), [&](const MultiIndex<dim>& i) {
      for (int c = 0; c < components; ++c) {
        const auto k = static_cast<std::size_t>(s.slot(i) * components + c);
        ASSERT_EQ(values[k], s.in_grid(i) ? static_cast<T>(s.whole_sum(i, c)) : before[k]);
      }
    });
    std::vector<T> at_once = before;
    s.halo.add_update(at_once.data(), components);
    ASSERT_EQ(at_once, values);
  }
}

template <int dim>
void check(const MultiIndex<dim>& n_cells) {
  for (const bool nodes : {true, false}) {
    const Slots<dim> s(n_cells, nodes);
    ASSERT_EQ(s.halo.n_local(), static_cast<int>(s.box(s.window).count()));
    ASSERT_EQ(s.halo.serial(), Session::size() == 1);
    std::int64_t owned = 0;
    for_each_in(s.box(s.window), [&](const MultiIndex<dim>& i) {
      const bool mine = s.in_grid(i) && s.owner(i) == Session::rank();
      ASSERT_EQ(s.halo.owns(s.slot(i)), mine) << i.transpose();
      ASSERT_EQ(nodes ? s.window.owns_node(i) : s.window.owns_cell(i), mine);
      owned += mine ? 1 : 0;
    });
    ASSERT_EQ(s.halo.n_owned(), owned);
    const IndexBox<dim>& grid = nodes ? s.window.grid_nodes() : s.window.grid_cells();
    ASSERT_EQ(Session::sum(owned), grid.count());
    check_sums<dim, double>(s);
    check_sums<dim, int>(s);
  }
}

TEST(Halo, SumsAndUpdatesAgreeWithASerialReference) {
  check<1>(MultiIndex<1>(23));
  check<2>(MultiIndex<2>(17, 12));
  check<3>(MultiIndex<3>(9, 8, 7));
}

TEST(Halo, WorksWhereBoxesAreThinnerThanTheirMargins) {
  check<1>(MultiIndex<1>(4));
  check<2>(MultiIndex<2>(2, 2));
}

TEST(Halo, JoinsFlagsAndFindsExtremes) {
  const Slots<2> s(MultiIndex<2>(12, 10), true);
  std::vector<int> flags(static_cast<std::size_t>(s.halo.n_local()), 1 << Session::rank());
  std::vector<double> least(flags.size(), Session::rank());
  std::vector<double> greatest = least;
  s.halo.bit_or(flags.data());
  s.halo.min(least.data());
  s.halo.max(greatest.data());
  for_each_in(s.window.nodes(), [&](const MultiIndex<2>& i) {
    const auto k = static_cast<std::size_t>(s.slot(i));
    int all = 0, first = Session::size(), last = -1;
    for (int r = 0; r < Session::size(); ++r)
      if (Window<2>(s.partition, r).contains_node(i)) {
        all |= 1 << r;
        first = std::min(first, r);
        last = r;
      }
    if (!s.in_grid(i)) {
      all = 1 << Session::rank();
      first = last = Session::rank();
    }
    ASSERT_EQ(flags[k], all) << i.transpose();
    ASSERT_EQ(least[k], first);
    ASSERT_EQ(greatest[k], last);
  });
}

TEST(Halo, SumsInTheSameOrderEachTime) {
  // Values whose sum depends on the order in its last bits.
  const Slots<2> s(MultiIndex<2>(8, 8), true);
  std::mt19937 random(static_cast<unsigned>(5 + Session::rank()));
  std::vector<double> start(static_cast<std::size_t>(s.halo.n_local()) * 2);
  for (double& v : start) v = std::exp(std::uniform_real_distribution<double>(-20.0, 20.0)(random));
  std::vector<double> first = start;
  s.halo.add_update(first.data(), 2);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Slots<2> again(MultiIndex<2>(8, 8), true);
    std::vector<double> values = start;
    again.halo.add_update(values.data(), 2);
    ASSERT_EQ(values, first);
  }
}

TEST(Halo, TakesAnyNumbering) {
  // A ring: each rank owns slots 0..2 and sees slot 1 of the next rank as its slot 4; slot 3 is a phantom.
  const int here = Session::rank();
  const int next = (here + 1) % Session::size();
  const Halo ring({here, here, here, -1, next == here ? -1 : next}, {0, 1, 2, -1, 1});
  EXPECT_EQ(ring.n_owned(), 3);
  EXPECT_FALSE(ring.owns(3));
  std::vector<double> values{1.0, 2.0, 3.0, 4.0, 10.0 + here};
  ring.add(values.data());
  const int previous = (here + Session::size() - 1) % Session::size();
  const bool alone = Session::size() == 1;
  EXPECT_EQ(values, (std::vector<double>{1.0, alone ? 2.0 : 12.0 + previous, 3.0, 4.0, 10.0 + here}));
  const Halo copy = ring;  // NOLINT: copies share the plan
  copy.update(values.data());
  EXPECT_EQ(values[4], alone ? 10.0 : 12.0 + here);
}

TEST(Halo, RefusesRanksAndNumbersThatDoNotExist) {
  EXPECT_THROW(Halo({Session::size()}, {0}), RunError);
  EXPECT_THROW(Halo({Session::rank()}, {1}), RunError);
  EXPECT_THROW(Halo({Session::rank()}, {}), RunError);
}

TEST(Halo, IsSerialWithoutOwners) {
  const Halo halo(4);
  EXPECT_TRUE(halo.serial());
  EXPECT_EQ(halo.n_owned(), 4);
  EXPECT_TRUE(halo.owns(3));
  std::vector<double> values{1.0, 2.0, 3.0, 4.0};
  halo.add_update(values.data());
  EXPECT_EQ(values, (std::vector<double>{1.0, 2.0, 3.0, 4.0}));
}

}  // namespace
}  // namespace wisp
