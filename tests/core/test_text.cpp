// Nearest names, timers, progress.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "core/nearest.h"
#include "core/progress.h"
#include "core/timers.h"

namespace wisp {
namespace {

TEST(Nearest, CountsEdits) {
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("abc", "abc"), 0);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("densiyt", "density"), 1);  // a swap is one edit
  EXPECT_EQ(edit_distance("Von_Mises", "von-mises"), 0);
}

TEST(Nearest, OffersWhatIsNear) {
  const std::vector<std::string> valid{"density", "young_modulus", "poisson_ratio"};
  EXPECT_EQ(nearest("young_moduls", valid), "young_modulus");
  EXPECT_EQ(nearest("dens", valid), "density");  // a beginning
  EXPECT_EQ(nearest("zebra", valid), "");
  EXPECT_EQ(suggestion("densty", valid),
            "; did you mean 'density'? (valid: density, young_modulus, poisson_ratio)");
  EXPECT_EQ(suggestion("zebra", valid), "; valid: density, young_modulus, poisson_ratio");
}

TEST(Timers, AddUpAndReport) {
  Timers timers;
  const int locate = timers.part("1 locate");
  const int forces = timers.part("2 forces");
  EXPECT_EQ(timers.part("1 locate"), locate);
  timers.add(locate, 1.0);
  timers.add(forces, 2.0);
  timers.add(forces, 1.0, 4);
  EXPECT_DOUBLE_EQ(timers.total(), 4.0);
  EXPECT_EQ(timers.parts()[1].count, 5);
  const std::string report = timers.report(1e9);
  EXPECT_NE(report.find("75.0%"), std::string::npos) << report;
  EXPECT_NE(report.find("3.00\n"), std::string::npos) << report;  // ns per point and step
  EXPECT_LT(report.find("1 locate"), report.find("2 forces"));
  { const auto running = timers.start(locate); }
  EXPECT_EQ(timers.parts()[0].count, 2);
}

std::string printed(Progress::Style style, const std::vector<double>& shares) {
  std::FILE* file = std::tmpfile();
  {
    Progress progress("run", style, file);
    for (const double share : shares) progress.update(share, "E = 1");
  }
  std::string text(static_cast<std::size_t>(std::ftell(file)), ' ');
  std::rewind(file);
  const auto read = std::fread(text.data(), 1, text.size(), file);
  std::fclose(file);
  text.resize(read);
  return text;
}

TEST(Progress, WritesALineForEachTenth) {
  std::vector<double> shares;
  for (int i = 1; i <= 1000; ++i) shares.push_back(i / 1000.0);
  const std::string text = printed(Progress::Style::automatic, shares);  // a file is no terminal
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10) << text;
  EXPECT_EQ(text.find('\r'), std::string::npos);
  EXPECT_EQ(text.rfind("run  10 %", 0), 0u) << text;
  EXPECT_NE(text.find("run 100 %"), std::string::npos) << text;
}

TEST(Progress, SkipsTenthsThatPassAtOnce) {
  const std::string text = printed(Progress::Style::lines, {0.05, 0.55, 1.0});
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2) << text;
}

TEST(Progress, DrawsABar) {
  const std::string text = printed(Progress::Style::bar, {0.5, 1.0});
  EXPECT_NE(text.find("[############............]  50 %"), std::string::npos) << text;
  EXPECT_NE(text.find("E = 1"), std::string::npos) << text;
  EXPECT_EQ(text.back(), '\n');
}

TEST(Progress, IsQuietWhenTold) { EXPECT_EQ(printed(Progress::Style::quiet, {0.5, 1.0}), ""); }

TEST(Progress, WritesDurations) {
  EXPECT_EQ(duration_text(3.44), "3.4 s");
  EXPECT_EQ(duration_text(59.97), "1:00");
  EXPECT_EQ(duration_text(3723.0), "1:02:03");
}

}  // namespace
}  // namespace wisp
