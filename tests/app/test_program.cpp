// The executable: exit statuses, one line of error, nothing written.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "io/case.h"

#include "io/temporary_folder.h"

namespace wisp {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int status = -1;
  std::string out, err;
};

/// An empty folder for one test; programs run inside it.
class Program : public testing::Test {
 protected:
  void SetUp() override { fs::create_directory(folder_); }

  Outcome wisp(const std::string& arguments) {
    const std::string command = "cd '" + folder_.string() + "' && '" + WISP_PROGRAM + "' " + arguments +
                                " > '" + (base_ / "out").string() + "' 2> '" + (base_ / "err").string() + "'";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, test::contents(base_ / "out"),
            test::contents(base_ / "err")};
  }

  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }

  int files() const {
    return static_cast<int>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  /// Status 2, one line on the error stream with this beginning, nothing on the other, no new file.
  void expect_refused(const std::string& arguments, const std::string& message) {
    const int before = files();
    const Outcome o = wisp(arguments);
    EXPECT_EQ(o.status, 2) << arguments;
    EXPECT_EQ(o.out, "") << arguments;
    EXPECT_EQ(o.err.rfind("wisp: error: " + message, 0), 0u) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    EXPECT_EQ(files(), before) << arguments;
  }

  test::TemporaryFolder base_;
  const fs::path folder_ = base_ / "work";
};

TEST_F(Program, ChecksAValidCase) {
  write("good.toml", case_template({"explicit"}));
  const Outcome o = wisp("check good.toml");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(o.out, "good.toml: valid. 2 dimensions, 1 body, explicit 1 s\n");
  EXPECT_EQ(files(), 1);
}

TEST_F(Program, RefusesMalformedCases) {
  const std::string good = case_template({"explicit"});
  write("good.toml", good);
  write("empty.toml", "");
  write("syntax.toml", "dimension = \n");
  write("typo.toml", "dimensoin = 2\n" + good);
  write("late.toml", good + "\n[ouput]\nframes = 3\n");
  for (const std::string command : {"check ", "run ", "run --ranks 2 "}) {
    expect_refused(command + "nowhere.toml", "nowhere.toml: cannot read this file");
    expect_refused(command + ".", ".: expected a case file, found a folder");
    expect_refused(command + "empty.toml", "empty.toml:1:1: missing key 'dimension'");
    expect_refused(command + "syntax.toml", "syntax.toml:1:13: not valid TOML: ");
    expect_refused(command + "typo.toml",
                   "typo.toml:1:1: unknown key 'dimensoin'; did you mean 'dimension'?");
    expect_refused(command + "late.toml --set dimension=2", "late.toml:");
    expect_refused(command + "good.toml --set dimension=4",
                   "--set dimension=4: dimension: expected an integer in [2, 3], found integer 4");
    expect_refused(command + "good.toml --set 'body[0].material.young_modulus=stiff'",
                   "--set body[0].material.young_modulus=stiff: [body.material] young_modulus: expected a "
                   "number >= 0 Pa, "
                   "found string \"stiff\"");
    expect_refused(command + "good.toml --set body[7].name=x",
                   "--set body[7].name=x: 'body' has 1 entries, counted from 0");
    expect_refused(command + "good.toml --set nonsense", "--set nonsense: expected key=value");
  }
}

TEST_F(Program, RefusesMalformedCommandLines) {
  expect_refused("", "A subcommand is required");
  expect_refused("chek case.toml", "unknown command 'chek'; did you mean 'check'?");
  expect_refused("check", "case is required");
  expect_refused("check a.toml b.toml", "The following argument was not expected: b.toml");
  expect_refused("--fast", "");
  expect_refused("describe materiel", "describe: unknown kind or name 'materiel'; did you mean 'material'?");
  expect_refused("describe material henky",
                 "describe material: unknown name 'henky'; did you mean 'hencky'?");
  expect_refused("describe material --markdown", "describe: --markdown writes everything and takes no kind");
  expect_refused("template", "kind is required");
  expect_refused("template explict", "template: unknown word 'explict'; did you mean 'explicit'?");
  expect_refused("picture nowhere", "nowhere: there is no such folder");
  expect_refused("verify no.such-table", "verify: unknown id 'no.such-table'");
}

TEST_F(Program, DescribesAndWritesTemplates) {
  for (const std::string words : {"", "material", "material hencky", "hencky", "grid", "--markdown"}) {
    const Outcome o = wisp("describe " + words);
    EXPECT_EQ(o.status, 0) << o.err;
    EXPECT_EQ(o.err, "");
    EXPECT_GT(o.out.size(), 100u) << words;
  }
  const Outcome o =
      wisp("template quasi-static 3d > t.toml && '" + std::string(WISP_PROGRAM) + "' check t.toml");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_NE(o.out.find("valid. 3 dimensions"), std::string::npos);
  EXPECT_EQ(wisp("--help").status, 0);
  EXPECT_EQ(wisp("check --help").status, 0);
  EXPECT_EQ(wisp("--version").out.rfind("wisp ", 0), 0u);
}

}  // namespace
}  // namespace wisp
