// Starts MPI and PETSc for all tests of this room; on several ranks only the first one prints what passes.
#include <gtest/gtest.h>

#include "parallel/session.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const wisp::Session session;
  return RUN_ALL_TESTS();
}
