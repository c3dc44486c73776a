// Values written as TOML.
#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/curve.h"

namespace wisp {

/// Shortest text that reads back as the same number, always with a point or an exponent (or `inf`, `nan`).
inline std::string toml_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_not_of("-0123456789") == std::string::npos) text += ".0";
  return text;
}

inline std::string toml_text(bool value) { return value ? "true" : "false"; }
inline std::string toml_text(int value) { return std::to_string(value); }
inline std::string toml_text(std::int64_t value) { return std::to_string(value); }

/// In quotes; quotes, backslashes and control characters escaped.
inline std::string toml_text(std::string_view value) {
  std::string text = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\')
      text += std::string("\\") + c;
    else if (c == '\n')
      text += "\\n";
    else if (c == '\t')
      text += "\\t";
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      text += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    else
      text += c;
  }
  return text + "\"";
}
inline std::string toml_text(const std::string& value) { return toml_text(std::string_view(value)); }
inline std::string toml_text(const char* value) { return toml_text(std::string_view(value)); }

template <class T>
std::string toml_text(const std::vector<T>& list) {
  std::string text = "[";
  for (std::size_t i = 0; i < list.size(); ++i) text += (i > 0 ? ", " : "") + toml_text(list[i]);
  return text + "]";
}

inline std::string toml_text(const Curve& curve) {
  if (curve.values.size() == 1) return toml_text(curve.values.front());
  std::string text = "[";
  for (std::size_t i = 0; i < curve.values.size(); ++i)
    text +=
        fmt::format("{}[{}, {}]", i > 0 ? ", " : "", toml_text(curve.times[i]), toml_text(curve.values[i]));
  return text + "]";
}

}  // namespace wisp
