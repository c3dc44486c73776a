#include "linear/dof_map.h"

#include <algorithm>
#include <limits>

#include "core/error.h"

namespace wisp {

DofMap::DofMap(const Halo& halo, int components, std::span<const char> active, std::span<const char> fixed,
               FixedUnknowns mode)
    : components_(components), comm_(halo.comm()), serial_(halo.serial()), mode_(mode) {
  if (components < 1 || components > 3) input_error("unknowns have 1 to 3 components, not {}", components);
  const auto n = static_cast<std::size_t>(halo.n_local());
  const auto m = static_cast<std::size_t>(components);
  if (active.size() != n || (!fixed.empty() && fixed.size() != m * n))
    run_error("the flags of {} functions have {} active and {} fixed entries", n, active.size(),
              fixed.size());
  numbers_.assign(n * m, -1);
  free_.assign(n * m, 0);
  for (std::size_t f = 0; f < n; ++f) {
    if (!active[f]) continue;
    const bool owned = halo.owns(static_cast<int>(f));
    for (std::size_t i = f * m; i < (f + 1) * m; ++i) {
      free_[i] = fixed.empty() || !fixed[i];
      if (owned && (free_[i] || mode == FixedUnknowns::unit_rows)) owned_.push_back(static_cast<int>(i));
    }
  }
  number_globally();
  halo.update(numbers_.data(), components);
}

void DofMap::number_globally() {
  std::int64_t first = 0;
  std::int64_t total = static_cast<std::int64_t>(owned_.size());
  if (!serial_) {
    const std::int64_t mine = total;
    MPI_Exscan(&mine, &first, 1, MPI_INT64_T, MPI_SUM, comm_);
    int rank = 0;
    MPI_Comm_rank(comm_, &rank);
    if (rank == 0) first = 0;  // MPI leaves the first rank's result undefined
    MPI_Allreduce(&mine, &total, 1, MPI_INT64_T, MPI_SUM, comm_);
  }
  if (total > std::numeric_limits<int>::max())
    run_error("{} unknowns are more than this build of PETSc can number (32-bit indices, at most {})", total,
              std::numeric_limits<int>::max());
  first_ = static_cast<int>(first);
  n_global_ = static_cast<int>(total);
  for (std::size_t k = 0; k < owned_.size(); ++k)
    numbers_[static_cast<std::size_t>(owned_[k])] = first_ + static_cast<int>(k);
}

void DofMap::gather(std::span<const double> local, std::span<double> owned) const {
  for (std::size_t k = 0; k < owned_.size(); ++k) {
    const auto i = static_cast<std::size_t>(owned_[k]);
    owned[k] = free_[i] ? local[i] : 0.0;
  }
}

void DofMap::scatter_owned(std::span<const double> owned, std::span<double> local) const {
  std::fill(local.begin(), local.end(), 0.0);
  for (std::size_t k = 0; k < owned_.size(); ++k) {
    const auto i = static_cast<std::size_t>(owned_[k]);
    if (free_[i]) local[i] = owned[k];
  }
}

}  // namespace wisp
