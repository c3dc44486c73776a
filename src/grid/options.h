// Every grid that a case file can name. A new triangulation is one more alternative here and in
// triangulation_options.h.
#pragma once
#include <optional>
#include <variant>

#include "grid/structured_options.h"
#include "grid/triangulation_options.h"

namespace wisp {

using AnyGridOptions =
    std::variant<StructuredGridOptions, TriangleBlocksOptions, DelaunayOptions, GmshOptions>;
template <>
inline constexpr int default_alternative<AnyGridOptions> = 0;

/// The triangulation that a case asks for, if it does.
inline std::optional<AnyTriangulationOptions> triangulation_of(const AnyGridOptions& grid) {
  return std::visit(
      [](const auto& o) -> std::optional<AnyTriangulationOptions> {
        if constexpr (std::is_same_v<std::decay_t<decltype(o)>, StructuredGridOptions>)
          return std::nullopt;
        else
          return AnyTriangulationOptions(o);
      },
      grid);
}

inline Leaving leaving(const AnyGridOptions& grid) {
  return std::visit([](const auto& o) { return o.leaving; }, grid);
}

}  // namespace wisp
