// Describe once: every type that a case file can name lists its keys in one table. From that table come the
// strict TOML reader with its messages, `wisp describe`, `wisp template`, the reference pages and the
// contract tests.
//
// A described type is an aggregate with
//     static constexpr std::string_view name    = "von-mises";
//     static constexpr std::string_view summary = "one line";
//     static constexpr std::string_view source  = "author year, equation";   // may be empty
//     static constexpr auto keys() { return std::tuple{key("yield_stress", &VonMises::yield_stress, "Pa",
//     "...").positive(), ...}; }
// Defaults are the member initialisers, so they stand in one place.
#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace wisp {

/// What a key admits, apart from the type of its member.
struct KeyRules {
  std::string_view name;
  std::string_view unit;     ///< SI unit, "-" if dimensionless, "" if it has none (text, switches)
  std::string_view meaning;  ///< one line
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool least_excluded = false;
  bool most_excluded = false;
  bool is_required = false;
  bool is_per_direction = false;  ///< a list with one entry for each direction of the case
  bool is_existing_file = false;  ///< text that names a file, relative to the folder of the case file
  bool is_empty_allowed = false;  ///< an empty list or empty text is meaningful
  int length = 0;                 ///< number of entries of a list, 0 if any
  std::string_view sample = {};   ///< TOML text that templates show where there is no default
};

/// One line of a description: a key of the case file bound to a member. Ranges hold for every number of a
/// list.
template <class Owner, class T>
struct Key : KeyRules {
  using owner_type = Owner;
  using value_type = T;
  T Owner::*member;

  constexpr Key at_least(double v) const {
    auto k = *this;
    k.least = v;
    return k;
  }
  constexpr Key at_most(double v) const {
    auto k = *this;
    k.most = v;
    return k;
  }
  constexpr Key above(double v) const {
    auto k = *this;
    k.least = v;
    k.least_excluded = true;
    return k;
  }
  constexpr Key below(double v) const {
    auto k = *this;
    k.most = v;
    k.most_excluded = true;
    return k;
  }
  constexpr Key positive() const { return above(0.0); }
  constexpr Key required() const {
    auto k = *this;
    k.is_required = true;
    return k;
  }
  constexpr Key per_direction() const {
    auto k = *this;
    k.is_per_direction = true;
    return k;
  }
  constexpr Key existing_file() const {
    auto k = *this;
    k.is_existing_file = true;
    return k;
  }
  constexpr Key may_be_empty() const {
    auto k = *this;
    k.is_empty_allowed = true;
    return k;
  }
  constexpr Key entries(int n) const {
    auto k = *this;
    k.length = n;
    return k;
  }
  constexpr Key example(std::string_view toml) const {
    auto k = *this;
    k.sample = toml;
    return k;
  }
};

template <class Owner, class T>
constexpr Key<Owner, T> key(std::string_view name, T Owner::*member, std::string_view unit,
                            std::string_view meaning) {
  return {{.name = name, .unit = unit, .meaning = meaning}, member};
}

/// Names of an enumeration's values, specialised beside the enumeration:
///     template <> inline constexpr auto choices<Mass> = choice_list<Mass>({{"lumped", Mass::lumped}, ...});
template <class Enum, std::size_t n>
constexpr std::array<std::pair<std::string_view, Enum>, n> choice_list(
    const std::pair<std::string_view, Enum> (&list)[n]) {
  std::array<std::pair<std::string_view, Enum>, n> a{};
  for (std::size_t i = 0; i < n; ++i) a[i] = list[i];
  return a;
}
template <class Enum>
inline constexpr auto choices = nullptr;

/// The text of an enumeration's value.
template <class Enum>
constexpr std::string_view choice_name(Enum value) {
  for (const auto& [text, v] : choices<Enum>)
    if (v == value) return text;
  return "?";
}

/// Of a variant of described types: the alternative that is meant where a table has no key `type`, -1 if
/// there must be one. Specialised beside the variant.
template <class Variant>
inline constexpr int default_alternative = -1;

template <class T>
concept Described = requires {
  { T::name } -> std::convertible_to<std::string_view>;
  T::keys();
};

/// Calls f(key) for every key of a described type, in the order of its table.
template <Described T, class F>
constexpr void for_each_key(F&& f) {
  std::apply([&](const auto&... k) { (f(k), ...); }, T::keys());
}

}  // namespace wisp
