#include "parallel/halo.h"

#include <petscsf.h>

#include <map>
#include <utility>

#include "core/error.h"
#include "parallel/petsc_check.h"

namespace wisp {

/// A star forest whose roots are the owned slots and whose leaves are the ghosts, and the MPI types for
/// blocks.
class Halo::Plan {
 public:
  Plan(int n_local, std::vector<PetscInt> ghosts, std::vector<PetscSFNode> owners) {
    petsc(PetscSFCreate(Session::comm(), &forest_));
    petsc(PetscSFSetType(forest_, PETSCSFBASIC));
    petsc(PetscSFSetGraph(forest_, n_local, static_cast<PetscInt>(ghosts.size()), ghosts.data(),
                          PETSC_COPY_VALUES, owners.data(), PETSC_COPY_VALUES));
    petsc(PetscSFSetUp(forest_));
  }
  ~Plan() {
    // A halo may outlive the session (static objects, a failed run): then there is nothing left to free.
    PetscBool ended = PETSC_FALSE;
    if (PetscFinalized(&ended) != 0 || ended == PETSC_TRUE || !Session::active()) return;
    for (auto& [key, type] : blocks_) MPI_Type_free(&type);
    PetscSFDestroy(&forest_);
  }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  void reduce(void* values, MPI_Datatype scalar, int components, MPI_Op operation) {
    const MPI_Datatype unit = block(scalar, components);
    petsc(PetscSFReduceBegin(forest_, unit, values, values, operation));
    petsc(PetscSFReduceEnd(forest_, unit, values, values, operation));
  }
  void update(void* values, MPI_Datatype scalar, int components) {
    const MPI_Datatype unit = block(scalar, components);
    petsc(PetscSFBcastBegin(forest_, unit, values, values, MPI_REPLACE));
    petsc(PetscSFBcastEnd(forest_, unit, values, values, MPI_REPLACE));
  }

 private:
  /// The type of one slot, made when a count of components is first met.
  MPI_Datatype block(MPI_Datatype scalar, int components) {
    if (components == 1) return scalar;
    const auto key = std::pair(scalar == MPI_INT, components);
    const auto found = blocks_.find(key);
    if (found != blocks_.end()) return found->second;
    MPI_Datatype type = MPI_DATATYPE_NULL;
    MPI_Type_contiguous(components, scalar, &type);
    MPI_Type_commit(&type);
    return blocks_[key] = type;
  }

  PetscSF forest_ = nullptr;
  std::map<std::pair<bool, int>, MPI_Datatype> blocks_;
};

Halo::Halo(int n_local) : owned_(static_cast<std::size_t>(n_local), 1), n_owned_(n_local) {}

Halo::Halo(const std::vector<int>& owner_rank, const std::vector<int>& owner_slot)
    : owned_(owner_rank.size(), 0) {
  const int here = Session::rank();
  const int ranks = Session::size();
  std::vector<PetscInt> ghosts;
  std::vector<PetscSFNode> owners;
  std::string error;
  if (owner_rank.size() != owner_slot.size())
    error = fmt::format("halo: {} owners but {} slots were given", owner_rank.size(), owner_slot.size());
  for (std::size_t i = 0; error.empty() && i < owner_rank.size(); ++i) {
    const int rank = owner_rank[i];
    if (rank == here) {
      if (owner_slot[i] != static_cast<int>(i))
        error = fmt::format("halo: rank {} owns slot {} under the number {}", here, i, owner_slot[i]);
      owned_[i] = 1;
      ++n_owned_;
    } else if (rank >= ranks || rank < -1) {
      error =
          fmt::format("halo: slot {} of rank {} belongs to rank {}, but there are {}", i, here, rank, ranks);
    } else if (rank >= 0) {
      ghosts.push_back(static_cast<PetscInt>(i));
      owners.push_back({rank, owner_slot[i]});
    }
  }
  Session::raise_together(error);
  if (ranks > 1) plan_ = std::make_shared<Plan>(n_local(), std::move(ghosts), std::move(owners));
}

MPI_Comm Halo::comm() const { return serial() ? MPI_COMM_SELF : Session::comm(); }

void Halo::add(double* values, int components) const {
  if (plan_) plan_->reduce(values, MPI_DOUBLE, components, MPI_SUM);
}
void Halo::add(int* values, int components) const {
  if (plan_) plan_->reduce(values, MPI_INT, components, MPI_SUM);
}
void Halo::update(double* values, int components) const {
  if (plan_) plan_->update(values, MPI_DOUBLE, components);
}
void Halo::update(int* values, int components) const {
  if (plan_) plan_->update(values, MPI_INT, components);
}
void Halo::add_update(double* values, int components) const {
  add(values, components);
  update(values, components);
}
void Halo::add_update(int* values, int components) const {
  add(values, components);
  update(values, components);
}
void Halo::bit_or(int* values, int components) const {
  if (plan_) plan_->reduce(values, MPI_INT, components, MPI_BOR);
  update(values, components);
}
void Halo::min(double* values, int components) const {
  if (plan_) plan_->reduce(values, MPI_DOUBLE, components, MPI_MIN);
  update(values, components);
}
void Halo::max(double* values, int components) const {
  if (plan_) plan_->reduce(values, MPI_DOUBLE, components, MPI_MAX);
  update(values, components);
}

namespace {

template <int dim>
std::vector<Window<dim>> windows_of_all(const BoxPartition<dim>& partition, int margin) {
  std::vector<Window<dim>> result;
  result.reserve(static_cast<std::size_t>(partition.n_parts()));
  for (int part = 0; part < partition.n_parts(); ++part) result.emplace_back(partition, part, margin);
  return result;
}

}  // namespace

template <int dim>
Halo make_node_halo(const BoxPartition<dim>& partition, const Window<dim>& window, int degree) {
  const IndexBox<dim> all{MultiIndex<dim>::Zero(),
                          partition.n_cells() + MultiIndex<dim>::Constant(degree).eval()};
  const std::vector<Window<dim>> windows = windows_of_all(partition, window.margin());
  std::vector<int> ranks, slots;
  for_each_in(window.nodes(), [&](const MultiIndex<dim>& node) {
    const int owner = all.contains(node) ? partition.owner_of_node(node) : -1;
    ranks.push_back(owner);
    slots.push_back(owner < 0 ? -1 : windows[static_cast<std::size_t>(owner)].node_index(node));
  });
  return Halo(ranks, slots);
}

template <int dim>
Halo make_cell_halo(const BoxPartition<dim>& partition, const Window<dim>& window) {
  const std::vector<Window<dim>> windows = windows_of_all(partition, window.margin());
  std::vector<int> ranks, slots;
  for_each_in(window.cells(), [&](const MultiIndex<dim>& cell) {
    const int owner = window.cell_in_grid(cell) ? partition.owner_of_cell(cell) : -1;
    ranks.push_back(owner);
    slots.push_back(owner < 0 ? -1 : windows[static_cast<std::size_t>(owner)].cell_index(cell));
  });
  return Halo(ranks, slots);
}

template Halo make_node_halo(const BoxPartition<1>&, const Window<1>&, int);
template Halo make_node_halo(const BoxPartition<2>&, const Window<2>&, int);
template Halo make_node_halo(const BoxPartition<3>&, const Window<3>&, int);
template Halo make_cell_halo(const BoxPartition<1>&, const Window<1>&);
template Halo make_cell_halo(const BoxPartition<2>&, const Window<2>&);
template Halo make_cell_halo(const BoxPartition<3>&, const Window<3>&);

}  // namespace wisp
