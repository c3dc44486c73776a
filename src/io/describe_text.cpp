#include "io/describe_text.h"

#include <algorithm>

#include "core/nearest.h"

namespace wisp {
namespace {

std::string unit_text(const KeyRules& rules) { return rules.unit.empty() ? "" : std::string(rules.unit); }

std::string value_phrase(const KeyText& key) {
  std::string text = key.value;
  if (!key.tables.empty()) text = key.is_list_of_tables ? "tables" : "table";
  if (key.rules.is_per_direction) text += ", one per direction";
  if (key.rules.length > 0) text += fmt::format(", {} entries", key.rules.length);
  if (key.rules.is_existing_file) text = "name of a file";
  return text;
}

std::string default_phrase(const KeyText& key) {
  if (key.rules.is_required) return "required";
  return key.default_toml.empty() ? "-" : key.default_toml;
}

std::string padded(std::string_view text, std::size_t width) {
  return std::string(text) + std::string(text.size() < width ? width - text.size() : 0, ' ');
}

/// Text folded at `width` with following lines indented by `indent`.
std::string folded(std::string_view text, std::size_t indent, std::size_t width) {
  std::string result;
  std::size_t column = indent;
  std::size_t i = 0;
  while (i < text.size()) {
    const auto space = std::min(text.find(' ', i), text.size());
    const std::string_view word = text.substr(i, space - i);
    if (column > indent && column + 1 + word.size() > width) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
    i = space + 1;
  }
  return result;
}

std::string header(const Kind& kind) {
  return kind.is_list_of_tables ? "[[" + kind.name + "]]" : "[" + kind.name + "]";
}

/// Rows of cells with aligned columns; the last column is folded.
std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (widths.size() <= c) widths.push_back(0);
      widths[c] = std::max(widths[c], row[c].size());
    }
  std::size_t indent = 2;
  for (std::size_t c = 0; c + 1 < widths.size(); ++c) indent += widths[c] + 2;
  std::string text;
  for (const auto& row : rows) {
    text += "  ";
    for (std::size_t c = 0; c + 1 < row.size(); ++c) text += padded(row[c], widths[c] + 2);
    text += folded(row.back(), indent, std::max<std::size_t>(indent + 50, 120)) + "\n";
  }
  return text;
}

std::string type_text(const Kind& kind, const TypeText& type) {
  std::string text = fmt::format("{} {}: {}\n", header(kind),
                                 kind.is_variant ? "type = " + toml_text(type.name) : "", type.summary);
  if (!kind.is_variant)  // the whole file has no header of its own
    text = fmt::format("{}: {}\n", kind.name == type.name && kind.name == "case" ? kind.name : header(kind),
                       type.summary);
  if (type.name == kind.default_type) text += "The type where the key 'type' is left out.\n";
  if (!type.source.empty()) text += "Source: " + type.source + "\n";
  if (type.keys.empty()) return text + "No keys.\n";
  std::vector<std::vector<std::string>> rows{{"key", "value", "unit", "default", "range", "meaning"}};
  for (const auto& key : type.keys)
    rows.push_back({std::string(key.rules.name), value_phrase(key), unit_text(key.rules), default_phrase(key),
                    range_text(key.rules), std::string(key.rules.meaning)});
  return text + aligned(rows);
}

std::string kind_list(const std::vector<Kind>& kinds) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& kind : kinds) {
    std::string names;
    for (const auto& type : kind.types) names += (names.empty() ? "" : ", ") + type.name;
    rows.push_back({kind.name, kind.is_variant ? names : "", kind.meaning});
  }
  return aligned(rows);
}

}  // namespace

namespace {

void collect(const TypeText& type, std::vector<Kind>& kinds) {
  for (const auto& key : type.keys) {
    if (key.tables.empty()) continue;
    const std::string name(key.rules.name);
    auto same = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) { return k.name == name; });
    if (same == kinds.end()) {
      kinds.push_back({name, std::string(key.rules.meaning), key.is_variant, key.is_list_of_tables,
                       key.default_type, key.tables});
      for (const auto& table : key.tables) collect(table, kinds);
      continue;
    }
    for (const auto& table : key.tables) {  // the same key elsewhere may admit other types
      const auto known = [&](const TypeText& t) { return t.name == table.name; };
      if (std::any_of(same->types.begin(), same->types.end(), known)) continue;
      same->types.push_back(table);
      collect(table, kinds);
      same = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) { return k.name == name; });
    }
  }
}

}  // namespace

std::vector<Kind> kinds_of(const TypeText& root) {
  std::vector<Kind> kinds{{root.name, root.summary, false, false, {}, {root}}};
  collect(root, kinds);
  return kinds;
}

std::string describe_text(const TypeText& root, const std::vector<std::string>& words) {
  const auto kinds = kinds_of(root);
  if (words.empty())
    return "Kinds of tables in a case file, and the types that each can have:\n" + kind_list(kinds) +
           "Keys: wisp describe KIND, wisp describe KIND NAME. A case to start from: wisp template KIND.\n";
  std::vector<std::string> names;
  for (const auto& kind : kinds) {
    names.push_back(kind.name);
    if (kind.name != words[0]) continue;
    if (words.size() > 1) {
      std::vector<std::string> types;
      for (const auto& type : kind.types) {
        if (type.name == words[1]) return type_text(kind, type);
        types.push_back(type.name);
      }
      input_error("describe {}: unknown name '{}'{}", words[0], words[1], suggestion(words[1], types));
    }
    if (kind.types.size() == 1) return type_text(kind, kind.types.front());
    std::string text = fmt::format("{}: {}\n", header(kind), kind.meaning);
    std::vector<std::vector<std::string>> rows;
    for (const auto& type : kind.types) rows.push_back({type.name, type.summary});
    return text + aligned(rows) + fmt::format("Keys: wisp describe {} NAME.\n", kind.name);
  }
  for (const auto& kind : kinds)
    for (const auto& type : kind.types) {
      if (kind.is_variant) names.push_back(type.name);
      if (type.name == words[0]) return type_text(kind, type);
    }
  input_error("describe: unknown kind or name '{}'{}", words[0], suggestion(words[0], names));
}

std::string describe_markdown(const TypeText& root) {
  const auto bar = [](std::string text) {
    for (std::size_t i = text.find('|'); i != std::string::npos; i = text.find('|', i + 2))
      text.insert(i, "\\");
    return text;
  };
  std::string text = "# The case file\n\nWritten by `wisp describe --markdown`; do not edit.\n";
  for (const auto& kind : kinds_of(root)) {
    text += fmt::format("\n## {}\n\n{}.\n",
                        kind.name == root.name ? "The whole file" : "`" + header(kind) + "`", kind.meaning);
    for (const auto& type : kind.types) {
      if (kind.is_variant) text += fmt::format("\n### `type = \"{}\"`\n\n{}.\n", type.name, type.summary);
      if (type.name == kind.default_type) text += "\nThe type where the key `type` is left out.\n";
      if (!type.source.empty()) text += "\nSource: " + type.source + ".\n";
      if (type.keys.empty()) {
        text += "\nNo keys.\n";
        continue;
      }
      text += "\n| key | value | unit | default | range | meaning |\n|---|---|---|---|---|---|\n";
      for (const auto& key : type.keys) {
        const std::string value = default_phrase(key);
        text += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", key.rules.name, bar(value_phrase(key)),
                            unit_text(key.rules),
                            value == "required" || value == "-" ? value : "`" + bar(value) + "`",
                            range_text(key.rules), bar(std::string(key.rules.meaning)));
      }
    }
  }
  return text;
}

}  // namespace wisp
