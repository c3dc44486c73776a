// Commented cases from the description tables.
#include <algorithm>

#include "io/describe_text.h"

namespace wisp {
namespace {

/// How often a word names a table or a type within a type.
int count_within(const TypeText& type, const std::string& word) {
  int count = 0;
  for (const auto& key : type.keys) {
    if (!key.tables.empty() && key.rules.name == word) ++count;
    for (const auto& table : key.tables)
      count += (key.is_variant && table.name == word) + count_within(table, word);
  }
  return count;
}

/// Writes one type and what is nested in it.
class TemplateWriter {
 public:
  TemplateWriter(const TypeText& root, const std::vector<std::string>& chosen, Sample sample)
      : root_(root), chosen_(chosen), sample_(sample) {}

  /// Keys of a table, plain ones first: in TOML a key after a sub-table would belong to that.
  void keys(const TypeText& type, const std::string& path, bool commented) {
    for (const auto& key : type.keys)
      if (key.tables.empty()) plain(key, path, commented);
    for (const auto& key : type.keys)
      if (!key.tables.empty()) table(key, path, commented);
  }

  std::string text;

 private:
  void line(const std::string& content, bool commented) { text += (commented ? "# " : "") + content + "\n"; }

  void plain(const KeyText& key, const std::string& path, bool commented) {
    const std::string name(key.rules.name);
    const std::string full = path.empty() ? name : path + "." + name;
    std::string value = sample_(full);
    const bool left_out = value.empty() && !key.rules.is_required;
    if (value.empty()) value = key.rules.is_required ? required_value(key) : key.default_toml;
    if (value.empty()) value = fallback(key);
    std::string remark = std::string(key.rules.meaning);
    std::string limits = range_text(key.rules);
    if (!key.rules.unit.empty() && key.rules.unit != "-")
      limits += (limits.empty() ? "" : " ") + std::string(key.rules.unit);
    if (key.rules.is_required) limits = "required" + (limits.empty() ? "" : ", " + limits);
    if (!limits.empty()) remark += " [" + limits + "]";
    line(name + " = " + value + "  # " + remark +
             (key.value.find(", ") != std::string::npos ? ": " + key.value : ""),
         commented || left_out);
  }

  void table(const KeyText& key, const std::string& path, bool commented) {
    const std::string name(key.rules.name);
    const std::string full = path.empty() ? name : path + "." + name;
    const TypeText& type = choose(key);
    const bool optional = key.is_optional || (key.is_list_of_tables && !key.rules.is_required);
    const bool wanted = !optional || picked(type.name) || picked(name);
    commented = commented || !wanted;
    text += "\n";
    line("# " + std::string(key.rules.meaning) + (wanted ? "" : " (optional)"), false);
    line(key.is_list_of_tables ? "[[" + full + "]]" : "[" + full + "]", commented);
    if (key.is_variant) {
      std::string names;
      for (const auto& t : key.tables) names += (names.empty() ? "" : ", ") + t.name;
      line("type = " + toml_text(type.name) + "  # " + type.summary +
               (key.tables.size() > 1 ? "; one of: " + names : ""),
           commented);
    }
    keys(type, full, commented);
  }

  bool picked(const std::string& name) const {
    return std::find(chosen_.begin(), chosen_.end(), name) != chosen_.end();
  }

  const TypeText& choose(const KeyText& key) const {
    for (const auto& type : key.tables)
      if (picked(type.name)) return type;
    for (const auto& type : key.tables)  // a word that only has a meaning within one of them chooses that
      for (const auto& word : chosen_)
        if (key.is_variant && count_within(type, word) > 0 &&
            count_within(type, word) == count_within(root_, word))
          return type;
    return key.tables.front();
  }

  /// A required key without sample: the member's own value if it is admissible.
  static std::string required_value(const KeyText& key) {
    return key.default_toml == "0.0" || key.default_toml == "0" ? "" : key.default_toml;
  }

  static std::string fallback(const KeyText& key) {
    if (!key.rules.sample.empty()) return std::string(key.rules.sample);
    const double low = key.rules.least, high = key.rules.most;
    const double number = low < 1.0 && 1.0 < high ? 1.0 : (std::max(low, -1.0) + std::min(high, 2.0)) / 2.0;
    if (key.value.starts_with("number")) return toml_text(number);
    if (key.value.starts_with("integer")) return std::to_string(std::max(1, static_cast<int>(number)));
    if (key.value.starts_with("list of lists")) return "[[]]";
    if (key.value.starts_with("list of text")) return "[\"x\"]";
    if (key.value.starts_with("list")) return "[]";
    return "\"\"";
  }

  const TypeText& root_;
  const std::vector<std::string>& chosen_;
  Sample sample_;
};

}  // namespace

std::string template_text(const TypeText& root, const std::vector<std::string>& chosen, Sample sample) {
  TemplateWriter writer(root, chosen, sample);
  writer.keys(root, "", false);
  return std::move(writer.text);
}

}  // namespace wisp
