// What the description tables say, as text: for the terminal, for the reference pages, and as commented
// cases.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/describe.h"
#include "io/toml_reader.h"
#include "io/toml_text.h"

namespace wisp {

struct TypeText;

/// One key of a described type, without its C++ type.
struct KeyText {
  KeyRules rules;
  std::string value;               ///< "number", "list of integers", "one of lumped, consistent", "table"
  std::string default_toml;        ///< empty if there is none
  bool is_optional = false;        ///< std::optional: absent unless given
  bool is_list_of_tables = false;  ///< [[key]]
  bool is_variant = false;         ///< the key `type` selects one of `tables`
  std::string default_type;        ///< of a variant: the type where the key `type` is left out, may be empty
  std::vector<TypeText> tables;    ///< the types of a nested table, empty for plain values
};

/// A described type.
struct TypeText {
  std::string name, summary, source;
  std::vector<KeyText> keys;
};

/// Everything that can stand in one place of a case: "material" with its laws, "grid" with its one type.
struct Kind {
  std::string name;
  std::string meaning;
  bool is_variant = false;
  bool is_list_of_tables = false;
  std::string default_type;  ///< where the key `type` is left out; empty if it must be there
  std::vector<TypeText> types;
};

namespace reader {

/// The name of a member type in words; `list` gives the plural.
template <class T>
std::string value_text(bool plural = false) {
  const std::string s = plural ? "s" : "";
  if constexpr (std::is_same_v<T, bool>)
    return plural ? "switches" : "true or false";
  else if constexpr (std::is_integral_v<T>)
    return "integer" + s;
  else if constexpr (std::is_floating_point_v<T>)
    return "number" + s;
  else if constexpr (std::is_same_v<T, std::string>)
    return "text" + s;
  else if constexpr (std::is_same_v<T, Curve>)
    return "number" + s + " or [time, value] pairs";
  else if constexpr (std::is_enum_v<T>) {
    std::string text;
    for (const auto& name : choice_names<T>()) text += (text.empty() ? "" : ", ") + name;
    return text;
  } else if constexpr (is_optional<T>)
    return value_text<typename T::value_type>(plural);
  else if constexpr (is_table<T>)
    return "table" + s;
  else
    return "list" + s + " of " + value_text<typename T::value_type>(true);
}

/// A default as TOML; empty if the absence of the key says more.
template <class T>
std::string default_text(const T& value) {
  if constexpr (is_table<T> || is_optional<T>)
    return {};
  else if constexpr (std::is_enum_v<T>)
    return toml_text(choice_name(value));
  else if constexpr (std::is_same_v<T, std::string> || is_vector<T>) {
    if (value.empty()) return {};
    if constexpr (is_vector<T>) {
      if constexpr (is_table<typename T::value_type> || std::is_enum_v<typename T::value_type>)
        return {};
      else
        return toml_text(value);
    } else {
      return toml_text(value);
    }
  } else {
    return toml_text(value);
  }
}

}  // namespace reader

template <Described T>
TypeText describe_type();

namespace reader {

template <class T>
void describe_tables(KeyText& text) {
  if constexpr (is_optional<T>) {
    text.is_optional = true;
    describe_tables<typename T::value_type>(text);
  } else if constexpr (is_vector<T>) {
    describe_tables<typename T::value_type>(text);
    text.is_list_of_tables = !text.tables.empty();
  } else if constexpr (is_variant<T>) {
    text.is_variant = true;
    if constexpr (default_alternative<T> >= 0)
      text.default_type = Alternatives<T>::names()[static_cast<std::size_t>(default_alternative<T>)];
    for (int i = 0; i < static_cast<int>(std::variant_size_v<T>); ++i)
      Alternatives<T>::visit(i, [&](const auto& object) {
        text.tables.push_back(describe_type<std::decay_t<decltype(object)>>());
      });
  } else if constexpr (Described<T>) {
    text.tables.push_back(describe_type<T>());
  }
}

}  // namespace reader

/// The description of T and of everything nested in it.
template <Described T>
TypeText describe_type() {
  TypeText type{std::string(T::name), std::string(T::summary), std::string(T::source), {}};
  const T object{};
  for_each_key<T>([&](const auto& k) {
    using Value = typename std::decay_t<decltype(k)>::value_type;
    KeyText text;
    text.rules = k;
    text.value = reader::value_text<Value>();
    text.default_toml = reader::default_text<Value>(object.*(k.member));
    reader::describe_tables<Value>(text);
    type.keys.push_back(std::move(text));
  });
  return type;
}

/// All kinds of tables in a tree of types, each once, in the order of the tree.
std::vector<Kind> kinds_of(const TypeText& root);

/// `wisp describe`, `describe KIND` and `describe KIND NAME` (or `describe NAME`). InputError for unknown
/// names.
std::string describe_text(const TypeText& root, const std::vector<std::string>& words);

/// The reference of the whole file as Markdown.
std::string describe_markdown(const TypeText& root);

/// A value for a required key without default, by its path ("grid.lower"); empty if unknown.
using Sample = std::string (*)(const std::string& path);

/// A commented case: every key with its unit, range and meaning. Required keys and those with a sample are
/// set, all others are commented out and show their default. Of variants the alternative whose name is in
/// `chosen`, else the first; optional tables are commented out unless their key or type is in `chosen`.
std::string template_text(const TypeText& root, const std::vector<std::string>& chosen, Sample sample);

}  // namespace wisp
