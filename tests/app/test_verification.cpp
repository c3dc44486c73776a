// Rows and tables of `wisp verify`, and the command line of mpirun.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/launch.h"
#include "app/verification.h"
#include "core/error.h"

namespace wisp {
namespace {

std::vector<VerificationTable> tables() {
  std::vector<VerificationTable> list;
  for (const char* id : {"ghost.table-1", "ghost.table-5", "other.figure-2"})
    list.push_back(
        {id, "a table", [](const VerificationRequest&) { return std::vector<VerificationRow>{}; }, false});
  list.push_back({"ghost.figure-13", "long",
                  [](const VerificationRequest&) { return std::vector<VerificationRow>{}; }, true});
  return list;
}

std::vector<std::string> selected(const std::vector<std::string>& words, bool full) {
  const auto list = tables();
  std::vector<std::string> ids;
  for (const auto* table : select_tables(list, words, full)) ids.push_back(table->id);
  return ids;
}

TEST(Verification, SelectsByPrefix) {
  using Ids = std::vector<std::string>;
  EXPECT_EQ(selected({}, false), (Ids{"ghost.table-1", "ghost.table-5", "other.figure-2"}));
  EXPECT_EQ(selected({}, true).size(), 4u);
  EXPECT_EQ(selected({"ghost"}, false), (Ids{"ghost.table-1", "ghost.table-5"}));
  EXPECT_EQ(selected({"ghost.figure-13"}, false), Ids{"ghost.figure-13"});
  EXPECT_EQ(selected({"other", "ghost.table-5"}, false), (Ids{"ghost.table-5", "other.figure-2"}));
  EXPECT_THROW(selected({"gost"}, false), InputError);
}

TEST(Verification, ComparesWithItsTarget) {
  VerificationRow row{.case_name = "h = 1",
                      .quantity = "count",
                      .published = 200.0,
                      .computed = 202.0,
                      .tolerance = 0.02,
                      .gated = true};
  EXPECT_DOUBLE_EQ(*row.difference(), 0.01);
  EXPECT_TRUE(row.passed());
  row.tolerance = 0.005;
  EXPECT_FALSE(row.passed());
  row.expected = 202.5;  // an exact value outranks the print
  EXPECT_TRUE(row.passed());
  row.verdict = false;
  EXPECT_FALSE(row.passed());
  row.verdict.reset();
  row.computed = std::nan("");
  EXPECT_FALSE(row.passed());
}

TEST(Verification, ZeroTargetsAreAbsolute) {
  const VerificationRow row{
      .quantity = "error", .computed = 1e-13, .reference = "exact", .expected = 0.0, .tolerance = 1e-12};
  EXPECT_TRUE(row.passed());
  EXPECT_DOUBLE_EQ(*row.difference(), 1e-13);
}

TEST(Verification, WritesJson) {
  const std::vector<VerificationRow> rows{{.case_name = "a \"b\"",
                                           .quantity = "q",
                                           .published = 2.0,
                                           .computed = 1.0,
                                           .tolerance = 0.1,
                                           .gated = true},
                                          {.case_name = "c", .quantity = "q", .computed = HUGE_VAL}};
  const std::string text = rows_json({{"ghost.table-1", rows}});
  EXPECT_NE(
      text.find(
          R"("id": "ghost.table-1", "case": "a \"b\"", "quantity": "q", "published": 2, "computed": 1)"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find(R"("gated": true, "passed": false)"), std::string::npos) << text;
  EXPECT_NE(text.find(R"("published": null, "computed": null)"), std::string::npos) << text;
  EXPECT_EQ(rows_json({}), "[\n]\n");
}

TEST(Verification, PrintsATable) {
  const std::vector<VerificationRow> rows{{.case_name = "x",
                                           .quantity = "iterations",
                                           .published = 4.0,
                                           .computed = 5.0,
                                           .tolerance = 0.1,
                                           .gated = true}};
  const std::string text = table_text({"ghost.table-5", "counts", {}, false}, rows);
  EXPECT_NE(text.find("+25.00 %  FAILED"), std::string::npos) << text;
}

TEST(Launch, BuildsTheCommandOfMpirun) {
  const auto words = mpirun_command(4, {"run", "a b.toml"}, true);
  const std::vector<std::string> start{"mpirun", "--oversubscribe", "--quiet", "--allow-run-as-root", "-n",
                                       "4"};
  ASSERT_EQ(words.size(), 9u);
  EXPECT_TRUE(std::equal(start.begin(), start.end(), words.begin()));
  EXPECT_EQ(words[7], "run");
  EXPECT_EQ(words[8], "a b.toml");
  EXPECT_EQ(mpirun_command(2, {}, false).size(), 6u);
}

}  // namespace
}  // namespace wisp
