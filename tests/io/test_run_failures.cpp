// What a run that cannot go on leaves behind, and how it goes on all the same.
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <sstream>

#include "core/error.h"
#include "io/checkpoint.h"
#include "io/run.h"
#include "io/run_cases.h"

namespace wisp {
namespace {
namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string complaint(const std::function<void()>& run) {
  try {
    run();
  } catch (const RunError& error) {
    return error.what();
  }
  return "no error";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::int64_t newest_step(const fs::path& folder) { return checkpoint_sets(folder).front().step; }

/// Step of the last row of the history.
std::int64_t last_row(const fs::path& folder) {
  const std::string text = text_of(folder / "history.csv");
  return std::stoll(text.substr(text.rfind('\n', text.size() - 2) + 1));
}

std::string explicit_stage(const std::string& keys) { return "[[stage]]\ntype = \"explicit\"\n" + keys; }

test::CaseText leaving(const std::string& policy) {
  return {.stages = explicit_stage("duration = 0.2\nsteps = 20\n"),
          .leaving = policy,
          .output = "frames = 2\n",
          .velocity = "[8.0, 0.0]"};
}

TEST(FailedRun, KeepsTheStateInWhichPointsHadLeft) {
  const test::TemporaryFolder folder;
  const fs::path stopped = folder.path() / "stopped", removed = folder.path() / "removed";
  const std::string error = complaint([&] { run_case(leaving("stop").read(), stopped, Talk::quiet); });
  EXPECT_TRUE(has(error, "left the grid")) << error;
  const auto step = newest_step(stopped);
  EXPECT_GT(step, 0);
  EXPECT_LT(step, 20);
  EXPECT_TRUE(has(error, fmt::format("after step {}, is kept: wisp resume {}", step, stopped.string())))
      << error;
  EXPECT_EQ(last_row(stopped), step - 1) << "the row of a step tells of the state it starts from";
  EXPECT_TRUE(fs::exists(stopped / fmt::format("points-{:06}.vtu", step)));

  // Unchanged, it stops again and loses nothing; with the other policy it ends where it would have got.
  EXPECT_TRUE(has(complaint([&] { resume_run(stopped, {}, Talk::quiet); }), "left the grid"));
  EXPECT_EQ(newest_step(stopped), step);
  resume_run(stopped, {"grid.leaving=\"remove\""}, Talk::quiet);
  resume_run(stopped, {}, Talk::quiet);  // it has ended, and its files still fit
  run_case(leaving("remove").read(), removed, Talk::quiet);
  EXPECT_EQ(last_row(stopped), 20);  // its history keeps its columns, without the count of points removed
  EXPECT_EQ(text_of(stopped / "points-000020.vtu"), text_of(removed / "points-000020.vtu"));
}

TEST(FailedRun, DivergenceIsSeenBeforeItOverflows) {
  const test::TemporaryFolder folder;
  // The second stage steps far beyond the stable step.
  test::CaseText text;
  text.stages =
      explicit_stage("duration = 0.1\nsteps = 20\n") + explicit_stage("duration = 2.0\nsteps = 90\n");
  text.output = "frames = 0\n";
  const fs::path out = folder.path() / "out";
  const std::string error = complaint([&] { run_case(text.read(), out, Talk::quiet); });
  EXPECT_TRUE(has(error, "hundred times")) << error;
  EXPECT_TRUE(has(error, "smaller dt")) << error;
  EXPECT_TRUE(has(error, "checkpoint of step 20 at t = 0.1 s: wisp resume")) << error;
  EXPECT_EQ(newest_step(out), 20);
  resume_run(out, {"stage[1].steps=400", "stage[1].damping=0.1"}, Talk::quiet);
  EXPECT_EQ(newest_step(out), 420);
  EXPECT_EQ(last_row(out), 420);
}

TEST(FailedRun, KeepsTheStateBeforeAMassThatCannotBeSolved) {
  const test::TemporaryFolder folder;
  test::CaseText text;
  text.stages = explicit_stage("duration = 0.1\nsteps = 10\n") +
                explicit_stage("duration = 0.1\nsteps = 10\nmass = \"consistent\"\n");
  text.more = "[solver]\nsolver = \"iterative\"\nmax_iterations = 1\ntolerance = 1e-12\n";
  text.output = "frames = 0\nenergies = false\n";
  const fs::path out = folder.path() / "out";
  const std::string error = complaint([&] { run_case(text.read(), out, Talk::quiet); });
  EXPECT_TRUE(has(error, "solve")) << error;
  EXPECT_TRUE(has(error, "after step 10, is kept")) << error;
  resume_run(out, {"stage[1].mass=\"lumped\""}, Talk::quiet);
  EXPECT_EQ(newest_step(out), 20);
}

TEST(FailedRun, NamesTheLastCheckpointWhereTheStepHadBegunToMove) {
  const test::TemporaryFolder folder;
  test::CaseText text = leaving("remove");
  text.more =
      "[[load]]\ntype = \"traction\"\nname = \"side\"\nbody = \"block\"\ncorner = [1.25, 0.5]\n"
      "edges = [[0.0, 0.5]]\npoints = [4]\ntraction = [0.0, 1.0]\n";
  const fs::path out = folder.path() / "out";
  text.output = "frames = 0\n";
  std::string error = complaint([&] { run_case(text.read(), out, Talk::quiet); });
  EXPECT_TRUE(has(error, "surface point left the grid")) << error;
  EXPECT_TRUE(has(error, "no state but the start is kept")) << error;
  text.output = "frames = 0\ncheckpoint_every = 2\n";
  error = complaint([&] { run_case(text.read(), out, Talk::quiet); });
  EXPECT_TRUE(has(error, fmt::format("last good state is the checkpoint of step {}", newest_step(out))))
      << error;
}

TEST(FailedRun, RefusesChangesThatItsPointsCameFrom) {
  const test::TemporaryFolder folder;
  run_case(leaving("remove").read(), folder.path() / "out", Talk::quiet);
  for (const char* change :
       {"grid.cells=[4, 4]", "body[0].material.density=1.0", "stage[0].type=\"quasi-static\""})
    EXPECT_THROW(resume_run(folder.path() / "out", {change}, Talk::quiet), InputError) << change;
}

}  // namespace
}  // namespace wisp
