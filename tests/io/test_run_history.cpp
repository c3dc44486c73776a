// Columns of the history that are measured on demand.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "core/error.h"
#include "io/run.h"
#include "io/run_cases.h"

namespace wisp {
namespace {
namespace fs = std::filesystem;

/// A column of a history by its title.
std::vector<double> column(const fs::path& history, const std::string& title) {
  std::ifstream in(history);
  std::string line, cell;
  std::getline(in, line);
  std::stringstream titles(line);
  std::size_t place = 0;
  while (std::getline(titles, cell, ',') && cell != title) ++place;
  EXPECT_EQ(cell, title) << "in " << line;
  std::vector<double> values;
  while (std::getline(in, line)) {
    std::stringstream row(line);
    for (std::size_t k = 0; k <= place; ++k) std::getline(row, cell, ',');
    values.push_back(std::stod(cell));
  }
  return values;
}

/// A block that fills its cells and trembles.
std::string trembling(double dt, int steps, const std::string& mass, const std::string& output) {
  return "dimension = 2\n[grid]\nlower = [-0.25, -0.25]\nupper = [1.25, 1.25]\ncells = [6, 6]\n"
         "[[body]]\nname = \"block\"\nshape = { type = \"box\", lower = [0.0, 0.0], upper = [1.0, 1.0] }\n"
         "velocity_gradient = [[1e-6, 2e-6], [0.0, -1e-6]]\n[body.material]\ntype = \"linear-elastic\"\n"
         "density = 1000.0\nyoung_modulus = 1e5\npoisson_ratio = 0.3\n[[stage]]\ntype = \"explicit\"\nmass = "
         "\"" +
         mass + "\"\n" +
         fmt::format("duration = {}\nsteps = {}\n[output]\nframes = 0\n{}", dt * steps, steps, output);
}

Case read(const std::string& text) { return read_case(CaseSource{"test.toml", ".", text, {}}); }

TEST(RunHistory, CriticalTimeStepIsTheEdgeOfStability) {
  const test::TemporaryFolder folder;
  run_case(read(trembling(1e-4, 1, "consistent", "critical_time_step = true\ncondition_numbers = true\n")),
           folder / "measured", Talk::quiet);
  const fs::path history = folder / "measured/history.csv";
  const double critical = column(history, "critical time step [s]").front();
  // The wave takes h/c = 0.0216 s through a cell; the consistent mass makes the step about half of that.
  EXPECT_GT(critical, 0.003);
  EXPECT_LT(critical, 0.0216);
  const double condition = column(history, "condition number [-]").front();
  EXPECT_GT(condition, 3.0);
  EXPECT_LT(condition, 1e4);
  const auto growth = [&](double share) {
    const std::string name = fmt::format("{}", share);
    run_case(read(trembling(share * critical, 50, "consistent", "")), folder / name, Talk::quiet);
    const auto total = column(folder / (name + "/history.csv"), "total energy [J/m]");
    return *std::max_element(total.begin(), total.end()) / total.front();
  };
  EXPECT_LT(growth(0.9), 20.0);  // close to the edge the energy of a stable step swings, but does not grow
  EXPECT_THROW(growth(1.02), RunError);  // stopped when it has made a hundred times the energy
}

TEST(RunHistory, LumpedConditionIsTheRatioOfMasses) {
  const test::TemporaryFolder folder;
  run_case(read(trembling(1e-4, 1, "lumped", "critical_time_step = true\ncondition_numbers = true\n")),
           folder / "r", Talk::quiet);
  // A node in the block has the mass of four cells' quarters, one at a corner of one.
  const auto condition = column(folder / "r/history.csv", "condition number [-]");
  ASSERT_EQ(condition.size(), 2u);
  EXPECT_NEAR(condition.front(), 4.0, 1e-9);
  EXPECT_GT(column(folder / "r/history.csv", "critical time step [s]").front(), 0.003);
}

TEST(RunHistory, StiffnessOfImplicitStages) {
  const test::TemporaryFolder folder;
  const test::CaseText text{.stages = "[[stage]]\ntype = \"quasi-static\"\nduration = 1.0\nsteps = 2\n",
                            .more = std::string(test::ghost),
                            .output = "condition_numbers = true\n",
                            .velocity = "[0.0, 0.0]"};
  run_case(text.read(), folder / "r", Talk::quiet);
  const auto condition = column(folder / "r/history.csv", "condition number [-]");
  ASSERT_EQ(condition.size(), 3u);
  EXPECT_TRUE(std::isnan(condition[0]));  // there is no stiffness before the first step
  EXPECT_GT(condition[2], 10.0);
  EXPECT_LT(condition[2], 1e6);
  const auto iterations = column(folder / "r/history.csv", "iterations");
  EXPECT_GE(iterations[1], 2.0);
  EXPECT_LE(column(folder / "r/history.csv", "residual")[1], 1e-6);
}

}  // namespace
}  // namespace wisp
