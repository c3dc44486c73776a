#pragma once
#include <string_view>
#include <tuple>
#include <vector>

#include "core/describe.h"

namespace wisp {

/// Axis-aligned box (rectangle in 2D) as a case file gives it.
struct Box {
  static constexpr std::string_view name = "box";
  static constexpr std::string_view summary = "axis-aligned box, in 2D a rectangle";
  static constexpr std::string_view source = "";

  std::vector<double> lower{};  ///< [dim], m
  std::vector<double> upper{};  ///< [dim], m, above `lower` in each direction

  static constexpr auto keys() {
    return std::tuple{
        key("lower", &Box::lower, "m", "corner with the smallest coordinates").required().per_direction(),
        key("upper", &Box::upper, "m", "corner with the largest coordinates").required().per_direction()};
  }
};

}  // namespace wisp
