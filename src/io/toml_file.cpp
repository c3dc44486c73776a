// Files, syntax errors and overrides: what happens before the strict reading.
#include <cctype>
#include <fstream>
#include <sstream>

#include "io/toml_reader.h"

namespace wisp {
namespace {

std::string on_one_line(std::string_view text) {
  std::string line;
  for (const char c : text) line += c == '\n' || c == '\r' || c == '\t' ? ' ' : c;
  return line;
}

/// One step of an override's path: a key, or an index into a list.
struct Step {
  std::string key;
  std::int64_t index = -1;
};

bool is_key_letter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
}

/// "a.b[0].c" as steps; empty if malformed.
std::vector<Step> path_steps(std::string_view path) {
  std::vector<Step> steps;
  std::size_t i = 0;
  while (i < path.size()) {
    const std::size_t start = i;
    if (path[i] == '[') {
      std::size_t end = i + 1;
      while (end < path.size() && std::isdigit(static_cast<unsigned char>(path[end])) != 0) ++end;
      if (steps.empty() || end == i + 1 || end - i > 9 || end >= path.size() || path[end] != ']') return {};
      steps.push_back({"", std::stoll(std::string(path.substr(i + 1, end - i - 1)))});
      i = end + 1;
    } else {
      while (i < path.size() && is_key_letter(path[i])) ++i;
      if (i == start) return {};
      steps.push_back({std::string(path.substr(start, i - start)), -1});
    }
    if (i < path.size() && path[i] == '.') {
      if (++i == path.size() || path[i] == '[') return {};
    } else if (i < path.size() && path[i] != '[') {
      return {};
    }
  }
  return steps;
}

/// The value of an override as the document `v = value`, so that its nodes know that they come from the
/// override.
toml::table parse_value(const std::string& value, const std::string& origin) {
  const auto first = value.find_first_not_of(" \t");
  const bool letter =
      first != std::string::npos && std::isalpha(static_cast<unsigned char>(value[first])) != 0;
  const bool constant = value == "true" || value == "false" || value == "inf" || value == "nan";
  if (value.find('\n') != std::string::npos) input_error("{}: expected one line", on_one_line(origin));
  try {
    if (letter && !constant)
      return toml::parse("v = '" + value + "'", origin);  // a bare word: quotes are a shell's burden
    return toml::parse("v = " + value, origin);
  } catch (const toml::parse_error& error) {
    input_error("{}: the value is not TOML: {}", on_one_line(origin), on_one_line(error.description()));
  }
}

template <class Container, class Place>
void put(Container& container, const Place& place, toml::node&& value) {
  value.visit([&](auto&& node) {
    using Node = std::remove_cvref_t<decltype(node)>;
    if constexpr (std::is_same_v<Container, toml::table>)
      container.insert_or_assign(place, Node(std::move(node)));
    else
      container.replace(container.cbegin() + static_cast<std::ptrdiff_t>(place), Node(std::move(node)));
  });
}

}  // namespace

void apply_override(toml::table& root, const std::string& assignment) {
  const std::string origin = "--set " + assignment;
  const auto equals = assignment.find('=');
  const auto steps =
      equals == std::string::npos ? std::vector<Step>{} : path_steps(assignment.substr(0, equals));
  if (steps.empty() || steps.front().key.empty())
    input_error("{}: expected key=value such as grid.cells=[10,20] or body[0].material.density=1000",
                on_one_line(origin));
  toml::table value = parse_value(assignment.substr(equals + 1), origin);

  toml::node* node = &root;
  std::string walked;
  for (std::size_t s = 0; s < steps.size(); ++s) {
    const bool last = s + 1 == steps.size();
    const Step& step = steps[s];
    if (step.index < 0) {
      auto* table = node->as_table();
      if (!table) input_error("{}: '{}' is not a table", on_one_line(origin), walked);
      walked += (walked.empty() ? "" : ".") + step.key;
      if (last) {
        put(*table, toml::key(step.key, value.begin()->first.source()), std::move(*value.get("v")));
        return;
      }
      if (!table->contains(step.key)) {
        if (steps[s + 1].index >= 0) input_error("{}: there is no list '{}'", on_one_line(origin), walked);
        toml::table empty = toml::parse("v = {}", origin);
        put(*table, toml::key(step.key, value.begin()->first.source()), std::move(*empty.get("v")));
      }
      node = table->get(step.key);
    } else {
      auto* list = node->as_array();
      if (!list) input_error("{}: '{}' is not a list", on_one_line(origin), walked);
      if (step.index >= static_cast<std::int64_t>(list->size()))
        input_error("{}: '{}' has {} entries, counted from 0", on_one_line(origin), walked, list->size());
      walked += "[" + std::to_string(step.index) + "]";
      if (last) {
        put(*list, step.index, std::move(*value.get("v")));
        return;
      }
      node = list->get(static_cast<std::size_t>(step.index));
    }
  }
}

TomlFile parse_toml_text(std::string text, std::string name, std::filesystem::path folder,
                         const std::vector<std::string>& overrides) {
  TomlFile file{std::move(name), std::move(folder), std::move(text), overrides, {}};
  try {
    file.root = toml::parse(file.text, std::string_view(file.name));
  } catch (const toml::parse_error& error) {
    const auto at = error.source().begin;
    input_error("{}:{}:{}: not valid TOML: {}", file.name, at.line, at.column,
                on_one_line(error.description()));
  }
  for (const auto& assignment : overrides) apply_override(file.root, assignment);
  return file;
}

TomlFile parse_toml_file(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    input_error("{}: expected a case file, found a folder", path.string());
  std::ifstream stream(path, std::ios::binary);
  if (!stream) input_error("{}: cannot read this file", path.string());
  std::ostringstream text;
  text << stream.rdbuf();
  auto folder = path.parent_path();
  return parse_toml_text(std::move(text).str(), path.string(), folder.empty() ? "." : folder, overrides);
}

}  // namespace wisp
