#include "io/case.h"

#include <algorithm>

#include "core/nearest.h"
#include "io/toml_reader.h"

namespace wisp {
namespace {

Case from_toml(const TomlFile& file) {
  Context context(file);
  Case c = read_root<Case>(file, context);
  check_case(c, context);
  c.file = {file.name, file.folder, file.text, file.overrides};
  return c;
}

}  // namespace

Case read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return from_toml(parse_toml_file(file, overrides));
}

Case read_case(const CaseSource& source) {
  return from_toml(parse_toml_text(source.text, source.name, source.folder, source.overrides));
}

std::filesystem::path default_output_folder(const Case& c) {
  if (!c.output.folder.empty()) return c.output.folder;
  std::filesystem::path name = std::filesystem::path(c.file.name).stem();
  if ((name.empty() || name == "case") && !c.file.folder.empty()) {  // named after nothing but its kind
    const auto folder = std::filesystem::absolute(c.file.folder).lexically_normal();
    name = folder.has_filename() ? folder.filename() : folder.parent_path().filename();
  }
  return std::filesystem::path("results") / (name.empty() ? std::filesystem::path("case") : name);
}

const TypeText& case_description() {
  static const TypeText description = describe_type<Case>();
  return description;
}

namespace {

/// Values that make templates run: a block of 1 m on the lower left of the grid, standing on its base.
std::string sample(const std::string& path, bool spatial) {
  const auto pick = [&](const char* flat, const char* solid) { return std::string(spatial ? solid : flat); };
  static constexpr std::pair<std::string_view, std::pair<const char*, const char*>> samples[] = {
      {"title", {"\"A block under its own weight\"", "\"A block under its own weight\""}},
      {"dimension", {"2", "3"}},
      {"grid.lower", {"[0.0, 0.0]", "[0.0, 0.0, 0.0]"}},
      {"grid.upper", {"[2.0, 2.0]", "[2.0, 2.0, 2.0]"}},
      {"grid.cells", {"[8, 8]", "[8, 8, 8]"}},
      {"grid.outline.vertices",
       {"[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]",
        "[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]"}},
      {"grid.spacing", {"0.25", "0.25"}},
      {"body.name", {"\"block\"", "\"block\""}},
      {"body.shape.lower", {"[0.0, 0.0]", "[0.0, 0.0, 0.0]"}},
      {"body.shape.upper", {"[1.0, 1.0]", "[1.0, 1.0, 1.0]"}},
      {"body.shape.centre", {"[0.5, 0.5]", "[0.5, 0.5, 0.5]"}},
      {"body.shape.radius", {"0.5", "0.5"}},
      {"body.shape.vertices",
       {"[[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]]", "[[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]]"}},
      {"body.material.density", {"1000.0", "1000.0"}},
      {"body.material.young_modulus", {"1e6", "1e6"}},
      {"stage.duration", {"1.0", "1.0"}},
      {"boundary.name", {"\"base\"", "\"base\""}},
      {"boundary.normal", {"\"y\"", "\"z\""}},
      {"boundary.at", {"0.0", "0.0"}},
      {"boundary.directions", {"[\"x\", \"y\"]", "[\"x\", \"y\", \"z\"]"}},
      {"load.name", {"\"push\"", "\"push\""}},
      {"load.body", {"\"block\"", "\"block\""}},
      {"load.nearest", {"[[1.0, 1.0]]", "[[1.0, 1.0, 1.0]]"}},
      {"load.force", {"[0.0, -10.0]", "[0.0, 0.0, -10.0]"}},
      {"load.corner", {"[1.0, 1.0]", "[0.0, 0.0, 1.0]"}},
      {"load.edges", {"[[-1.0, 0.0]]", "[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]"}},
      {"load.points", {"[8]", "[8, 8]"}},
      {"load.traction", {"[0.0, -100.0]", "[0.0, 0.0, -100.0]"}},
      {"gravity.acceleration", {"[0.0, -9.81]", "[0.0, 0.0, -9.81]"}},
      {"output.track.name", {"\"corner\"", "\"corner\""}},
      {"output.track.body", {"\"block\"", "\"block\""}},
      {"output.track.nearest", {"[1.0, 1.0]", "[1.0, 1.0, 1.0]"}},
  };
  for (const auto& [name, texts] : samples)
    if (name == path) return pick(texts.first, texts.second);
  return {};
}

}  // namespace

std::string case_template(const std::vector<std::string>& words) {
  std::vector<std::string> chosen;
  bool spatial = false;
  std::vector<std::string> valid{"2d", "3d"};
  for (const auto& kind : kinds_of(case_description())) {
    valid.push_back(kind.name);
    for (const auto& type : kind.types) valid.push_back(type.name);
  }
  for (const auto& word : words) {
    if (word == "2" || word == "2d") continue;
    if (word == "3" || word == "3d") {
      spatial = true;
      continue;
    }
    if (std::find(valid.begin(), valid.end(), word) == valid.end())
      input_error("template: unknown word '{}'{}", word, suggestion(word, valid));
    chosen.push_back(word);
  }
  const std::vector<std::string> always{"boundary", "gravity"};  // or nothing would happen
  chosen.insert(chosen.end(), always.begin(), always.end());
  const Sample of_dimension = spatial ? Sample([](const std::string& p) { return sample(p, true); })
                                      : Sample([](const std::string& p) { return sample(p, false); });
  return "# A case for Wisp: `wisp check` it, `wisp run` it. Lines with a key behind '#' may be left out: "
         "they show\n"
         "# the default, or an example where nothing is assumed.\n\n" +
         template_text(case_description(), chosen, of_dimension);
}

}  // namespace wisp
