// The strict reader: every member type, every complaint.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "io/toml_reader.h"

namespace wisp {
namespace {

enum class Mass { lumped, consistent };

}  // namespace
template <>
inline constexpr auto choices<Mass> = choice_list<Mass>({{"lumped", Mass::lumped},
                                                         {"consistent", Mass::consistent}});
namespace {

struct Elastic {
  double young_modulus = 0.0;
  double poisson_ratio = 0.3;
  static constexpr std::string_view name = "elastic";
  static constexpr std::string_view summary = "Linear elasticity";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    return std::tuple{
        key("young_modulus", &Elastic::young_modulus, "Pa", "Young's modulus").at_least(0.0).required(),
        key("poisson_ratio", &Elastic::poisson_ratio, "-", "Poisson's ratio").above(-1.0).below(0.5)};
  }
};

struct Plastic {
  double yield_stress = 1.0;
  static constexpr std::string_view name = "von-mises";
  static constexpr std::string_view summary = "Plasticity";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    return std::tuple{key("yield_stress", &Plastic::yield_stress, "Pa", "yield stress").positive()};
  }
};

using Law = std::variant<Elastic, Plastic>;

struct Part {
  std::string label;
  Law material;
  std::vector<double> velocity;
  static constexpr std::string_view name = "part";
  static constexpr std::string_view summary = "A part";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    return std::tuple{
        key("name", &Part::label, "", "its name").required(), key("material", &Part::material, "", "its law"),
        key("velocity", &Part::velocity, "m/s", "initial velocity").per_direction().at_most(100.0)};
  }
};

struct Root {
  int dimension = 2;
  bool flag = false;
  std::int64_t seed = 1;
  int count = 3;
  double length = 1.5;
  std::string title = "none";
  std::vector<int> cells{1};
  std::vector<std::string> fields;
  std::vector<std::vector<double>> outline;
  Mass mass = Mass::lumped;
  Curve gravity{9.81};
  std::optional<double> step;
  std::string mesh;
  std::optional<Elastic> ground;
  std::vector<Part> parts;
  std::vector<Law> laws;
  static constexpr std::string_view name = "root";
  static constexpr std::string_view summary = "Everything";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    return std::tuple{key("dimension", &Root::dimension, "-", "directions").at_least(2).at_most(3),
                      key("flag", &Root::flag, "", "a switch"),
                      key("seed", &Root::seed, "-", "a seed"),
                      key("count", &Root::count, "-", "a count").at_least(1),
                      key("length", &Root::length, "m", "a length").positive(),
                      key("title", &Root::title, "", "a title"),
                      key("cells", &Root::cells, "-", "cells").at_least(1).per_direction(),
                      key("fields", &Root::fields, "", "fields").may_be_empty(),
                      key("outline", &Root::outline, "m", "points").at_least(-1.0).per_direction(),
                      key("mass", &Root::mass, "", "mass matrix"),
                      key("gravity", &Root::gravity, "m/s^2", "gravity").at_most(1000.0),
                      key("step", &Root::step, "s", "time step").positive(),
                      key("mesh", &Root::mesh, "", "a file").existing_file(),
                      key("ground", &Root::ground, "", "the ground"),
                      key("part", &Root::parts, "", "parts"),
                      key("law", &Root::laws, "", "laws")};
  }
};

Root read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const TomlFile file =
      parse_toml_text(text, "case.toml", std::filesystem::path(WISP_SOURCE_DIR) / "tests/io", overrides);
  Context context(file);
  return read_root<Root>(file, context);
}

std::string complaint(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    read(text, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no error)";
}

TEST(Reader, ReadsEveryMemberType) {
  const Root r = read(R"(dimension = 3
flag = true
seed = 9007199254740993
count = 7
length = 2
title = "t"
cells = [1, 2, 3]
fields = ["a", "b"]
outline = [[0, 0.5, 1], [1, 2, 3], [4]]
mass = "consistent"
gravity = [[0, 0], [1.5, 10.0]]
step = 0.25
mesh = "test_reader_values.cpp"
[ground]
young_modulus = 5
[[part]]
name = "p"
velocity = [1, 2.5, 3]
material = { type = "von-mises", yield_stress = 4.0 }
[[part]]
name = "q"
[[law]]
type = "elastic"
young_modulus = 1e6
)");
  EXPECT_EQ(r.dimension, 3);
  EXPECT_TRUE(r.flag);
  EXPECT_EQ(r.seed, 9007199254740993);
  EXPECT_EQ(r.count, 7);
  EXPECT_EQ(r.length, 2.0);
  EXPECT_EQ(r.title, "t");
  EXPECT_EQ(r.cells, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(r.fields, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(r.outline[1][2], 3.0);
  EXPECT_EQ(r.mass, Mass::consistent);
  EXPECT_DOUBLE_EQ(r.gravity(0.75), 5.0);
  EXPECT_EQ(r.step, 0.25);
  EXPECT_EQ(r.mesh, "test_reader_values.cpp");  // the reader checked that it exists
  EXPECT_EQ(r.ground->young_modulus, 5.0);
  ASSERT_EQ(r.parts.size(), 2u);
  EXPECT_EQ(std::get<Plastic>(r.parts[0].material).yield_stress, 4.0);
  EXPECT_EQ(r.parts[0].velocity, (std::vector<double>{1, 2.5, 3}));
  EXPECT_EQ(std::get<Elastic>(r.laws[0]).young_modulus, 1e6);
}

TEST(Reader, KeepsDefaults) {
  const Root r = read("");
  EXPECT_EQ(r.count, 3);
  EXPECT_FALSE(r.step.has_value());
  EXPECT_FALSE(r.ground.has_value());
  EXPECT_EQ(r.gravity(5.0), 9.81);
  EXPECT_TRUE(read("fields = []").fields.empty());
}

struct Complaint {
  const char* text;
  const char* message;
};

class Malformed : public testing::TestWithParam<Complaint> {};

TEST_P(Malformed, SaysWhatAndWhere) { EXPECT_EQ(complaint(GetParam().text), GetParam().message); }

INSTANTIATE_TEST_SUITE_P(
    Reader, Malformed,
    testing::Values(
        Complaint{"flag = 1", "case.toml:1:8: flag: expected true or false, found integer 1"},
        Complaint{"seed = 1.5", "case.toml:1:8: seed: expected an integer, found number 1.5"},
        Complaint{"count = 0", "case.toml:1:9: count: expected an integer >= 1, found integer 0"},
        Complaint{"count = 3000000000", "case.toml:1:9: count: the integer 3000000000 is too large"},
        Complaint{"dimension = 4",
                  "case.toml:1:13: dimension: expected an integer in [2, 3], found integer 4"},
        Complaint{"\n\nlength = 0.0", "case.toml:3:10: length: expected a number > 0 m, found number 0.0"},
        Complaint{"length = nan", "case.toml:1:10: length: expected a finite number > 0 m, found number nan"},
        Complaint{"length = inf", "case.toml:1:10: length: expected a finite number > 0 m, found number inf"},
        Complaint{"length = true", "case.toml:1:10: length: expected a number > 0 m, found boolean true"},
        Complaint{"length = 1979-05-27",
                  "case.toml:1:10: length: expected a number > 0 m, found a date or time"},
        Complaint{"length = []", "case.toml:1:10: length: expected a number > 0 m, found an empty list"},
        Complaint{"lenght = 1.0", "case.toml:1:1: unknown key 'lenght'; did you mean 'length'?"},
        Complaint{"title = 3", "case.toml:1:9: title: expected a text in quotes, found integer 3"},
        Complaint{"title = ''", "case.toml:1:9: title: expected a text, found an empty one"},
        Complaint{"cells = 3", "case.toml:1:9: cells: expected a list of integers >= 1, found integer 3"},
        Complaint{"cells = []",
                  "case.toml:1:9: cells: expected a list of integers >= 1, found an empty list"},
        Complaint{"dimension = 2\ncells = [1,2,3]",
                  "case.toml:2:9: cells: expected a list of 2 integers >= 1 (one for each direction), found "
                  "a list of 3"},
        Complaint{"cells = [1, 0]", "case.toml:1:13: cells[1]: expected an integer >= 1, found integer 0"},
        Complaint{"cells = [1, 2.5]", "case.toml:1:13: cells[1]: expected an integer >= 1, found number 2.5"},
        Complaint{"fields = ['a', 1]",
                  "case.toml:1:16: fields[1]: expected a text in quotes, found integer 1"},
        Complaint{"fields = 'a'", "case.toml:1:10: fields: expected a list of texts, found string \"a\""},
        Complaint{"dimension = 2\noutline = [[0.0], [1.0], [2.0]]",
                  "case.toml:2:11: outline: expected a list of 2 lists (one for each direction), found a "
                  "list of 3"},
        Complaint{"outline = [[0.0, -2.0]]",
                  "case.toml:1:18: outline[0][1]: expected a number >= -1 m, found number -2.0"},
        Complaint{"outline = [1.0]",
                  "case.toml:1:12: outline[0]: expected a list of numbers >= -1 m, found number 1.0"},
        Complaint{"mass = 'lump'",
                  "case.toml:1:8: mass: expected one of \"lumped\", \"consistent\", found string \"lump\"; "
                  "did you mean "
                  "\"lumped\"?"},
        Complaint{"mass = 2",
                  "case.toml:1:8: mass: expected one of \"lumped\", \"consistent\", found integer 2"},
        Complaint{"gravity = 'down'",
                  "case.toml:1:11: gravity: expected a number <= 1000 m/s^2, or a list of [time, value] "
                  "pairs, found string "
                  "\"down\""},
        Complaint{"gravity = [[0, 1], [0, 2]]",
                  "case.toml:1:21: gravity[1]: times must increase: 0 s follows 0 s"},
        Complaint{"gravity = [[0, 1], [1]]",
                  "case.toml:1:20: gravity[1]: expected a pair [time, value], found a list of 1"},
        Complaint{"gravity = [[0, 1001]]",
                  "case.toml:1:16: gravity[0] value: expected a number <= 1000 m/s^2, found integer 1001"},
        Complaint{"step = -1", "case.toml:1:8: step: expected a number > 0 s, found integer -1"},
        Complaint{"ground = 1", "case.toml:1:10: ground: expected a table, found integer 1"},
        Complaint{"[ground]\npoisson_ratio = 0.1",
                  "case.toml:1:1: [ground] missing key 'young_modulus' (Pa): Young's modulus"},
        Complaint{"[ground]\nyoung_modulus = 1\npoisson_ratio = 0.5",
                  "case.toml:3:17: [ground] poisson_ratio: expected a number in (-1, 0.5), found number 0.5"},
        Complaint{"[[ground]]\nyoung_modulus = 1",
                  "case.toml:1:1: ground: expected one table [ground], found a list of tables [[ground]]"},
        Complaint{"[part]\nname = 'a'",
                  "case.toml:1:1: [part] expected a list of tables [[part]], found one table [part]"},
        Complaint{"part = []",
                  "case.toml:1:8: [part] expected at least one table [[part]], found an empty list"},
        Complaint{"part = [1]", "case.toml:1:9: [part] expected a table, found integer 1"},
        Complaint{
            "[[part]]\nname = 'a'\nmaterial.young_modulus = 1.0",
            "case.toml:3:1: [part.material] missing key 'type': expected one of \"elastic\", \"von-mises\""},
        Complaint{
            "[[part]]\nname = 'a'\n[part.material]\ntype = 'von-misses'",
            "case.toml:4:8: [part.material] type: expected one of \"elastic\", \"von-mises\", found string "
            "\"von-misses\"; did you mean \"von-mises\"?"},
        Complaint{
            "[[part]]\nname = 'a'\n[part.material]\ntype = 'elastic'\nyoung_modulus = 'x'",
            "case.toml:5:17: [part.material] young_modulus: expected a number >= 0 Pa, found string \"x\""},
        Complaint{"[[part]]\nname = 'a'\n[part.material]\ntype = 'elastic'\nyield_stress = 1.0",
                  "case.toml:5:1: [part.material] unknown key 'yield_stress'; valid: type, young_modulus, "
                  "poisson_ratio"},
        Complaint{"[[part]]\nvelocity = [1.0, 2.0]", "case.toml:1:1: [part] missing key 'name': its name"},
        Complaint{"dimension = 3\n[[part]]\nname = 'a'\nvelocity = [1.0, 101.0, 3.0]",
                  "case.toml:4:18: [part] velocity[1]: expected a number <= 100 m/s, found number 101.0"},
        Complaint{"length = 1.0\nlength = 2.0",
                  "case.toml:2:10: not valid TOML: Error while parsing key-value pair: cannot "
                  "redefine existing floating-point 'length'"}));

TEST(Reader, NamesTheFileItLookedFor) {
  const std::string text = complaint("mesh = 'nowhere.csv'");
  EXPECT_EQ(text.rfind("case.toml:1:8: mesh: no file 'nowhere.csv' (looked for ", 0), 0u) << text;
}

TEST(Reader, ReportsTheFirstUnknownKeyOfTheFile) {
  EXPECT_EQ(complaint("zebra = 1\nalpha = 2").rfind("case.toml:1:1: unknown key 'zebra'", 0), 0u);
}

TEST(Overrides, SetValuesTablesAndEntries) {
  const std::string text = "count = 2\n[[part]]\nname = 'a'\nvelocity = [1.0, 2.0]\n";
  const Root r = read(text, {"count=5", "part[0].velocity[1]=7.5", "part[0].material.type=von-mises",
                             "ground={young_modulus=3.0}", "title=two words", "fields=[\"x\"]"});
  EXPECT_EQ(r.count, 5);
  EXPECT_EQ(r.parts[0].velocity[1], 7.5);
  EXPECT_TRUE(std::holds_alternative<Plastic>(r.parts[0].material));
  EXPECT_EQ(r.ground->young_modulus, 3.0);
  EXPECT_EQ(r.title, "two words");
  EXPECT_EQ(r.fields, std::vector<std::string>{"x"});
}

TEST(Overrides, ComplainByTheirName) {
  const std::string shape =
      ": expected key=value such as grid.cells=[10,20] or body[0].material.density=1000";
  const std::string part = "[[part]]\nname = 'a'\n";
  EXPECT_EQ(complaint("", {"count"}), "--set count" + shape);
  EXPECT_EQ(complaint("", {"=3"}), "--set =3" + shape);
  EXPECT_EQ(complaint("", {"a..b=3"}), "--set a..b=3" + shape);
  EXPECT_EQ(complaint("", {"a.=3"}), "--set a.=3" + shape);
  EXPECT_EQ(complaint("", {"a[x]=3"}), "--set a[x]=3" + shape);
  EXPECT_EQ(complaint("", {"[0]=3"}), "--set [0]=3" + shape);
  EXPECT_EQ(complaint(part, {"part[1].name=b"}),
            "--set part[1].name=b: 'part' has 1 entries, counted from 0");
  EXPECT_EQ(complaint("", {"part[0].name=b"}), "--set part[0].name=b: there is no list 'part'");
  EXPECT_EQ(complaint("count = 1", {"count.x=1"}), "--set count.x=1: 'count' is not a table");
  EXPECT_EQ(complaint("count = 1", {"count[0]=1"}), "--set count[0]=1: 'count' is not a list");
  EXPECT_EQ(complaint("", {"cuont=1"}), "--set cuont=1: unknown key 'cuont'; did you mean 'count'?");
  EXPECT_EQ(complaint("", {"count=0"}), "--set count=0: count: expected an integer >= 1, found integer 0");
  EXPECT_EQ(complaint(part, {"part[0].speed=1"}),
            "--set part[0].speed=1: [part] unknown key 'speed'; valid: name, material, velocity");
  EXPECT_EQ(complaint("", {"count=[1"}).rfind("--set count=[1: the value is not TOML: ", 0), 0u);
}

TEST(Context, FindsValuesForChecksAcrossTables) {
  const TomlFile file = parse_toml_text("[[part]]\nname = 'a'\n[[part]]\nname = 'b'\n", "case.toml");
  const Context context(file);
  EXPECT_TRUE(context.given("part[1].name"));
  EXPECT_FALSE(context.given("part[2].name"));
  const auto message = [&](const char* path) {
    try {
      context.fail_at(path, "bad");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message("part[1].name"), "case.toml:4:8: [part] name: bad");
  EXPECT_EQ(message("part[1].material.density"), "case.toml:3:1: [part.material] density: bad");
  EXPECT_EQ(message("part[1]"), "case.toml:3:1: [part] bad");
}

}  // namespace
}  // namespace wisp
