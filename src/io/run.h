// From a case to results: the stages one after the other, what they write, and going on after a stop.
#pragma once
#include <filesystem>

#include "io/case.h"

namespace wisp {

/// What a run says on the way.
enum class Talk { normal, quiet };

/// Runs a case with its results in `folder`: case.toml, scene.json, points.pvd with its states, history.csv
/// and checkpoints; results of an earlier run there are replaced. Nothing is written before the model has
/// been built. Collective. Errors: InputError for a case that cannot be run, RunError for a run that cannot
/// go on.
void run_case(const Case& c, const std::filesystem::path& folder, Talk talk = Talk::normal);

/// Goes on from the newest checkpoint in a folder. `changes` ("key=value") may alter how the run steps and
/// solves (stage, solver, stabilisation, grid.leaving, some of output), so that a run that failed can go on
/// otherwise; other keys are an InputError. Without changes, on the number of ranks that wrote it the result
/// has the same bits as that of a run that was never stopped; on another number, 1e-10 relative. Collective.
void resume_run(const std::filesystem::path& folder, const std::vector<std::string>& changes = {},
                Talk talk = Talk::normal);

}  // namespace wisp
