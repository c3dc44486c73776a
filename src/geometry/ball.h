#pragma once
#include <string_view>
#include <tuple>
#include <vector>

#include "core/describe.h"

namespace wisp {

/// Ball (disc in 2D) as a case file gives it.
struct Ball {
  static constexpr std::string_view name = "ball";
  static constexpr std::string_view summary = "ball, in 2D a disc";
  static constexpr std::string_view source = "";

  std::vector<double> centre{};  ///< [dim], m
  double radius = 0.0;           ///< m, positive

  static constexpr auto keys() {
    return std::tuple{key("centre", &Ball::centre, "m", "centre").required().per_direction(),
                      key("radius", &Ball::radius, "m", "radius").required().positive()};
  }
};

}  // namespace wisp
