#include "verification/implicit_boundary/list.h"

namespace wisp {

std::vector<VerificationTable> implicit_boundary_tables() {
  std::vector<VerificationTable> all;
  for (auto* list :
       {contained_block_tables, deep_beam_tables, simple_shear_tables, cantilever_tables, penetration_tables,
        clamped_tables, triangle_wall_tables, spatial_tables, explicit_wall_tables})
    for (auto& table : list()) all.push_back(std::move(table));
  return all;
}

}  // namespace wisp
