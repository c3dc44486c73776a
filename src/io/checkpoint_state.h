// Where a run stands, to and from checkpoints.
#pragma once
#include <vector>

#include "analysis/model.h"
#include "io/checkpoint.h"

namespace wisp {

/// Adds this rank's points in their order with all fields and material states, surface points of tractions,
/// the sums that go on (external work, points removed), reactions and the boxes of all ranks.
template <int dim>
void store(Model<dim>& model, Checkpoint& checkpoint);

/// Puts a model that was built from the same case where the checkpoint of this rank stood, with the same
/// bits. Collective. Errors (InputError): the checkpoint does not fit the case.
template <int dim>
void restore(const Checkpoint& checkpoint, Model<dim>& model);

/// The same from the parts of another number of ranks: the grid is split anew and every rank keeps the points
/// of its own cells, part by part. Collective.
template <int dim>
void restore_parts(const CheckpointParts& parts, Model<dim>& model);

}  // namespace wisp
