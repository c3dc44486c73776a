#include "verification/tables.h"

#include "verification/ghost/list.h"
#include "verification/implicit_boundary/list.h"

namespace wisp {

std::vector<VerificationTable> verification_tables() {
  auto all = ghost_tables();
  for (auto& table : implicit_boundary_tables()) all.push_back(std::move(table));
  return all;
}

}  // namespace wisp
