#include "verification/tables.h"

#include "verification/ghost/list.h"
#include "verification/implicit_boundary/list.h"
#include "verification/powell_sabin/dynamics.h"
#include "verification/powell_sabin/list.h"

namespace wisp {

std::vector<VerificationTable> verification_tables() {
  std::vector<VerificationTable> all;
  for (auto* paper : {ghost_tables, implicit_boundary_tables, powell_sabin_tables, bar_tables,
                      column_thesis_tables, near_empty_tables, gamma_tables})
    for (auto& table : paper()) all.push_back(std::move(table));
  return all;
}

}  // namespace wisp
