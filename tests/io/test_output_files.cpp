#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <bit>
#include <csignal>
#include <limits>
#include <random>

#include "core/error.h"
#include "io/atomic_file.h"
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

std::vector<std::string> lines(const fs::path& path) {
  std::ifstream stream(path);
  std::vector<std::string> all;
  for (std::string line; std::getline(stream, line);) all.push_back(line);
  return all;
}

TEST(AtomicFile, AppearsOnlyWhenComplete) {
  const TemporaryFolder folder;
  const fs::path path = folder / "deep/er/result.txt";
  {
    AtomicFile file(path);
    file.write("first");
    EXPECT_FALSE(fs::exists(path));
    EXPECT_TRUE(fs::exists(temporary_name(path)));
    file.commit();
  }
  EXPECT_EQ(contents(path), "first");
  EXPECT_FALSE(fs::exists(temporary_name(path)));
}

TEST(AtomicFile, WithoutCommitTheOldFileStays) {
  const TemporaryFolder folder;
  write_atomically(folder / "a", "old");
  {
    AtomicFile file(folder / "a");
    file.write("new");
  }
  EXPECT_EQ(contents(folder / "a"), "old");
  EXPECT_FALSE(fs::exists(temporary_name(folder / "a")));
}

TEST(AtomicFile, WhatAKilledRunLeftIsRemoved) {
  const TemporaryFolder folder;
  test::overwrite(temporary_name(folder / "points.vtu"), "half");
  test::overwrite(folder / "points.vtu", "whole");
  remove_unfinished(folder.path());
  EXPECT_FALSE(fs::exists(temporary_name(folder / "points.vtu")));
  EXPECT_EQ(contents(folder / "points.vtu"), "whole");
}

TEST(AtomicFile, SaysWhyItCannotWrite) {
  const TemporaryFolder folder;
  test::overwrite(folder / "file", "");
  EXPECT_NE(message_of<RunError>([&] {
              write_atomically(folder / "file/below", "x");
            }).find("cannot create the folder"),
            std::string::npos);
  fs::create_directory(folder / "taken");
  EXPECT_NE(message_of<RunError>([&] { write_atomically(folder / "taken", "x"); }).find("cannot write"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(temporary_name(folder / "taken")));
}

TEST(Together, EveryRankStopsWhenOneFails) {
  std::vector<std::string> messages(3);
  test::run_as_ranks(3, [&](const OutputRanks& place) {
    messages[static_cast<std::size_t>(place.rank)] = message_of<RunError>([&] {
      together(place, "the thing", [&] {
        if (place.rank == 1) run_error("disk full");
      });
    });
  });
  EXPECT_EQ(messages, (std::vector<std::string>{"another rank could not write the thing", "disk full",
                                                "another rank could not write the thing"}));
}

TEST(Vtu, RefusesArraysOfTheWrongSize) {
  const TemporaryFolder folder;
  VtuPoints points{{0, 0, 0, 1, 0, 0}, {{"velocity", 3, std::vector<double>(5)}}};
  EXPECT_EQ(message_of<RunError>([&] { write_vtu(folder / "a.vtu", points); }),
            "field \"velocity\" has 5 numbers, expected 2 rows of 3");
  const VtuCells cells{{0, 0, 0}, {0, 1}, {2}, {VtuCell::line}};
  EXPECT_NE(
      message_of<RunError>([&] { write_vtu_cells(folder / "a.vtu", cells); }).find("names point 1 of 1"),
      std::string::npos);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Vtu, OneRankOrPieces) {
  const TemporaryFolder folder;
  const VtuPoints points{{0, 0, 0}, {}};
  EXPECT_EQ(write_vtu_pieces(folder / step_name("points", 10), points, {}), folder / "points-000010.vtu");
  test::run_as_ranks(2, [&](const OutputRanks& place) {
    EXPECT_EQ(write_vtu_pieces(folder / step_name("points", 20), points, place),
              folder / "points-000020.pvtu");
  });
  EXPECT_TRUE(fs::exists(folder / "points-000010.vtu"));
  EXPECT_TRUE(fs::exists(folder / "points-000020.rank-1.vtu"));
  EXPECT_NE(contents(folder / "points-000020.pvtu").find("Source=\"points-000020.rank-1.vtu\""),
            std::string::npos);
}

TEST(Pvd, GrowsAndIsCutBackOnResume) {
  const TemporaryFolder folder;
  PvdSeries series(folder / "points.pvd");
  for (int i = 0; i < 5; ++i) series.add(0.1 * i, folder / fmt::format("p<{}>&.vtu", i));
  const double third = 0.1 * 3;  // not 0.3: the text must read back to the same bits
  PvdSeries resumed = PvdSeries::resume(folder / "points.pvd", third);
  ASSERT_EQ(resumed.entries().size(), 4u);
  EXPECT_EQ(resumed.entries().back().time, third);
  EXPECT_EQ(resumed.entries().back().file, "p<3>&.vtu");
  EXPECT_EQ(PvdSeries::resume(folder / "points.pvd", 1e9).entries().size(), 4u);
  resumed.add(third, folder / "again.vtu");
  resumed.add(third, folder / "walls.vtu", 1);
  ASSERT_EQ(resumed.entries().size(), 5u);
  EXPECT_EQ(resumed.entries()[3].file, "again.vtu");
  EXPECT_EQ(resumed.entries()[4].part, 1);
  EXPECT_TRUE(PvdSeries::resume(folder / "none.pvd", 0.0).entries().empty());
}

TEST(Pvd, RefusesWhatIsNoSeries) {
  const TemporaryFolder folder;
  test::overwrite(folder / "a.pvd", "<VTKFile type=\"Collection\"><DataSet timestep=\"0\"");
  EXPECT_NE(message_of<InputError>([&] {
              PvdSeries::resume(folder / "a.pvd", 1);
            }).find("not a complete collection"),
            std::string::npos);
  test::overwrite(folder / "b.pvd",
                  "<VTKFile type=\"Collection\"><DataSet timestep=\"soon\" file=\"a\"/></VTKFile>");
  EXPECT_NE(message_of<InputError>([&] { PvdSeries::resume(folder / "b.pvd", 1); }).find("cannot understand"),
            std::string::npos);
}

TEST(History, EveryNumberReadsBackToTheSameBits) {
  const TemporaryFolder folder;
  std::mt19937_64 random(7);
  std::vector<double> numbers{
      0.0, -0.0, 0.1, 1e-310, std::numeric_limits<double>::max(), std::numeric_limits<double>::infinity()};
  for (int i = 0; i < 500; ++i) {
    const auto value = std::bit_cast<double>(random());
    if (value == value) numbers.push_back(value);
  }
  {
    History history = History::start(folder / "h.csv", {"value [J]"});
    for (std::size_t i = 0; i < numbers.size(); ++i)
      history.add(static_cast<std::int64_t>(i), numbers[i], std::vector<double>{numbers[i]});
  }
  const auto rows = lines(folder / "h.csv");
  ASSERT_EQ(rows.size(), numbers.size() + 1);
  EXPECT_EQ(rows[0], "step,time,value [J]");
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double back = std::strtod(rows[i + 1].c_str() + rows[i + 1].rfind(',') + 1, nullptr);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(back), std::bit_cast<std::uint64_t>(numbers[i])) << rows[i + 1];
  }
}

TEST(History, ResumeDropsLaterRowsAndATornLine) {
  const TemporaryFolder folder;
  const fs::path path = folder / "h.csv";
  {
    History history = History::start(path, {"a", "b"});
    for (int i = 0; i < 6; ++i) history.add(i, 0.5 * i, std::vector<double>{1.0 * i, -1.0});
  }
  const std::string whole = contents(path);
  test::overwrite(path, whole + "6,3.0,0");
  {
    History history = History::resume(path, {"a", "b"}, 3);
    history.add(4, 2.0, std::vector<double>{4.0, -1.0});
    history.add(5, 2.5, std::vector<double>{5.0, -1.0});
  }
  EXPECT_EQ(contents(path), whole) << "a resumed history equals one that never stopped";
  test::overwrite(path, whole.substr(0, whole.size() - 3));
  { History history = History::resume(path, {"a", "b"}, 100); }
  EXPECT_EQ(lines(path).size(), 6u);
}

TEST(History, RefusesOtherColumnsAndDamage) {
  const TemporaryFolder folder;
  const fs::path path = folder / "h.csv";
  { History::start(path, {"a"}).add(0, 0, std::vector<double>{1.0}); }
  EXPECT_NE(message_of<InputError>([&] { History::resume(path, {"b"}, 0); }).find("expected \"step,time,b\""),
            std::string::npos);
  test::overwrite(path, "step,time,a\n0,0,1\n1,x,1\n2,0,1\n");
  EXPECT_EQ(message_of<InputError>([&] { History::resume(path, {"a"}, 9); }),
            path.string() + ":3: expected 3 numbers separated by commas");
  for (const char* row : {"0,0", "0,0,1,2", "0,0,", "0.5,0,1", ""}) {
    test::overwrite(path, fmt::format("step,time,a\n{}\n", row));
    EXPECT_NE(message_of<InputError>([&] { History::resume(path, {"a"}, 9); }), "no error") << row;
  }
  EXPECT_NE(message_of<InputError>([&] { History::start(path, {"a,b"}); }), "no error");
  EXPECT_NE(message_of<InputError>([&] { History::start(path, {"time"}); }), "no error");
  EXPECT_NE(message_of<RunError>([&] { History::start(path, {"a"}).add(0, 0, {}); }), "no error");
}

TEST(History, FlushesEveryFewRows) {
  const TemporaryFolder folder;
  History history = History::start(folder / "h.csv", {});
  history.flush_every(3);
  for (int i = 0; i < 5; ++i) history.add(i, i, {});
  EXPECT_EQ(lines(folder / "h.csv").size(), 4u);
  history.sync();
  EXPECT_EQ(lines(folder / "h.csv").size(), 6u);
}

}  // namespace
}  // namespace wisp
