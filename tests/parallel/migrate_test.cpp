#include "parallel/migrate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "core/error.h"
#include "parallel/session.h"

namespace wisp {
namespace {

struct Cloud {
  std::vector<std::int64_t> id;
  std::vector<std::array<double, 3>> position;
  std::vector<double> stress;  // 2 a point
};

Cloud cloud_of_rank(int n, int rank) {
  Cloud cloud;
  for (int i = 0; i < n; ++i) {
    const std::int64_t id = 100000 * rank + i;
    const auto x = static_cast<double>(id);
    cloud.id.push_back(id);
    cloud.position.push_back({x, x + 0.25, -x});
    cloud.stress.insert(cloud.stress.end(), {3.0 * x, 5.0 * x});
  }
  return cloud;
}

TEST(Migration, KeepsEveryItemWithAllItsFields) {
  const int here = Session::rank();
  Cloud cloud = cloud_of_rank(400 + 37 * here, here);
  std::mt19937 random(static_cast<unsigned>(here));
  std::vector<std::int64_t> all_before = Session::gather(cloud.id);
  for (int round = 0; round < 5; ++round) {
    std::vector<int> destination;
    for (std::size_t i = 0; i < cloud.id.size(); ++i)
      destination.push_back(std::uniform_int_distribution<int>(0, Session::size() - 1)(random));
    const Migration migration(destination);
    EXPECT_EQ(migration.staying().size() + migration.leaving().size(), cloud.id.size());
    migration.move(cloud.id);
    migration.move(cloud.position);
    migration.move(cloud.stress, 2);
    ASSERT_EQ(static_cast<int>(cloud.id.size()), migration.n_after());
    ASSERT_EQ(cloud.stress.size(), 2 * cloud.id.size());
    for (std::size_t i = 0; i < cloud.id.size(); ++i) {
      const auto x = static_cast<double>(cloud.id[i]);
      ASSERT_EQ(cloud.position[i], (std::array<double, 3>{x, x + 0.25, -x}));
      ASSERT_EQ(cloud.stress[2 * i], 3.0 * x);
      ASSERT_EQ(cloud.stress[2 * i + 1], 5.0 * x);
    }
  }
  std::vector<std::int64_t> all_after = Session::gather(cloud.id);
  std::sort(all_before.begin(), all_before.end());
  std::sort(all_after.begin(), all_after.end());
  EXPECT_EQ(all_before, all_after);
}

TEST(Migration, OrdersArrivalsBySourceThenByTheirOldOrder) {
  // Everything goes to the last rank.
  const int last = Session::size() - 1;
  std::vector<int> id;
  for (int i = 0; i < 3; ++i) id.push_back(10 * Session::rank() + i);
  const Migration migration(std::vector<int>(id.size(), last));
  EXPECT_EQ(migration.n_moving(), 3 * last);
  migration.move(id);
  std::vector<int> expected;
  if (Session::rank() == last) {
    expected = {10 * last, 10 * last + 1, 10 * last + 2};  // what stays comes first
    for (int r = 0; r < last; ++r) expected.insert(expected.end(), {10 * r, 10 * r + 1, 10 * r + 2});
  }
  EXPECT_EQ(id, expected);
}

TEST(Migration, SendsRecordsOfSeveralFields) {
  struct Record {
    std::int64_t id;
    double x;
  };
  const int here = Session::rank();
  const int next = (here + 1) % Session::size();
  const std::vector<int> destination{next, here, next};
  const Migration migration(destination);
  const std::vector<std::byte> bytes =
      migration.exchange_records(sizeof(Record), [&](int item, std::byte* place) {
        const Record record{item, 0.5 * here};
        std::memcpy(place, &record, sizeof record);
      });
  ASSERT_EQ(bytes.size(), static_cast<std::size_t>(migration.n_arriving()) * sizeof(Record));
  if (Session::size() == 1) {
    EXPECT_EQ(migration.n_arriving(), 0);
    return;
  }
  ASSERT_EQ(migration.n_arriving(), 2);
  const int previous = (here + Session::size() - 1) % Session::size();
  for (std::size_t i = 0; i < 2; ++i) {
    Record record{};
    std::memcpy(&record, bytes.data() + i * sizeof record, sizeof record);
    EXPECT_EQ(record.id, i == 0 ? 0 : 2);
    EXPECT_EQ(record.x, 0.5 * previous);
  }
}

TEST(Migration, RefusesARankThatDoesNotExist) {
  // On one rank only: all must hear of it.
  const int to = Session::rank() == 0 ? Session::size() : 0;
  EXPECT_THROW(Migration(std::vector<int>{to}), RunError);
}

TEST(Imbalance, IsGreatestOverMean) {
  EXPECT_DOUBLE_EQ(imbalance(7), 1.0);
  EXPECT_DOUBLE_EQ(imbalance(0), 1.0);
  const double n = Session::size();
  EXPECT_DOUBLE_EQ(imbalance(Session::rank() == 0 ? 2 : 1), 2.0 * n / (n + 1.0));
}

}  // namespace
}  // namespace wisp
