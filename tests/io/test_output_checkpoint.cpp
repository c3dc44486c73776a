#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <csignal>
#include <new>
#include <random>
#include <thread>

#include "core/error.h"
#include "io/checkpoint.h"
#include "io/history.h"
#include "io/pvd.h"
#include "io/rank_threads.h"
#include "io/temporary_folder.h"
#include "io/vtu.h"

namespace wisp {
namespace {
namespace fs = std::filesystem;
using test::contents;
using test::message_of;
using test::TemporaryFolder;

struct State {
  double strain[4];
  int count;
};

Checkpoint sample(std::int64_t step, int rank = 0) {
  std::mt19937_64 random(static_cast<std::uint64_t>(1000 * step + rank));
  Checkpoint checkpoint;
  checkpoint.step = step;
  checkpoint.time = 0.1 * static_cast<double>(step);
  checkpoint.code_version = "0.1.0";
  checkpoint.case_text = "[grid]\nname = \"Käse\"\n";
  std::vector<double> doubles;
  for (int i = 0; i < 300; ++i)
    doubles.push_back(std::bit_cast<double>(random()));  // NaNs with payload among them
  checkpoint.set("z position", doubles);
  std::vector<std::int64_t> integers;
  for (int i = 0; i < 200; ++i) integers.push_back(static_cast<std::int64_t>(random()));
  checkpoint.set("ids", integers);
  checkpoint.set("flags", Checkpoint::Bytes{0, 1, 255});
  checkpoint.set("law", std::string("von-mises\0x", 11));
  checkpoint.set("empty", Checkpoint::Doubles{});
  checkpoint.set("empty text", std::string());
  checkpoint.set_number("dt", 1e-5);
  checkpoint.set_integer("rank", rank);
  const State states[2] = {{{1, 2, 3, 4}, 5}, {{6, 7, 8, 9}, 10}};
  checkpoint.set_values<State>("states", states);
  return checkpoint;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  });
}

void expect_same(const Checkpoint& a, const Checkpoint& b) {
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.code_version, b.code_version);
  EXPECT_EQ(a.case_text, b.case_text);
  EXPECT_EQ(a.names(), b.names());
  EXPECT_TRUE(same_bits(a.doubles("z position"), b.doubles("z position")));
  EXPECT_TRUE(same_bits(a.doubles("empty"), b.doubles("empty")));
  EXPECT_EQ(a.integers("ids"), b.integers("ids"));
  EXPECT_EQ(a.bytes("flags"), b.bytes("flags"));
  EXPECT_EQ(a.text("law"), b.text("law"));
  EXPECT_EQ(a.text("empty text"), b.text("empty text"));
  EXPECT_EQ(a.number("dt"), b.number("dt"));
  EXPECT_EQ(a.integer("rank"), b.integer("rank"));
  EXPECT_EQ(a.values<State>("states")[1].strain[3], 9.0);
}

std::vector<std::string> hdf5_files(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".h5") names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(Checkpoint, EveryValueComesBackWithTheSameBits) {
  const TemporaryFolder folder;
  Checkpoint written = sample(17);
  written.write(folder.path());
  const Checkpoint read = read_latest_checkpoint(folder.path());
  expect_same(written, read);
  EXPECT_EQ(read.created.size(), 20u);
  EXPECT_EQ(read.created.back(), 'Z');
}

TEST(Checkpoint, KeepsTheLastTwo) {
  const TemporaryFolder folder;
  for (int step : {10, 20, 30}) sample(step).write(folder.path());
  EXPECT_EQ(hdf5_files(folder.path()),
            (std::vector<std::string>{"checkpoint-000020.rank-0.h5", "checkpoint-000030.rank-0.h5"}));
  EXPECT_EQ(read_latest_checkpoint(folder.path()).step, 30);
  EXPECT_EQ(checkpoint_sets(folder.path())[1].step, 20);
  sample(30).write(folder.path());  // a run that went back to step 20 comes here again
  EXPECT_EQ(checkpoint_sets(folder.path()).size(), 2u);
  expect_same(read_latest_checkpoint(folder.path()), sample(30));
}

TEST(Checkpoint, RanksWriteOneSet) {
  const TemporaryFolder folder;
  for (int step : {1, 2, 3})
    test::run_as_ranks(
        3, [&](const OutputRanks& place) { sample(step, place.rank).write(folder.path(), place); });
  EXPECT_EQ(hdf5_files(folder.path()).size(), 6u);
  test::run_as_ranks(3, [&](const OutputRanks& place) {
    expect_same(read_latest_checkpoint(folder.path(), place), sample(3, place.rank));
  });
  const auto parts = latest_checkpoint_parts(folder.path());
  ASSERT_EQ(parts.n(), 3);
  expect_same(parts.read(2), sample(3, 2));
  EXPECT_NE(message_of<InputError>([&] {
              read_latest_checkpoint(folder.path());
            }).find("written by 3 ranks, this run has 1"),
            std::string::npos);
  // One damaged part sends every rank back to the same earlier set.
  const fs::path part = checkpoint_file(folder.path(), {3, 3}, 1);
  fs::resize_file(part, fs::file_size(part) - 1);
  test::run_as_ranks(3, [&](const OutputRanks& place) {
    std::vector<std::string> passed_over;
    expect_same(read_latest_checkpoint(folder.path(), place, &passed_over), sample(2, place.rank));
    EXPECT_EQ(passed_over.size(), 1u);
  });
  EXPECT_EQ(latest_checkpoint_parts(folder.path()).set.step, 2);
}

TEST(Checkpoint, AFailingRankLeavesTheEarlierSet) {
  const TemporaryFolder folder;
  test::run_as_ranks(2, [&](const OutputRanks& place) { sample(1, place.rank).write(folder.path(), place); });
  fs::create_directories(checkpoint_file(folder.path(), {2, 2}, 1));  // in the way of rank 1
  test::run_as_ranks(2, [&](const OutputRanks& place) {
    EXPECT_NE(message_of<RunError>([&] { sample(2, place.rank).write(folder.path(), place); }), "no error");
    expect_same(read_latest_checkpoint(folder.path(), place), sample(1, place.rank));
  });
}

TEST(Checkpoint, ErrorsSayWhatIsWrong) {
  const TemporaryFolder folder;
  EXPECT_EQ(message_of<InputError>([&] { read_latest_checkpoint(folder.path()); }),
            "there is no checkpoint in " + folder.path().string() + " (no checkpoint.txt)");
  sample(5).write(folder.path());
  const fs::path path = checkpoint_file(folder.path(), {5, 1}, 0);
  const Checkpoint read = read_latest_checkpoint(folder.path());
  const std::string origin = "checkpoint " + path.string();
  EXPECT_EQ(message_of<InputError>([&] { read.doubles("warm start"); }),
            origin + ": the array \"warm start\" is missing");
  EXPECT_EQ(message_of<InputError>([&] { read.doubles("ids"); }), origin + ": \"ids\" does not hold doubles");
  EXPECT_EQ(message_of<InputError>([&] { read.doubles("dt", 2); }),
            origin + ": \"dt\" has 1 values, expected 2");
  EXPECT_NE(message_of<InputError>([&] { read.values<State>("flags"); }).find("has 3 bytes"),
            std::string::npos);
  EXPECT_NE(message_of<RunError>([&] { sample(1).set_number("a/b", 1); }), "no error");
  EXPECT_NE(message_of<InputError>([&] { Checkpoint::read_file(path, 1, 2); }).find("belongs to rank 0 of 1"),
            std::string::npos);

  const std::string whole = contents(path);
  std::string other = whole;
  other.replace(other.find(" 1\n"), 3, " 9\n");
  test::overwrite(path, other);
  EXPECT_EQ(message_of<InputError>([&] { read_latest_checkpoint(folder.path()); }),
            origin + " has format version 9, this program reads version 1");
  test::overwrite(path, whole.substr(0, whole.size() / 2));
  EXPECT_EQ(message_of<InputError>([&] { read_latest_checkpoint(folder.path()); }),
            origin + " is truncated or damaged (its checksum does not match)");
  test::overwrite(path, "");
  EXPECT_NE(message_of<InputError>([&] { read_latest_checkpoint(folder.path()); }).find("it is empty"),
            std::string::npos);
  fs::remove(path);
  EXPECT_NE(message_of<InputError>([&] { read_latest_checkpoint(folder.path()); }).find("is missing"),
            std::string::npos);
}

TEST(Checkpoint, AnyDamageIsFoundOrTheEarlierSetIsUsed) {
  const TemporaryFolder folder;
  for (int step : {1, 2}) sample(step).write(folder.path());
  std::mt19937 random(11);
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  const fs::path newest = checkpoint_file(folder.path(), {2, 1}, 0), index = folder / "checkpoint.txt";
  for (const fs::path& path : {newest, index}) {
    const std::string whole = contents(path);
    for (int trial = 0; trial < 300; ++trial) {
      std::string damaged = whole;
      if (trial % 3 == 0) {
        damaged.resize(below(whole.size()));
      } else {
        // The padding of the seal belongs to the file as well: whatever changes is found.
        const std::size_t at = below(whole.size());
        damaged[at] = static_cast<char>(damaged[at] ^ (1 << below(8)));
      }
      test::overwrite(path, damaged);
      std::int64_t step = 0;
      const std::string message =
          message_of<InputError>([&] { step = read_latest_checkpoint(folder.path()).step; });
      if (path == newest)
        EXPECT_EQ(step, 1) << "trial " << trial;
      else
        EXPECT_NE(message, "no error") << "trial " << trial;
    }
    test::overwrite(path, whole);
  }
  EXPECT_EQ(read_latest_checkpoint(folder.path()).step, 2);
}

/// Writes like a run does, for ever: a row each step, every third step a state, every fifth a checkpoint.
/// `steps` counts them for the process that kills.
[[noreturn]] void run_until_killed(const fs::path& folder, std::int64_t start, std::atomic<int>& steps) {
  try {
    remove_unfinished(folder);
    History history = History::resume(folder / "history.csv", {"energy"}, start);
    PvdSeries series = PvdSeries::resume(folder / "points.pvd", static_cast<double>(start));
    for (std::int64_t step = start + 1;; ++step) {
      const auto time = static_cast<double>(step);
      history.add(step, time, std::vector<double>{0.1 * time});
      if (step % 3 == 0)
        series.add(time, write_vtu_pieces(folder / step_name("points", step),
                                          {{time, 0, 0}, {{"x", 1, std::vector<double>{time}}}}, {}));
      if (step % 5 == 0) sample(step).write(folder);
      ++steps;
    }
  } catch (...) {
    ::_exit(3);
  }
}

TEST(Killed, AlwaysLeavesAReadableLastState) {
  const TemporaryFolder folder;
  std::mt19937 random(5);
  void* shared =
      ::mmap(nullptr, sizeof(std::atomic<int>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  auto* steps = new (shared) std::atomic<int>(0);
  std::int64_t last = 0;
  for (int trial = 0; trial < 25; ++trial) {
    *steps = 0;
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) run_until_killed(folder.path(), last, *steps);
    // After some steps, however long the disk takes for them, and then anywhere within the next ones.
    const int wanted = std::uniform_int_distribution<int>(0, 12)(random);
    while (*steps < wanted) {
      siginfo_t ended{};
      ASSERT_EQ(::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOHANG | WNOWAIT), 0);
      ASSERT_EQ(ended.si_pid, 0) << "the writer ended by itself";
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    std::this_thread::sleep_for(
        std::chrono::microseconds(std::uniform_int_distribution<int>(0, 30000)(random)));
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the writer ended by itself with " << WEXITSTATUS(status);

    std::int64_t step = 0;
    if (fs::exists(folder / "checkpoint.txt")) {
      std::vector<std::string> passed_over;
      const Checkpoint read = read_latest_checkpoint(folder.path(), {}, &passed_over);
      EXPECT_TRUE(passed_over.empty()) << passed_over.front();
      expect_same(read, sample(read.step));
      step = read.step;
    }
    EXPECT_GE(step, last) << "a later state was lost";
    last = step;
    const PvdSeries series = PvdSeries::resume(folder / "points.pvd", 1e9);
    for (const PvdSeries::Entry& entry : series.entries())
      EXPECT_TRUE(contents(folder / entry.file).ends_with("</VTKFile>\n")) << entry.file;
    if (!fs::exists(folder / "history.csv")) continue;
    { History::resume(folder / "history.csv", {"energy"}, last); }
    std::ifstream stream(folder / "history.csv");
    std::int64_t rows = -1;
    for (std::string line; std::getline(stream, line);) ++rows;
    EXPECT_EQ(rows, last) << "a row for each step up to the checkpoint, and none after it";
  }
  EXPECT_GT(last, 0) << "no trial wrote a checkpoint";
  ::munmap(shared, sizeof(std::atomic<int>));
}

}  // namespace
}  // namespace wisp
