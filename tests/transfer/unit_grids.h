// Grids of n x n unit squares, whole or cut into triangles.
#pragma once
#include <memory>
#include <vector>

#include "basis/space.h"

namespace wisp::transfer_test {

inline std::unique_ptr<Space<2>> squares(int n, const AnyBasisOptions& basis = LinearOptions{}) {
  std::array<std::vector<double>, 2> lines;
  for (int i = 0; i <= n; ++i) lines[0].push_back(i), lines[1].push_back(i);
  const StructuredGrid<2> grid(lines);
  return std::make_unique<Space<2>>(grid, BoxPartition<2>(grid.cells()), basis);
}

/// Squares cut into `parts` triangles: 2 by a diagonal, or 4 by both.
inline std::unique_ptr<Space<2>> triangles(int n, const AnyBasisOptions& basis, int parts) {
  std::vector<Vec<2>> vertices;
  std::vector<std::array<int, 3>> list;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) vertices.emplace_back(i, j);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = c - 1;
      if (parts == 2) {
        list.push_back({a, b, c}), list.push_back({a, c, d});
        continue;
      }
      const int m = static_cast<int>(vertices.size());
      vertices.emplace_back(i + 0.5, j + 0.5);
      for (const auto& t :
           {std::array{a, b, m}, std::array{b, c, m}, std::array{c, d, m}, std::array{d, a, m}})
        list.push_back(t);
    }
  return std::make_unique<Space<2>>(std::make_shared<const Triangulation>(vertices, list), basis);
}

}  // namespace wisp::transfer_test
