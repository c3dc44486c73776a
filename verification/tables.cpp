#include "verification/tables.h"

#include "verification/ghost/list.h"
#include "verification/implicit_boundary/list.h"
#include "verification/powell_sabin/dynamics.h"

namespace wisp {

std::vector<VerificationTable> verification_tables() {
  std::vector<VerificationTable> all;
  for (auto* list :
       {ghost_tables, implicit_boundary_tables, bar_tables, column_thesis_tables, near_empty_tables})
    for (auto& table : list()) all.push_back(std::move(table));
  return all;
}

}  // namespace wisp
