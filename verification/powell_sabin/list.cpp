#include "verification/powell_sabin/list.h"

namespace wisp {

std::vector<VerificationTable> powell_sabin_tables() {
  std::vector<VerificationTable> all;
  for (auto* list : {projection_tables, spline_pictures})
    for (auto& table : list()) all.push_back(std::move(table));
  return all;
}

}  // namespace wisp
