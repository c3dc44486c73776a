#include "verification/tables.h"

#include "verification/ghost/list.h"
#include "verification/powell_sabin/dynamics.h"

namespace wisp {

std::vector<VerificationTable> verification_tables() {
  std::vector<VerificationTable> all;
  for (auto* paper : {ghost_tables, bar_tables, column_thesis_tables, near_empty_tables})
    for (auto& table : paper()) all.push_back(std::move(table));
  return all;
}

}  // namespace wisp
