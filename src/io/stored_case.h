// The case that a checkpoint carries, so that a run can go on without the case file.
#pragma once
#include <string>
#include <vector>

#include "io/case.h"
#include "io/checkpoint.h"

namespace wisp {

/// `begun`: the case when the run began; what stands behind its overrides in `source` are changes since.
void store_case(const CaseSource& source, const CaseSource& begun, Checkpoint& checkpoint);

/// The case when the run began, which its files follow.
Case begun_case(const Checkpoint& checkpoint);

/// The case that a checkpoint belongs to, with what shall be otherwise from now on ("key=value"). InputError.
Case stored_case(const Checkpoint& checkpoint, const std::vector<std::string>& changes);

/// A run that goes on may change how it steps and solves, but nothing that its points and files came from:
/// InputError for other keys.
void check_changes(const std::vector<std::string>& changes);

}  // namespace wisp
