#include "parallel/session.h"

#include <gtest/gtest.h>
#include <petscvec.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "parallel/petsc_check.h"

namespace wisp {
namespace {

TEST(Session, ReducesOverRanks) {
  const int n = Session::size();
  const int r = Session::rank();
  EXPECT_EQ(Session::sum(r + 1), n * (n + 1) / 2);
  EXPECT_EQ(Session::max(static_cast<std::int64_t>(r)), n - 1);
  EXPECT_DOUBLE_EQ(Session::min(1.5 - r), 2.5 - n);
  EXPECT_EQ(Session::sum_below(r + 1), r * (r + 1) / 2);
  EXPECT_EQ(Session::any_of(r == n - 1), true);
  EXPECT_EQ(Session::all_of(r == 0), n == 1);
  EXPECT_EQ(Session::sum(Eigen::Vector2d(1.0, r)), Eigen::Vector2d(n, n * (n - 1) / 2));
  EXPECT_EQ(Session::min(Eigen::Vector2i(r, -r)), Eigen::Vector2i(0, 1 - n));
  std::vector<int> values{1, r};
  Session::sum_in_place(values);
  EXPECT_EQ(values, (std::vector<int>{n, n * (n - 1) / 2}));
}

TEST(Session, GathersAndBroadcasts) {
  const int n = Session::size();
  const int r = Session::rank();
  const std::vector<double> all = Session::all_gather(0.5 * r);
  ASSERT_EQ(static_cast<int>(all.size()), n);
  for (int i = 0; i < n; ++i) EXPECT_EQ(all[static_cast<std::size_t>(i)], 0.5 * i);

  // Rank r gives r values r, so rank 0 gives none unless it is alone.
  const std::vector<int> list = Session::gather(std::vector<int>(static_cast<std::size_t>(r), r));
  if (r == 0) {
    std::vector<int> expected;
    for (int i = 0; i < n; ++i) expected.insert(expected.end(), static_cast<std::size_t>(i), i);
    EXPECT_EQ(list, expected);
  } else {
    EXPECT_TRUE(list.empty());
  }

  const std::vector<std::string> texts =
      Session::gather(std::string(static_cast<std::size_t>(r), 'x') + "end");
  EXPECT_EQ(texts.size(), r == 0 ? static_cast<std::size_t>(n) : 0U);
  for (std::size_t i = 0; i < texts.size(); ++i) EXPECT_EQ(texts[i], std::string(i, 'x') + "end");

  EXPECT_EQ(Session::broadcast(std::string("from ") + std::to_string(r), n - 1),
            "from " + std::to_string(n - 1));
  EXPECT_EQ(Session::broadcast(std::string()), "");
  EXPECT_EQ(Session::broadcast(10 + r), 10);
}

TEST(Session, AnErrorOfOneRankIsRaisedOnAll) {
  EXPECT_NO_THROW(Session::raise_together(""));
  const int last = Session::size() - 1;
  try {
    Session::raise_together(Session::rank() == last ? "points lost: 7, 9" : "");
    FAIL() << "nothing was thrown";
  } catch (const RunError& error) {
    EXPECT_STREQ(error.what(), "points lost: 7, 9");
  }
}

TEST(Session, PetscErrorsBecomeExceptionsOfOneLine) {
  Vec v = nullptr;
  petsc(VecCreateSeq(PETSC_COMM_SELF, 3, &v));
  try {
    // Its sizes are set already.
    petsc(VecSetSizes(v, 5, 5));
    FAIL() << "nothing was thrown";
  } catch (const RunError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.rfind("PETSc: ", 0), 0U) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_NE(text.find("Vec"), std::string::npos) << text;
  }
  petsc(VecDestroy(&v));
}

TEST(Session, KnowsWhetherAllRanksFailed) {
  // The environment tells one rank to fail alone while the others wait for it: its session must end them all.
  Session session;
  const char* alone = std::getenv("WISP_FAIL_ALONE_ON_RANK");
  if (alone == nullptr) {
    EXPECT_TRUE(session.failed_together());
  } else if (std::to_string(Session::rank()) == alone) {
    std::printf("failed together: %s\n", session.failed_together() ? "yes" : "no");
    std::fflush(stdout);
  } else {
    Session::barrier();
  }
}

// Passes, unless the environment says which rank is to fail: then the launcher's exit status must tell.
TEST(Session, FailsOnTheRankItIsToldTo) {
  const char* rank = std::getenv("WISP_FAIL_ON_RANK");
  EXPECT_FALSE(rank != nullptr && std::to_string(Session::rank()) == rank);
}

}  // namespace
}  // namespace wisp
