// From blocks between local functions to the distributed matrix that PETSc solves with.
#pragma once
#include <cstdint>
#include <vector>

#include "core/error.h"
#include "linear/block_matrix.h"
#include "linear/dof_map.h"
#include "linear/petsc.h"

namespace wisp {

/// The assembled matrix of a problem in PETSc's compressed rows (AIJ), over the unknowns of a DofMap.
/// Prescribed unknowns lose their row and column (or keep a unit row, scaled like the other diagonals). The
/// structure is kept while the pattern and the numbering stay the same; then only values are copied.
class SystemMatrix {
 public:
  /// Sums the contributions of all ranks. A scalar matrix serves `dofs` with several components as M ⊗ I.
  /// Every numbered unknown gets a diagonal entry, zero if nothing contributes to it. Collective.
  void assign(const BlockMatrix& local, const DofMap& dofs);

  ::Mat mat() const { return mat_.get(); }
  /// Whether the values last assigned are symmetric up to the rounding of their assembly
  /// (BlockMatrix::symmetric), on all ranks.
  bool symmetric() const { return symmetric_; }
  /// Changes whenever the PETSc matrix is a new object.
  std::int64_t structure() const { return structure_; }

 private:
  void make_structure(const BlockMatrix& local, const DofMap& dofs);
  void make_serial();
  void make_distributed();
  void copy_values(const BlockMatrix& local);

  OwnedMat mat_;
  DofMap dofs_;
  std::int64_t structure_ = 0;
  std::int64_t pattern_id_ = 0;
  int block_ = 0;
  bool symmetric_ = false;
  // Entry k takes value sources_[k] of the block matrix; -1: zero, -2: one (unit row).
  std::vector<PetscInt> rows_;
  std::vector<PetscInt> columns_;
  std::vector<int> sources_;
  std::vector<double> values_;
  std::vector<PetscInt> starts_;
};

}  // namespace wisp
