// The elastic column under its own weight of Coombs 2023, section 5.4: set-up and run, shared by Table 4 and
// figure 16.
#pragma once
#include <optional>

#include "analysis/implicit.h"

namespace wisp::ghost_paper {

/// A column 50 m high, E = 10 kPa, nu = 0, 80 kg/m3, 10 m/s2 in 40 steps; 2 x 2 points a cell; one column of
/// square cells.
struct ColumnCase {
  int cells = 32;  ///< over the height: h = 50 m / cells
  std::optional<GhostOptions> ghost;
};

struct ColumnRun {
  double error = 0.0;  ///< normalised stress error, eq. 31
  double top = 0.0;    ///< displacement of the top of the uppermost point's domain, m
  int iterations = 0;
};

inline constexpr double column_height = 50.0;

ModelOptions column_options(const ColumnCase& column);
ColumnRun run_column(const ColumnCase& column);

}  // namespace wisp::ghost_paper
