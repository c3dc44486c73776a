// Exchange of values between the ranks that share slots (nodes, cells, functions) of an array.
#pragma once
#include <mpi.h>

#include <memory>
#include <vector>

#include "parallel/box_partition.h"
#include "parallel/window.h"

namespace wisp {

/// Who owns each local slot of an array, and the exchange between owners and the copies ("ghosts") on other
/// ranks.
///
/// Arrays have `components` values a slot, slot by slot: `values[slot * components + component]`, and
/// `n_local() * components` in all. Every call is collective and works in place. Contributions are summed in
/// the order of the ranks, so that a repeated run gives the same bits. On one rank every call returns at
/// once. A halo can be copied cheaply; copies share one communication plan. Built on PETSc's star forest
/// (PetscSF).
class Halo {
 public:
  /// No slots.
  Halo() : Halo(0) {}
  /// All slots are this rank's own: for one rank, or for arrays that nobody shares.
  explicit Halo(int n_local);
  /// Collective. For each local slot the rank that owns it and its number there; a slot that this rank owns
  /// has its own rank and number; a slot that nobody owns (a phantom) has rank -1 and is never exchanged.
  /// @throws RunError if the lists differ in length, a rank does not exist, or a slot claims to be this
  /// rank's own under another number
  Halo(const std::vector<int>& owner_rank, const std::vector<int>& owner_slot);

  [[nodiscard]] int n_local() const { return static_cast<int>(owned_.size()); }
  [[nodiscard]] int n_owned() const { return n_owned_; }
  /// False for ghosts and phantoms.
  [[nodiscard]] bool owns(int slot) const { return owned_[static_cast<std::size_t>(slot)] != 0; }
  /// True if no call communicates.
  [[nodiscard]] bool serial() const { return plan_ == nullptr; }
  [[nodiscard]] MPI_Comm comm() const;

  /// Owner += its ghosts. Ghosts keep their contributions, which are stale from now on.
  void add(double* values, int components = 1) const;
  void add(int* values, int components = 1) const;
  /// Ghosts = owner.
  void update(double* values, int components = 1) const;
  void update(int* values, int components = 1) const;
  /// Both: afterwards owner and ghosts hold the sum.
  void add_update(double* values, int components = 1) const;
  void add_update(int* values, int components = 1) const;
  /// Owner and ghosts get the bitwise or of all copies: flags.
  void bit_or(int* values, int components = 1) const;
  /// Owner and ghosts get the least or the greatest of all copies.
  void min(double* values, int components = 1) const;
  void max(double* values, int components = 1) const;

 private:
  class Plan;
  std::shared_ptr<Plan> plan_;  // none on one rank
  std::vector<char> owned_;
  int n_owned_ = 0;
};

/// The halo of the nodes, or of the cells, of this rank's window (which must be that of `partition` for this
/// rank). Owners' numbers follow from their boxes, so only PETSc's own set-up communicates. Collective.
/// @param degree   of `make_node_halo`: functions of that degree are numbered like nodes, degree more than
///                 cells in each direction; at most the margin of the window
template <int dim>
[[nodiscard]] Halo make_node_halo(const BoxPartition<dim>& partition, const Window<dim>& window,
                                  int degree = 1);
template <int dim>
[[nodiscard]] Halo make_cell_halo(const BoxPartition<dim>& partition, const Window<dim>& window);

}  // namespace wisp
