// What a case file says about the basis.
#pragma once
#include "core/describe.h"

namespace wisp {

struct LinearOptions {
  static constexpr std::string_view name = "linear";
  static constexpr std::string_view summary = "Multilinear hat functions, points without extent (sMPM)";
  static constexpr std::string_view source = "Sulsky et al. 1994";
  static constexpr auto keys() { return std::tuple{}; }
};

struct GimpOptions {
  static constexpr std::string_view name = "gimp";
  static constexpr std::string_view summary =
      "Generalised interpolation: hats averaged over each point's domain, which follows the stretch";
  static constexpr std::string_view source = "Bardenhagen and Kober 2004; Charlton et al. 2017";
  static constexpr auto keys() { return std::tuple{}; }
};

using AnyBasisOptions = std::variant<LinearOptions, GimpOptions>;

}  // namespace wisp
