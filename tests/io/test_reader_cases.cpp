// Malformed cases: what is said, and where. Each is the good case below with one thing changed.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include <filesystem>

#include "io/malformed.h"

namespace wisp {
namespace {

const std::string good = R"(title = "two bodies"
dimension = 2
[grid]
lower = [0.0, 0.0]
upper = [4.0, 2.0]
cells = [8, 4]
[basis]
type = "gimp"
[[body]]
name = "left"
velocity = [1.0, 0.0]
[body.shape]
type = "box"
lower = [0.5, 0.5]
upper = [1.5, 1.5]
[body.material]
type = "hencky"
density = 1000.0
young_modulus = 1e6
[[body]]
name = "right"
[body.shape]
type = "ball"
centre = [3.0, 1.0]
radius = 0.5
[body.sampling]
points_per_cell = 3
[body.material]
type = "von-mises"
density = 1000
young_modulus = 1e6
yield_stress = 1e4
[[boundary]]
name = "base"
normal = "y"
at = 0.0
directions = ["x", "y"]
[[load]]
name = "push"
body = "left"
nearest = [[0.5, 0.5]]
force = [1.0, 0.0]
factor = [[0.0, 0.0], [1.0, 1.0]]
[[load]]
type = "traction"
name = "cover"
body = "left"
corner = [1.5, 1.5]
edges = [[-1.0, 0.0]]
points = [4]
traction = [0.0, -10.0]
[gravity]
acceleration = [0.0, -9.81]
[stabilisation]
mass = 0.25
[[stage]]
type = "quasi-static"
steps = 5
[[stage]]
type = "explicit"
mass = "consistent"
duration = 0.5
cfl = 0.4
[output]
frames = 4
[[output.track]]
name = "tip"
body = "right"
nearest = [3.5, 1.0]
)";

using test::Change;

std::string complaint(const std::string& text) {
  return test::complaint(text, std::filesystem::path(WISP_SOURCE_DIR) / "tests/io");
}

std::string changed(const Change& change) { return test::changed(good, change); }

class MalformedCase : public testing::TestWithParam<Change> {};

TEST_P(MalformedCase, SaysWhatAndWhere) { EXPECT_EQ(complaint(changed(GetParam())), GetParam().message); }

const Change changes[] = {
#include "malformed_cases.inc"
};

INSTANTIATE_TEST_SUITE_P(Case, MalformedCase, testing::ValuesIn(changes));

TEST(Case, NamesAPointFileThatIsMissing) {
  const std::string text = complaint(changed({"type = \"ball\"\ncentre = [3.0, 1.0]\nradius = 0.5",
                                              "type = \"points\"\nfile = \"nowhere.csv\"", ""}));
  EXPECT_EQ(text.rfind("case.toml:22:1: [body.shape] ", 0), 0u) << text;
  EXPECT_NE(text.find("nowhere.csv: no such file"), std::string::npos) << text;
}

TEST(Case, ReadsTheGoodOne) {
  ASSERT_EQ(complaint(good), "(no error)");
  const Case c = read_case(CaseSource{"good.toml", ".", good, {}});
  EXPECT_EQ(c.title, "two bodies");
  EXPECT_TRUE(std::holds_alternative<GimpOptions>(c.basis));
  ASSERT_EQ(c.bodies.size(), 2u);
  EXPECT_EQ(std::get<VonMises>(c.bodies[1].material).yield_stress, 1e4);
  EXPECT_EQ(c.bodies[1].sampling.points_per_cell, 3);
  EXPECT_EQ(std::get<ExplicitOptions>(c.stages[1]).cfl, 0.4);
  EXPECT_DOUBLE_EQ(std::get<PointLoadOptions>(c.loads[0]).factor(0.5), 0.5);
  EXPECT_EQ(c.output.track[0].label, "tip");
  EXPECT_EQ(default_output_folder(c), std::filesystem::path("results/good"));
  EXPECT_EQ(default_output_folder(read_case(CaseSource{"a/beam/case.toml", "a/beam", good, {}})),
            std::filesystem::path("results/beam"));
  EXPECT_EQ(default_output_folder(read_case(CaseSource{"a/beam/thin.toml", "a/beam", good, {}})),
            std::filesystem::path("results/thin"));
  EXPECT_EQ(c.file.text, good);
}

TEST(Case, OverridesAreKeptAndReadAgain) {
  const Case c = read_case(CaseSource{"case.toml", ".", good, {"stage[1].cfl=0.2", "output.folder=here"}});
  EXPECT_EQ(std::get<ExplicitOptions>(c.stages[1]).cfl, 0.2);
  EXPECT_EQ(default_output_folder(c), std::filesystem::path("here"));
  const Case again = read_case(c.file);
  EXPECT_EQ(std::get<ExplicitOptions>(again.stages[1]).cfl, 0.2);
}

TEST(Case, EveryTemplateIsAValidCase) {
  for (const char* stage : {"explicit", "quasi-static", "implicit-dynamic"})
    for (const char* dimension : {"2d", "3d"})
      for (const char* shape : {"box", "ball"})
        for (const char* law : {"linear-elastic", "hencky", "von-mises"}) {
          const std::string text =
              case_template({stage, dimension, shape, law, "gimp", "load", "traction", "track"});
          EXPECT_EQ(complaint(text), "(no error)") << text;
        }
  EXPECT_EQ(complaint(case_template({"quasi-static", "stabilisation", "polygon", "k0"})), "(no error)");
  for (const char* grid : {"triangle-blocks", "delaunay"})
    for (const char* basis : {"linear", "lagrange-quadratic", "powell-sabin", "powell-sabin-cubic"}) {
      const std::string text = case_template({"explicit", grid, basis});
      EXPECT_EQ(complaint(text), "(no error)") << text;
    }
}

TEST(Case, LocalDampingIsRefusedBesideWalls) {
  std::ifstream file(std::string(WISP_SOURCE_DIR) + "/examples/14-incline-with-friction/case.toml");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  ASSERT_EQ(complaint(text), "(no error)");
  const std::string stage = "type = \"explicit\"\n";
  ASSERT_NE(text.find(stage), std::string::npos);
  text.insert(text.find(stage) + stage.size(), "damping = 0.1\n");
  EXPECT_NE(complaint(text).find("[stage] damping: not beside walls"), std::string::npos) << complaint(text);
}

TEST(Case, TrianglesAreCheckedWithTheRest) {
  const std::string sound = case_template({"explicit", "delaunay"});
  const auto with = [&](const std::string& old, const std::string& replacement) {
    std::string text = sound;
    const auto at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return complaint(text.replace(at, old.size(), replacement));
  };
  EXPECT_NE(with("type = \"linear\"", "type = \"gimp\"").find("needs a structured grid"), std::string::npos);
  EXPECT_NE(with("[2.0, 2.0]", "[2.0, -2.0]").find("crosses"), std::string::npos);
  EXPECT_NE(with("normal = \"y\"", "part = \"sied 1\" # ").find("did you mean 'side 1'?"), std::string::npos);
  EXPECT_NE(with("at = 0.0", "at = 0.01").find("no edge of a triangle lies on y = 0.01"), std::string::npos);
  EXPECT_NE(complaint(case_template({"explicit", "powell-sabin"})).find("needs a grid of triangles"),
            std::string::npos);
  EXPECT_NE(complaint(case_template({"explicit", "delaunay", "3d"})).find("2D"), std::string::npos);
}

TEST(Case, TemplatesNameEveryKey) {
  for (const auto& kind : kinds_of(case_description()))
    for (const auto& type : kind.types) {
      const std::string text = case_template({type.name});
      for (const auto& key : type.keys)
        EXPECT_NE(text.find(std::string(key.rules.name)), std::string::npos)
            << type.name << ": " << key.rules.name;
    }
}

TEST(Describe, ListsKindsNamesAndKeys) {
  const auto& root = case_description();
  EXPECT_NE(describe_text(root, {}).find("linear-elastic, hencky, von-mises"), std::string::npos);
  EXPECT_NE(describe_text(root, {"material"}).find("von-mises"), std::string::npos);
  const std::string hencky = describe_text(root, {"material", "hencky"});
  EXPECT_NE(hencky.find("poisson_ratio"), std::string::npos);
  EXPECT_NE(hencky.find("in (-1, 0.5)"), std::string::npos);
  EXPECT_EQ(describe_text(root, {"hencky"}), hencky);
  EXPECT_THROW(describe_text(root, {"materiel"}), InputError);
  EXPECT_THROW(describe_text(root, {"material", "henky"}), InputError);
  EXPECT_THROW(case_template({"hency"}), InputError);
}

TEST(Describe, EveryKeySaysWhatItMeans) {
  for (const auto& kind : kinds_of(case_description()))
    for (const auto& type : kind.types) {
      EXPECT_FALSE(type.summary.empty()) << type.name;
      for (const auto& key : type.keys)
        EXPECT_FALSE(key.rules.meaning.empty()) << type.name << ": " << key.rules.name;
    }
}

TEST(Describe, MarkdownHasARowForEveryKey) {
  const std::string text = describe_markdown(case_description());
  for (const auto& kind : kinds_of(case_description()))
    for (const auto& type : kind.types)
      for (const auto& key : type.keys)
        EXPECT_NE(text.find(fmt::format("| `{}` |", key.rules.name)), std::string::npos) << key.rules.name;
}

}  // namespace
}  // namespace wisp
