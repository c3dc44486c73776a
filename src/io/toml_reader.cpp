#include "io/toml_reader.h"

#include <cmath>

#include "core/nearest.h"
#include "io/toml_text.h"

namespace wisp {
namespace {

/// The part before the colon of a message: file:line:column, or the override that the value came from.
std::string position(const toml::source_region& at, const std::string& file) {
  if (at.path && at.path->rfind("--set", 0) == 0) return *at.path;
  if (at.begin.line == 0) return file;
  return fmt::format("{}:{}:{}", file, at.begin.line, at.begin.column);
}

}  // namespace

void Context::fail(const toml::source_region& at, std::string_view key, const std::string& message) const {
  std::string where;
  for (const auto& name : where_) where += (where.empty() ? "" : ".") + name;
  std::string text = position(at, file_->name) + ": ";
  if (!where.empty()) text += "[" + where + "] ";
  if (!key.empty()) text += std::string(key) + ": ";
  throw InputError(text + message);
}

bool Context::given(std::string_view path) const { return static_cast<bool>(file_->root.at_path(path)); }

void Context::fail_at(std::string_view path, const std::string& message) const {
  std::string around(path);
  toml::source_region at = file_->root.source();
  while (!around.empty()) {
    if (const auto node = file_->root.at_path(around)) {
      at = node.node()->source();
      break;
    }
    const auto end = around.find_last_of(".[");
    around.resize(end == std::string::npos ? 0 : end);
  }
  // "body[1].shape.radius" reads "[body.shape] radius", as the reader's own messages do; an index at the end
  // stays.
  const auto dot = path.find_last_of('.');
  std::string table(dot == std::string_view::npos ? std::string_view{} : path.substr(0, dot));
  std::string key(dot == std::string_view::npos ? path : path.substr(dot + 1));
  if (const auto node = file_->root.at_path(path); node && node.is_table()) {
    table = path;
    key.clear();
  }
  std::string where;
  bool in_index = false;
  for (const char c : table) {
    if (c == '[') in_index = true;
    if (!in_index) where += c;
    if (c == ']') in_index = false;
  }
  Context bare(*file_);
  if (!where.empty()) bare.where_.push_back(where);
  bare.fail(at, key, message);
}

namespace reader {

std::string found(const toml::node& node) {
  if (const auto* s = node.as_string()) {
    std::string text = s->get();
    if (text.size() > 40) text = text.substr(0, 37) + "...";
    return "string " + toml_text(text);
  }
  if (const auto* i = node.as_integer()) return fmt::format("integer {}", i->get());
  if (const auto* d = node.as_floating_point()) return fmt::format("number {}", toml_text(d->get()));
  if (const auto* b = node.as_boolean()) return fmt::format("boolean {}", b->get());
  if (const auto* a = node.as_array())
    return a->empty() ? "an empty list" : fmt::format("a list of {}", a->size());
  if (node.is_table()) return "a table";
  return "a date or time";
}

}  // namespace reader

std::string range_text(const KeyRules& rules) {
  const bool low = std::isfinite(rules.least), high = std::isfinite(rules.most);
  if (low && high)
    return fmt::format("in {}{}, {}{}", rules.least_excluded ? "(" : "[", rules.least, rules.most,
                       rules.most_excluded ? ")" : "]");
  if (low) return fmt::format("{} {}", rules.least_excluded ? ">" : ">=", rules.least);
  if (high) return fmt::format("{} {}", rules.most_excluded ? "<" : "<=", rules.most);
  return {};
}

namespace reader {

std::string expectation(const KeyRules& rules, std::string_view noun) {
  const std::string range = range_text(rules);
  std::string text(noun);
  if (!range.empty()) text += " " + range;
  if (!rules.unit.empty() && rules.unit != "-")
    text += fmt::format("{} {}", range.empty() ? " in" : "", rules.unit);
  return text;
}

namespace {

/// "a number ...", "an integer ...".
std::string one(const KeyRules& rules, std::string_view noun) {
  return (noun == "integer" ? "an " : "a ") + expectation(rules, noun);
}

[[noreturn]] void wrong(const toml::node& node, std::string_view key, const std::string& expected,
                        const Context& context) {
  context.fail(node.source(), key, fmt::format("expected {}, found {}", expected, found(node)));
}

int wanted_length(const KeyRules& rules, const Context& context) {
  return rules.is_per_direction ? context.dimension : rules.length;
}

std::string list_phrase(const KeyRules& rules, std::string_view noun, const Context& context) {
  const int n = wanted_length(rules, context);
  const std::string text =
      n > 0 ? fmt::format("a list of {} {}s", n, noun) : fmt::format("a list of {}s", noun);
  const bool number = noun == "number" || noun == "integer";
  return number ? expectation(rules, text) : text;
}

}  // namespace

void check_number(double value, const KeyRules& rules, std::string_view noun, std::string_view key,
                  const toml::node& at, const Context& context) {
  if (!std::isfinite(value)) wrong(at, key, "a finite " + expectation(rules, noun), context);
  const bool low = rules.least_excluded ? value <= rules.least : value < rules.least;
  const bool high = rules.most_excluded ? value >= rules.most : value > rules.most;
  if (low || high) wrong(at, key, one(rules, noun), context);
}

bool read_bool(const toml::node& node, std::string_view key, const Context& context) {
  const auto* value = node.as_boolean();
  if (!value) wrong(node, key, "true or false", context);
  return value->get();
}

std::int64_t read_integer(const toml::node& node, const KeyRules& rules, std::string_view key,
                          const Context& context) {
  const auto* value = node.as_integer();
  if (!value) wrong(node, key, one(rules, "integer"), context);
  check_number(static_cast<double>(value->get()), rules, "integer", key, node, context);
  return value->get();
}

double read_number(const toml::node& node, const KeyRules& rules, std::string_view key,
                   const Context& context) {
  const auto value = node.is_number() ? node.value<double>() : std::optional<double>{};
  if (!value) wrong(node, key, one(rules, "number"), context);
  check_number(*value, rules, "number", key, node, context);
  return *value;
}

std::string read_text(const toml::node& node, const KeyRules& rules, std::string_view key,
                      const Context& context) {
  const auto* value = node.as_string();
  if (!value) wrong(node, key, rules.is_existing_file ? "the name of a file" : "a text in quotes", context);
  std::string text = value->get();
  if (text.empty() && !rules.is_empty_allowed)
    context.fail(node.source(), key, "expected a text, found an empty one");
  if (rules.is_existing_file && !text.empty()) {
    const auto file = context.file().folder / text;  // an absolute name stays what it is
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
      context.fail(node.source(), key,
                   fmt::format("no file '{}' (looked for {})", text, file.lexically_normal().string()));
  }
  return text;
}

Curve read_curve(const toml::node& node, const KeyRules& rules, std::string_view key,
                 const Context& context) {
  if (node.is_number()) return Curve(read_number(node, rules, key, context));
  const std::string expected = one(rules, "number") + ", or a list of [time, value] pairs";
  const auto* list = node.as_array();
  if (!list || list->empty()) wrong(node, key, expected, context);
  Curve curve;
  curve.times.clear();
  curve.values.clear();
  const KeyRules time_rules{.name = "time", .unit = "s", .meaning = ""};
  for (const auto& entry : *list) {
    const std::string name = fmt::format("{}[{}]", key, curve.times.size());
    const auto* pair = entry.as_array();
    if (!pair || pair->size() != 2) wrong(entry, name, "a pair [time, value]", context);
    const double time = read_number((*pair)[0], time_rules, name + " time", context);
    if (!curve.times.empty() && time <= curve.times.back())
      context.fail((*pair)[0].source(), name,
                   fmt::format("times must increase: {} s follows {} s", time, curve.times.back()));
    curve.times.push_back(time);
    curve.values.push_back(read_number((*pair)[1], rules, name + " value", context));
  }
  return curve;
}

const toml::array& read_list(const toml::node& node, const KeyRules& rules, std::string_view noun,
                             std::string_view key, const Context& context) {
  const auto* list = node.as_array();
  if (!list) wrong(node, key, list_phrase(rules, noun, context), context);
  if (list->empty() && !rules.is_empty_allowed) wrong(node, key, list_phrase(rules, noun, context), context);
  const int n = wanted_length(rules, context);
  if (n > 0 && !list->empty() && static_cast<int>(list->size()) != n) {
    const std::string why = rules.is_per_direction ? " (one for each direction)" : "";
    wrong(node, key, list_phrase(rules, noun, context) + why, context);
  }
  return *list;
}

const toml::table& read_subtable(const toml::node& node, std::string_view key, const Context& context) {
  const auto* table = node.as_table();
  if (table) return *table;
  if (node.is_array_of_tables())
    context.fail(node.source(), key,
                 fmt::format("expected one table [{}], found a list of tables [[{}]]", key, key));
  wrong(node, key, "a table", context);
}

const toml::array& read_tables(const toml::node& node, const KeyRules& rules, std::string_view key,
                               const Context& context) {
  if (node.is_table())
    context.fail(node.source(), "",
                 fmt::format("expected a list of tables [[{}]], found one table [{}]", key, key));
  const auto* list = node.as_array();
  if (!list)
    context.fail(node.source(), "", fmt::format("expected tables [[{}]], found {}", key, found(node)));
  if (list->empty() && !rules.is_empty_allowed)
    context.fail(node.source(), "",
                 fmt::format("expected at least one table [[{}]], found an empty list", key));
  for (const auto& entry : *list)
    if (!entry.is_table())
      context.fail(entry.source(), "", fmt::format("expected a table, found {}", found(entry)));
  return *list;
}

namespace {

std::string quoted(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + toml_text(name);
  return text;
}

}  // namespace

int read_choice(const toml::node& node, const std::vector<std::string>& names, std::string_view key,
                const Context& context) {
  const std::string expected = (names.size() == 1 ? "" : "one of ") + quoted(names);
  const auto* value = node.as_string();
  if (!value) wrong(node, key, expected, context);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == value->get()) return static_cast<int>(i);
  std::string hint;
  if (const std::string best = nearest(value->get(), names); !best.empty())
    hint = "; did you mean " + toml_text(best) + "?";
  context.fail(node.source(), key, fmt::format("expected {}, found {}{}", expected, found(node), hint));
}

int read_type(const toml::table& table, const std::vector<std::string>& names, int otherwise,
              const Context& context) {
  if (const toml::node* node = table.get("type")) return read_choice(*node, names, "type", context);
  for (auto&& [name, node] : table)
    if (edit_distance(name.str(), "type") == 1)
      context.fail(name.source(), "", fmt::format("unknown key '{}'; did you mean 'type'?", name.str()));
  if (otherwise >= 0) return otherwise;
  context.fail(table.source(), "", fmt::format("missing key 'type': expected one of {}", quoted(names)));
}

void check_keys(const toml::table& table, const std::vector<std::string>& valid, const Context& context) {
  // In the order of the file, not of the alphabet: the first mistake is the one that is reported.
  const toml::key* first = nullptr;
  for (auto&& [name, node] : table) {
    bool known = false;
    for (const auto& v : valid) known = known || v == name.str();
    if (known) continue;
    if (!first || name.source().begin < first->source().begin) first = &name;
  }
  if (first)
    context.fail(first->source(), "",
                 fmt::format("unknown key '{}'{}", first->str(), suggestion(first->str(), valid)));
}

void missing(const toml::table& table, const KeyRules& rules, const Context& context) {
  const std::string unit = rules.unit.empty() || rules.unit == "-" ? "" : fmt::format(" ({})", rules.unit);
  context.fail(table.source(), "", fmt::format("missing key '{}'{}: {}", rules.name, unit, rules.meaning));
}

}  // namespace reader
}  // namespace wisp
