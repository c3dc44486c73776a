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
  EXPECT_EQ(newest_step(out), 0);
  text.output = "frames = 0\ncheckpoint_every = 2\n";
  error = complaint([&] { run_case(text.read(), out, Talk::quiet); });
  EXPECT_TRUE(has(error, fmt::format("last good state is the checkpoint of step {}", newest_step(out))))
      << error;
}

/// Every state that points.pvd names is there, and the last one is that of `step`.
void expect_readable(const fs::path& folder, std::int64_t step) {
  const std::string series = text_of(folder / "points.pvd");
  EXPECT_TRUE(has(series, "</VTKFile>")) << series;
  std::string last;
  for (std::size_t at = series.find("file=\""); at != std::string::npos;
       at = series.find("file=\"", at + 1)) {
    last = series.substr(at + 6, series.find('"', at + 6) - at - 6);
    EXPECT_TRUE(has(text_of(folder / last), "</VTKFile>")) << last;
  }
  EXPECT_EQ(last, fmt::format("points-{:06}.vtu", step));
}

/// What an explicit run says whose second step is hundreds of times the critical one, in each scheme; and
/// that it goes on from what was kept, with a smaller step, to where it gets from the beginning.
void fail_above_the_critical_step(const std::string& scheme) {
  const test::TemporaryFolder folder;
  const fs::path out = folder.path() / "out", whole = folder.path() / "whole";
  test::CaseText text;
  text.stages = explicit_stage("duration = 20.0\nsteps = 400\nstress_update = \"" + scheme + "\"\n");
  text.output = "frames = 2\nenergies = false\nhistory_every = 1000\n";
  const std::string error = complaint([&] { run_case(text.read(), out, Talk::quiet); });
  EXPECT_TRUE(has(error, "step ") && has(error, "smaller dt or cfl") && has(error, "wisp resume")) << error;
  EXPECT_EQ(newest_step(out), 0) << error;
  expect_readable(out, 0);
  resume_run(out, {"stage[0].duration=0.02", "stage[0].steps=4"}, Talk::quiet);
  EXPECT_EQ(newest_step(out), 4);
  expect_readable(out, 4);
  text.stages = explicit_stage("duration = 0.02\nsteps = 4\nstress_update = \"" + scheme + "\"\n");
  run_case(text.read(), whole, Talk::quiet);
  EXPECT_EQ(text_of(out / "points-000004.vtu"), text_of(whole / "points-000004.vtu"));
  EXPECT_EQ(text_of(out / "history.csv"), text_of(whole / "history.csv"));
}

TEST(FailedRun, StepAboveTheCriticalOneStressFirst) { fail_above_the_critical_step("usf"); }
TEST(FailedRun, StepAboveTheCriticalOneStressLast) { fail_above_the_critical_step("usl"); }
TEST(FailedRun, StepAboveTheCriticalOneModifiedStressLast) { fail_above_the_critical_step("musl"); }

test::CaseText with_gravity(const std::string& factor, const std::string& stage) {
  test::CaseText text;
  text.stages = "factor = " + factor + "\n" + stage;  // the table of gravity comes before the stages
  text.output = "frames = 2\n";
  return text;
}

TEST(FailedRun, HugeForceThatOverflows) {
  const test::TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  const auto run = with_gravity("[[0.0, 1.0], [0.05, 1.0], [0.051, 1e300]]",
                                explicit_stage("duration = 0.1\nsteps = 100\n"));
  const std::string error = complaint([&] { run_case(run.read(), out, Talk::quiet); });
  EXPECT_TRUE(has(error, "step 50 at t = 0.05 s: grid velocities are not finite")) << error;
  EXPECT_TRUE(has(error, "after step 50, is kept: wisp resume")) << error;
  expect_readable(out, 50);
  // What is kept is read again, and unchanged it stops at the same place.
  EXPECT_TRUE(has(complaint([&] { resume_run(out, {}, Talk::quiet); }), "step 50 at t = 0.05 s"));
  resume_run(out, {"stage[0].duration=0.05"}, Talk::quiet);  // as far as the load can be carried
  expect_readable(out, 50);
}

TEST(FailedRun, ImplicitStepsThatDiverge) {
  for (const char* type : {"quasi-static", "implicit-dynamic"}) {
    const test::TemporaryFolder folder;
    const fs::path out = folder.path() / "out";
    auto text = with_gravity("[[0.0, 0.0], [0.5, 0.5], [1.0, 1e8]]",
                             fmt::format("[[stage]]\ntype = \"{}\"\nduration = 1.0\nsteps = 10\n", type));
    text.velocity = "[0.0, 0.0]";
    text.stages += std::string(test::ghost);
    const std::string error = complaint([&] { run_case(text.read(), out, Talk::quiet); });
    EXPECT_TRUE(has(error, "step 6 at t = 0.5 s did not converge: ")) << error;
    EXPECT_TRUE(has(error, "try more steps")) << error;
    EXPECT_TRUE(has(error, "after step 5, is kept: wisp resume")) << error;
    expect_readable(out, 5);
    EXPECT_TRUE(has(complaint([&] { resume_run(out, {}, Talk::quiet); }), "step 6 at t = 0.5 s"));
    EXPECT_EQ(newest_step(out), 5);
    expect_readable(out, 5);
  }
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
