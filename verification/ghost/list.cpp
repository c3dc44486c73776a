#include "verification/ghost/list.h"

#include <iterator>

namespace wisp {

std::vector<VerificationTable> ghost_tables() {
  std::vector<VerificationTable> all;
  for (auto* list :
       {block_tables, translation_tables, stretching_tables, collision_tables, column_tables, beam_tables})
    for (auto& table : list()) all.push_back(std::move(table));
  return all;
}

}  // namespace wisp
