// Runs the tests on every rank; a failure on any rank fails the program on all.
#include <gtest/gtest.h>

#include "parallel/session.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  wisp::Session session;
  if (wisp::Session::rank() != 0) {
    // One voice for what passes; failures are still told by each rank.
    auto& listeners = testing::UnitTest::GetInstance()->listeners();
    class Failures : public testing::EmptyTestEventListener {
      void OnTestPartResult(const testing::TestPartResult& result) override {
        if (result.failed())
          std::fprintf(stderr, "rank %d: %s:%d: %s\n", wisp::Session::rank(), result.file_name(),
                       result.line_number(), result.summary());
      }
    };
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new Failures);
  }
  const int failed = RUN_ALL_TESTS();
  return wisp::Session::any_of(failed != 0) ? 1 : 0;
}
