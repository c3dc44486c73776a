// A strict reader from TOML to the types that describe themselves (core/describe.h).
//
// Every complaint is one line: `case.toml:12:5: [body.material] young_modulus: expected a number >= 0 Pa,
// found "x"`.
#pragma once
#include <toml++/toml.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/curve.h"
#include "core/describe.h"
#include "core/error.h"

namespace wisp {

/// A parsed case file with the overrides of the command line applied.
struct TomlFile {
  std::string name;                    ///< as shown in messages
  std::filesystem::path folder;        ///< relative file names start here
  std::string text;                    ///< the file as it was read
  std::vector<std::string> overrides;  ///< key=value, as given
  toml::table root;
};

/// Reads and parses a file; errors: not readable, not TOML, malformed override.
TomlFile parse_toml_file(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The same for a text that is already in memory, `name` being shown in messages.
TomlFile parse_toml_text(std::string text, std::string name, std::filesystem::path folder = ".",
                         const std::vector<std::string>& overrides = {});

/// Sets one value, `a.b[0].c=value`; the value is TOML, or a bare word for a text. Tables that are missing on
/// the way are made, entries of lists are not.
void apply_override(toml::table& root, const std::string& assignment);

/// Where the reader is: for messages, and for checks across tables after the reading.
class Context {
 public:
  explicit Context(const TomlFile& file) : file_(&file) {}

  /// Number of directions of the case, 0 while unknown (then lengths are not checked).
  int dimension = 0;

  /// Names a table while it is being read.
  class Scope {
   public:
    Scope(Context& context, std::string_view name) : context_(context) { context_.where_.emplace_back(name); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    ~Scope() { context_.where_.pop_back(); }

   private:
    Context& context_;
  };

  /// Throws InputError: position, table, key, message. `key` may be empty.
  [[noreturn]] void fail(const toml::source_region& at, std::string_view key,
                         const std::string& message) const;

  /// Throws InputError for a value given by its path, "body[1].shape.radius"; if the file does not give it,
  /// at the nearest table around it.
  [[noreturn]] void fail_at(std::string_view path, const std::string& message) const;

  /// True if the file (or an override) gives the value with this path.
  bool given(std::string_view path) const;

  const TomlFile& file() const { return *file_; }

 private:
  const TomlFile* file_;
  std::vector<std::string> where_;
};

/// ">= 0", "in (0, 0.5]"; empty if any number will do.
std::string range_text(const KeyRules& rules);

namespace reader {

/// What was found, for messages: `string "x"`, `integer 3`, `a table`.
std::string found(const toml::node& node);

/// "a number >= 0 Pa": noun, range and unit.
std::string expectation(const KeyRules& rules, std::string_view noun);

/// Range and finiteness of one number; `key` names it in the message.
void check_number(double value, const KeyRules& rules, std::string_view noun, std::string_view key,
                  const toml::node& at, const Context& context);

bool read_bool(const toml::node&, std::string_view key, const Context&);
std::int64_t read_integer(const toml::node&, const KeyRules&, std::string_view key, const Context&);
double read_number(const toml::node&, const KeyRules&, std::string_view key, const Context&);
std::string read_text(const toml::node&, const KeyRules&, std::string_view key, const Context&);
Curve read_curve(const toml::node&, const KeyRules&, std::string_view key, const Context&);

/// The node as a list of admissible length; `noun` describes its entries.
const toml::array& read_list(const toml::node&, const KeyRules&, std::string_view noun, std::string_view key,
                             const Context&);

/// The node as a table, or a list of tables.
const toml::table& read_subtable(const toml::node&, std::string_view key, const Context&);
const toml::array& read_tables(const toml::node&, const KeyRules&, std::string_view key, const Context&);

/// Index of a text in `names`; error with the nearest.
int read_choice(const toml::node&, const std::vector<std::string>& names, std::string_view key,
                const Context&);

/// Index of the alternative that key `type` of a table selects; `otherwise` where there is no such key, if it
/// is not negative.
int read_type(const toml::table&, const std::vector<std::string>& names, int otherwise, const Context&);

/// Error for the first key of the table that is not among `valid`.
void check_keys(const toml::table&, const std::vector<std::string>& valid, const Context&);

[[noreturn]] void missing(const toml::table&, const KeyRules&, const Context&);

template <class T>
inline constexpr bool is_vector = false;
template <class T>
inline constexpr bool is_vector<std::vector<T>> = true;
template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;
template <class T>
inline constexpr bool is_variant = false;
template <class... T>
inline constexpr bool is_variant<std::variant<T...>> = true;

/// True for what is a table in the file.
template <class T>
inline constexpr bool is_table = Described<T> || is_variant<T>;

template <class T>
constexpr std::string_view noun() {
  if constexpr (std::is_same_v<T, bool>) return "true or false";
  if constexpr (std::is_integral_v<T>) return "integer";
  if constexpr (std::is_floating_point_v<T> || std::is_same_v<T, Curve>) return "number";
  if constexpr (is_vector<T>) return "list";
  return "text";
}

template <class Enum>
std::vector<std::string> choice_names() {
  std::vector<std::string> names;
  for (const auto& choice : choices<Enum>) names.emplace_back(choice.first);
  return names;
}

template <class Variant>
struct Alternatives;
template <class... T>
struct Alternatives<std::variant<T...>> {
  static std::vector<std::string> names() { return {std::string(T::name)...}; }
  /// Calls f with the default of alternative `index`.
  template <class F>
  static void visit(int index, F&& f) {
    int i = 0;
    (void)((i++ == index ? (f(T{}), true) : false) || ...);
  }
};

}  // namespace reader

template <class T>
T read_value(const toml::node& node, const KeyRules& rules, std::string_view key, Context& context);

/// Reads a described type from a table, strictly. `tag` is a key that is not the type's own (`type` of a
/// variant).
template <Described T>
T read_table(const toml::table& table, Context& context, std::string_view tag = {}) {
  T object{};
  std::vector<std::string> valid;
  if (!tag.empty()) valid.emplace_back(tag);
  for_each_key<T>([&](const auto& k) { valid.emplace_back(k.name); });
  reader::check_keys(table, valid, context);
  for_each_key<T>([&](const auto& k) {
    using Value = typename std::decay_t<decltype(k)>::value_type;
    if (const toml::node* node = table.get(k.name))
      object.*(k.member) = read_value<Value>(*node, k, k.name, context);
    else if (k.is_required)
      reader::missing(table, k, context);
  });
  return object;
}

/// Reads one alternative of a variant of described types, selected by the key `type`.
template <class Variant>
Variant read_variant(const toml::table& table, Context& context) {
  using List = reader::Alternatives<Variant>;
  std::optional<Variant> result;
  List::visit(reader::read_type(table, List::names(), default_alternative<Variant>, context),
              [&](auto object) { result.emplace(read_table<decltype(object)>(table, context, "type")); });
  return std::move(*result);
}

namespace reader {

/// A described type or a variant of them, from a table.
template <class T>
T read_object(const toml::table& table, Context& context) {
  if constexpr (is_variant<T>)
    return read_variant<T>(table, context);
  else
    return read_table<T>(table, context);
}

template <class T>
std::vector<T> read_vector(const toml::node& node, const KeyRules& rules, std::string_view key,
                           Context& context) {
  std::vector<T> list;
  if constexpr (is_table<T>) {
    const Context::Scope scope(context, key);
    for (const auto& entry : read_tables(node, rules, key, context))
      list.push_back(read_object<T>(*entry.as_table(), context));
  } else {
    KeyRules inner = rules;  // of lists of lists: the length is the outer list's
    inner.is_per_direction = inner.is_empty_allowed = false;
    inner.length = 0;
    int index = 0;
    for (const auto& entry : read_list(node, rules, noun<T>(), key, context))
      list.push_back(read_value<T>(entry, inner, fmt::format("{}[{}]", key, index++), context));
  }
  return list;
}

}  // namespace reader

/// Reads one value of a supported member type.
template <class T>
T read_value(const toml::node& node, const KeyRules& rules, std::string_view key, Context& context) {
  using namespace reader;
  if constexpr (std::is_same_v<T, bool>) {
    return read_bool(node, key, context);
  } else if constexpr (std::is_integral_v<T>) {
    const std::int64_t value = read_integer(node, rules, key, context);
    if (!std::in_range<T>(value))
      context.fail(node.source(), key, fmt::format("the integer {} is too large", value));
    return static_cast<T>(value);
  } else if constexpr (std::is_floating_point_v<T>) {
    return read_number(node, rules, key, context);
  } else if constexpr (std::is_same_v<T, std::string>) {
    return read_text(node, rules, key, context);
  } else if constexpr (std::is_enum_v<T>) {
    return choices<T>[static_cast<std::size_t>(read_choice(node, choice_names<T>(), key, context))].second;
  } else if constexpr (std::is_same_v<T, Curve>) {
    return read_curve(node, rules, key, context);
  } else if constexpr (is_optional<T>) {
    return read_value<typename T::value_type>(node, rules, key, context);
  } else if constexpr (is_table<T>) {
    const toml::table& table = read_subtable(node, key, context);
    const Context::Scope scope(context, key);
    return read_object<T>(table, context);
  } else {
    static_assert(is_vector<T>, "the reader does not know this member type");
    return read_vector<typename T::value_type>(node, rules, key, context);
  }
}

/// Reads a whole file as one described type. The case's `dimension` is known to the context before the rest
/// is read.
template <Described T>
T read_root(const TomlFile& file, Context& context) {
  if (const auto* dimension = file.root.get_as<std::int64_t>("dimension"))
    if (dimension->get() == 2 || dimension->get() == 3)
      context.dimension = static_cast<int>(dimension->get());
  return read_table<T>(file.root, context);
}

}  // namespace wisp
