// Numbering of the unknowns of a linear system.
#pragma once
#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "parallel/halo.h"

namespace wisp {

/// What becomes of unknowns with a prescribed value.
enum class FixedUnknowns {
  removed,    ///< they get no number: the system, its spectrum and its solver see free unknowns only
  unit_rows,  ///< they keep a number and a row that says x = 0: all blocks stay whole, which multigrid needs
};

/// Numbers of the unknowns (f, c), component c of grid function f. Contiguous over all ranks, rank by rank,
/// in the order of the local functions; -1 where the function is inactive or the unknown removed. Ghosts
/// carry the number of their owner. Local dense arrays hold unknown (f, c) at f * components + c and cover
/// all local functions.
class DofMap {
 public:
  DofMap() = default;

  /// `active`: n_local flags; `fixed`: n_local*components flags, or empty if none is. Both must agree on
  /// owners and ghosts. Collective.
  DofMap(const Halo& halo, int components, std::span<const char> active, std::span<const char> fixed = {},
         FixedUnknowns mode = FixedUnknowns::removed);

  int components() const { return components_; }
  int n_local() const { return components_ == 0 ? 0 : static_cast<int>(numbers_.size()) / components_; }
  MPI_Comm comm() const { return comm_; }
  bool serial() const { return serial_; }
  FixedUnknowns mode() const { return mode_; }

  /// Unknowns of this rank, their first number, and unknowns of all ranks.
  int n_owned() const { return static_cast<int>(owned_.size()); }
  int first() const { return first_; }
  int n_global() const { return n_global_; }
  /// Number of unknown (f, c) over all ranks, or -1.
  int number(int f, int c) const { return numbers_[static_cast<std::size_t>(f * components_ + c)]; }
  /// All numbers, n_local x components.
  std::span<const int> numbers() const { return numbers_; }
  /// Whether unknown (f, c) is solved for: it has a number and no prescribed value.
  bool is_free(int f, int c) const { return free_[static_cast<std::size_t>(f * components_ + c)] != 0; }
  std::span<const char> free() const { return free_; }
  /// Positions of this rank's unknowns in a local dense array, by increasing number.
  std::span<const int> owned() const { return owned_; }
  /// Same numbers and flags on this rank.
  bool operator==(const DofMap& other) const {
    return components_ == other.components_ && numbers_ == other.numbers_ && free_ == other.free_ &&
           n_global_ == other.n_global_ && first_ == other.first_;
  }

  /// Local dense array (n_local x components) to this rank's entries of a vector (n_owned); zero at
  /// prescribed unknowns.
  void gather(std::span<const double> local, std::span<double> owned) const;
  /// This rank's entries of a vector to the owned part of a local dense array; zero where there is no free
  /// unknown.
  void scatter_owned(std::span<const double> owned, std::span<double> local) const;
  /// The same, and then the ghosts. Collective.
  void scatter(std::span<const double> owned, std::span<double> local, const Halo& halo) const {
    scatter_owned(owned, local);
    halo.update(local.data(), components_);
  }

 private:
  void number_globally();

  int components_ = 0;
  int first_ = 0;
  int n_global_ = 0;
  MPI_Comm comm_ = MPI_COMM_SELF;
  bool serial_ = true;
  FixedUnknowns mode_ = FixedUnknowns::removed;
  std::vector<int> numbers_;
  std::vector<char> free_;
  std::vector<int> owned_;
};

}  // namespace wisp
