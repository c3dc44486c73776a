// Starts MPI for all tests of this room; on several ranks only the first one prints.
#include <gtest/gtest.h>

#include "parallel/session.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const wisp::Session session;
  if (wisp::Session::rank() != 0) {
    auto& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
  }
  return RUN_ALL_TESTS();
}
