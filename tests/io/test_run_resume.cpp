// A run that is stopped and goes on has the same bits as one that was never stopped.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "io/checkpoint.h"
#include "io/run.h"
#include "io/run_cases.h"
#include "material/von_mises.h"
#include "parallel/session.h"

namespace wisp {
namespace {
namespace fs = std::filesystem;
using test::CaseText;

/// PETSc lives as long as the program.
class WithSession : public testing::Environment {
 public:
  void SetUp() override { session_ = std::make_unique<Session>(); }
  void TearDown() override { session_.reset(); }

 private:
  std::unique_ptr<Session> session_;
};
const auto* const environment = testing::AddGlobalTestEnvironment(new WithSession);

std::string whole(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}
bool same_bits(const std::string& a, const std::string& b) { return a == b; }

/// Bytes of a state of the von Mises law that hold numbers; the rest of it is padding without a value.
bool same_states(const Checkpoint::Bytes& a, const Checkpoint::Bytes& b) {
  using State = VonMises::State<2>;
  constexpr std::size_t used = 2 * sizeof(Sym<2>) + 2 * sizeof(double);
  if (a.size() != b.size() || a.size() % sizeof(State) != 0) return false;
  for (std::size_t k = 0; k < a.size(); k += sizeof(State))
    if (std::memcmp(a.data() + k, b.data() + k, used) != 0) return false;
  return true;
}

void expect_same_checkpoint(const fs::path& a, const fs::path& b, bool von_mises) {
  const auto sets_a = checkpoint_sets(a), sets_b = checkpoint_sets(b);
  ASSERT_EQ(sets_a.front().step, sets_b.front().step);
  const Checkpoint one = Checkpoint::read_file(checkpoint_file(a, sets_a.front(), 0), 0, 1);
  const Checkpoint two = Checkpoint::read_file(checkpoint_file(b, sets_b.front(), 0), 0, 1);
  ASSERT_EQ(one.names(), two.names());
  EXPECT_EQ(one.time, two.time);
  for (const auto& name : one.names()) {
    if (von_mises && name.ends_with("material_state")) {
      EXPECT_TRUE(same_states(one.bytes(name), two.bytes(name))) << name;
      continue;
    }
    bool same = false;
    const auto compare = [&](const auto& get) { same = same_bits(get(one), get(two)); };
    try {
      compare([&](const Checkpoint& c) { return c.doubles(name); });
    } catch (const InputError&) {
      try {
        compare([&](const Checkpoint& c) { return c.integers(name); });
      } catch (const InputError&) {
        try {
          compare([&](const Checkpoint& c) { return c.bytes(name); });
        } catch (const InputError&) {
          compare([&](const Checkpoint& c) { return c.text(name); });
        }
      }
    }
    EXPECT_TRUE(same) << name;
  }
}

struct Variation {
  const char* name;
  CaseText text;
  bool von_mises = false;
};

std::string explicit_stage(const std::string& keys) {
  return "[[stage]]\ntype = \"explicit\"\nduration = 0.04\nsteps = 20\n" + keys;
}
const std::string von_mises =
    "type = \"von-mises\"\ndensity = 1000.0\nyoung_modulus = 1e5\npoisson_ratio = 0.3\nyield_stress = 2e3\n"
    "hardening_modulus = 1e4";
const std::string out =
    "frames = 4\ncheckpoint_every = 10\ntrack = [{ name = \"p\", body = \"block\", nearest = [1.0, 1.0] }]\n";

std::vector<Variation> variations() {
  const std::string ghost(test::ghost);
  const std::string traction =
      "[[load]]\ntype = \"traction\"\nname = \"cover\"\nbody = \"block\"\ncorner = [1.25, 1.0]\nedges = "
      "[[-1.0, 0.0]]\npoints "
      "= "
      "[8]\npressure = [[0.0, 0.0], [0.04, 1e3]]\n";
  const std::string load =
      "[[load]]\nname = \"push\"\nbody = \"block\"\nnearest = [[1.2, 0.9]]\nforce = [5.0, 0.0]\n";
  const std::string slow = "[0.0, 0.0]";
  const std::string walls =
      "[[boundary]]\ntype = \"wall\"\nname = \"slope\"\nunilateral = true\nfriction = 0.3\n"
      "shape = { type = \"plane\", point = [0.25, 0.3], normal = [0.1, 1.0] }\n"
      "[[boundary]]\ntype = \"wall\"\nname = \"ram\"\nunilateral = true\n"
      "shape = { type = \"polyline\", vertices = [[1.3, 0.1], [1.3, 1.4]] }\n"
      "motion = { velocity = [-1.0, 0.0], angular_velocity = 0.2, centre = [1.3, 0.5] }\n";
  return {
      {"LumpedUsl", {.stages = explicit_stage(""), .output = out}},
      {"LumpedUsfGimpVonMises",
       {.basis = "gimp",
        .material = von_mises,
        .stages = explicit_stage("stress_update = \"usf\"\n"),
        .output = out},
       true},
      {"ConsistentGhostGimp",
       {.basis = "gimp",
        .stages = explicit_stage("mass = \"consistent\"\n"),
        .more = ghost + traction + load,
        .output = out}},
      {"Musl", {.stages = explicit_stage("stress_update = \"musl\"\n"), .output = out}},
      {"WallsGimpMusl",
       {.basis = "gimp",
        .stages = explicit_stage("stress_update = \"musl\"\n"),
        .more = walls,
        .output = out}},
      {"WallsLinearUsl", {.stages = explicit_stage(""), .more = walls, .output = out}},
      {"WallsConsistentGhost",
       {.basis = "gimp",
        .stages = explicit_stage("mass = \"consistent\"\n"),
        .more = ghost + walls,
        .output = out}},
      {"Apic", {.stages = explicit_stage("velocity_update = \"apic\"\n"), .output = out}},
      {"ConsistentGhostCfl",
       {.stages = "[[stage]]\ntype = \"explicit\"\nduration = 0.2\ncfl = 0.2\nmass = \"consistent\"\n",
        .more = ghost,
        .output = out}},
      {"Leaving",
       {.stages = "[[stage]]\ntype = \"explicit\"\nduration = 0.2\nsteps = 20\n",
        .leaving = "remove",
        .output = out,
        .velocity = "[8.0, 0.0]"}},
      {"QuasiStatic",
       {.basis = "gimp",
        .material = von_mises,
        .stages = "[[stage]]\ntype = \"quasi-static\"\nduration = 0.04\nsteps = 20\n",
        .more = ghost + traction,
        .output = out,
        .velocity = slow},
       true},
      {"ImplicitDynamic",
       {.stages = "[[stage]]\ntype = \"implicit-dynamic\"\nduration = 0.04\nsteps = 20\n",
        .more = ghost,
        .output = out,
        .velocity = slow}},
      {"Stages",
       {.basis = "gimp",
        .stages = "[[stage]]\ntype = \"quasi-static\"\nduration = 1.0\nsteps = 5\n" +
                  explicit_stage("mass = \"consistent\"\n") +
                  "[[stage]]\ntype = \"implicit-dynamic\"\nduration = 0.02\nsteps = 3\n",
        .more = ghost,
        .output = "frames = 3\ncheckpoint_every = 7\nhistory_every = 2\n",
        .velocity = slow}},
  };
}

class Resume : public testing::TestWithParam<Variation> {};

/// Brings a copy of finished results back to the state of a run that was killed after its last checkpoint but
/// one: the newest set cannot be read, and later states are not there yet.
void turn_back(const fs::path& folder) {
  const auto sets = checkpoint_sets(folder);
  ASSERT_EQ(sets.size(), 2u);
  fs::resize_file(checkpoint_file(folder, sets[0], 0), 100);
  std::vector<fs::path> later;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("points-") && std::stoll(name.substr(7)) > sets[1].step)
      later.push_back(entry.path());
  }
  for (const auto& path : later) fs::remove(path);
}

TEST_P(Resume, HasTheSameBits) {
  const test::TemporaryFolder folder;
  const fs::path straight = folder.path() / "straight", stopped = folder.path() / "stopped";
  run_case(GetParam().text.read(), straight, Talk::quiet);
  fs::copy(straight, stopped, fs::copy_options::recursive);
  turn_back(stopped);
  resume_run(stopped, {}, Talk::quiet);
  expect_same_checkpoint(straight, stopped, GetParam().von_mises);
  int files = 0;
  for (const auto& entry : fs::directory_iterator(straight)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("checkpoint")) continue;  // with the date of writing
    ++files;
    EXPECT_EQ(whole(entry.path()), whole(stopped / name)) << name;
  }
  EXPECT_GE(files, 5);
}

INSTANTIATE_TEST_SUITE_P(Run, Resume, testing::ValuesIn(variations()),
                         [](const auto& given) { return std::string(given.param.name); });

TEST(RunStages, CarryStatesOn) {
  const test::TemporaryFolder folder;
  const CaseText text{
      .stages =
          "[[stage]]\ntype = \"quasi-static\"\nduration = 1.0\nsteps = 4\n"
          "[[stage]]\ntype = \"explicit\"\nduration = 0.01\nsteps = 10\n",
      .more = std::string(test::ghost) +
              "[[boundary]]\nname = \"left\"\nnormal = \"x\"\nat = 0.25\ndirections = [\"x\"]\n",
      .output = "frames = 1\n",
      .velocity = "[0.0, 0.0]"};
  run_case(text.read(), folder.path() / "r", Talk::quiet);
  std::ifstream in(folder.path() / "r" / "history.csv");
  std::string line, titles;
  std::getline(in, titles);
  EXPECT_TRUE(titles.starts_with("step,time,stage,dt [s],kinetic energy [J/m]")) << titles;
  std::vector<std::vector<double>> rows;
  while (std::getline(in, line)) {
    rows.emplace_back();
    for (std::size_t at = 0; at <= line.size();) {
      const std::size_t end = std::min(line.find(',', at), line.size());
      rows.back().push_back(std::stod(line.substr(at, end - at)));
      at = end + 1;
    }
  }
  ASSERT_EQ(rows.size(), 15u);  // steps 0 to 14, each once
  for (std::size_t k = 0; k < rows.size(); ++k) EXPECT_EQ(rows[k][0], static_cast<double>(k));
  EXPECT_EQ(rows.back()[1], 1.01);
  EXPECT_EQ(rows[4][2], 1.0);
  EXPECT_EQ(rows[5][2], 2.0);
  // The block is in equilibrium when the explicit stage begins: it keeps its strain energy and stays at rest.
  const double strain = rows[4][5];
  EXPECT_GT(strain, 1.0);
  EXPECT_NEAR(rows[14][5], strain, 0.02 * strain);
  EXPECT_LT(rows[14][4], 0.02 * strain);
}

TEST(RunStops, WhenPointsLeave) {
  const test::TemporaryFolder folder;
  CaseText text{.stages = "[[stage]]\ntype = \"explicit\"\nduration = 0.5\nsteps = 50\n",
                .velocity = "[8.0, 0.0]"};
  try {
    run_case(text.read(), folder.path() / "r", Talk::quiet);
    FAIL() << "points leave the grid, and nobody says so";
  } catch (const RunError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("left the grid"), std::string::npos) << what;
    EXPECT_NE(what.find("of 'block' at (2."), std::string::npos) << what;
    EXPECT_NE(what.find("leaving = \"remove\""), std::string::npos) << what;
  }
}

TEST(RunCounts, PointsThatLeave) {
  const test::TemporaryFolder folder;
  CaseText text{.stages = "[[stage]]\ntype = \"explicit\"\nduration = 0.2\nsteps = 20\n",
                .leaving = "remove",
                .velocity = "[8.0, 0.0]"};
  run_case(text.read(), folder.path() / "r", Talk::quiet);
  const std::string history = whole(folder.path() / "r" / "history.csv");
  ASSERT_NE(history.find(",points removed\n"), std::string::npos);
  const std::string last = history.substr(history.rfind(',') + 1);
  EXPECT_GT(std::stod(last), 0.0);
  const auto sets = checkpoint_sets(folder.path() / "r");
  const Checkpoint end = Checkpoint::read_file(checkpoint_file(folder.path() / "r", sets.front(), 0), 0, 1);
  EXPECT_EQ(end.integer("removed"), static_cast<std::int64_t>(std::stod(last)));
  EXPECT_EQ(static_cast<std::int64_t>(end.integers("body 0 id").size()), 48 - end.integer("removed"));
}

TEST(RunWritesNothing, ForACaseThatCannotBeBuilt) {
  const test::TemporaryFolder folder;
  // Fine by itself, but two positions choose the same point: only the sampled model can tell.
  const CaseText text{.stages = explicit_stage(""),
                      .more =
                          "[[load]]\nname = \"push\"\nbody = \"block\"\nnearest = [[1.2, 0.9], [1.21, "
                          "0.91]]\nforce = [5.0, 0.0]\n"};
  EXPECT_THROW(run_case(text.read(), folder.path() / "r", Talk::quiet), InputError);
  EXPECT_FALSE(fs::exists(folder.path() / "r"));
}

TEST(RunReplaces, TheResultsOfAnEarlierRun) {
  const test::TemporaryFolder folder;
  const fs::path results = folder.path() / "r";
  run_case(CaseText{.stages = explicit_stage(""), .output = out}.read(), results, Talk::quiet);
  std::ofstream(results / "notes.txt") << "mine";
  run_case(CaseText{.stages = "[[stage]]\ntype = \"explicit\"\nduration = 0.001\nsteps = 3\n"}.read(),
           results, Talk::quiet);
  EXPECT_EQ(checkpoint_sets(results).size(), 1u);
  EXPECT_EQ(checkpoint_sets(results).front().step, 3);
  EXPECT_FALSE(fs::exists(results / "points-000020.vtu"));
  EXPECT_TRUE(fs::exists(results / "notes.txt"));
}

}  // namespace
}  // namespace wisp
