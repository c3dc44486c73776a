#include "transfer/filled_cells.h"

#include <Eigen/Cholesky>

namespace wisp {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Bits of bodies that all cells around a cell's vertices share (`every`) and that any of them has (`any`).
struct Around {
  std::vector<int> every, any;
};

template <int dim>
Around bits_around(const Space<dim>& space, const ActiveCells& cells) {
  Around around{cells.bits, cells.bits};
  if constexpr (dim == 2)
    if (!space.structured()) {
      const Triangulation& mesh = space.triangulation();
      for (int v = 0; v < mesh.n_vertices(); ++v) {
        int every = ~0, any = 0;
        for (const int t : mesh.triangles_of_vertex(v)) every &= cells.bits[at(t)], any |= cells.bits[at(t)];
        for (const int t : mesh.triangles_of_vertex(v))
          around.every[at(t)] &= every, around.any[at(t)] |= any;
      }
      return around;
    }
  const auto& window = space.window();
  for_each_in(window.owned_cells(), [&](const MultiIndex<dim>& c) {
    const std::size_t here = at(window.cell_index(c));
    for_each_in(IndexBox<dim>{c - MultiIndex<dim>::Ones(), c + MultiIndex<dim>::Constant(2)},
                [&](const MultiIndex<dim>& n) {
                  if (!window.cell_in_grid(n)) return;
                  const int bits = cells.bits[at(window.cell_index(n))];
                  around.every[here] &= bits, around.any[here] |= bits;
                });
  });
  return around;
}

}  // namespace

template <int dim>
std::vector<char> cells_inside(const Space<dim>& space, const ActiveCells& cells, std::size_t number) {
  const Around around = bits_around(space, cells);
  const int bit = 1 << number;
  std::vector<char> inside(around.every.size());
  for (std::size_t c = 0; c < inside.size(); ++c) inside[c] = around.every[c] == bit && around.any[c] == bit;
  return inside;
}

PointsOfCells::PointsOfCells(const std::vector<int>& cell, int n_cells)
    : start_(at(n_cells) + 1, 0), list_(cell.size()) {
  for (const int c : cell)
    if (c >= 0) ++start_[at(c) + 1];
  for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
  std::vector<int> next(start_.begin(), start_.end() - 1);
  for (std::size_t p = 0; p < cell.size(); ++p)
    if (cell[p] >= 0) list_[at(next[at(cell[p])]++)] = static_cast<int>(p);
}

template <int dim>
bool determine(const Particles<dim>& points, bool finite_strain, FilledCell<dim>& cell) {
  using Square = typename TaylorBasis<dim>::Square;
  if (static_cast<int>(cell.points.size()) < TaylorBasis<dim>::terms + 1) return false;
  Square normal = Square::Zero();
  double filled = 0.0;
  for (const int q : cell.points) {
    const auto p = static_cast<std::size_t>(q);
    const auto t = cell.taylor.at(points.position[p]);
    normal += t * t.transpose();
    filled += points.volume[p] * volume_ratio(points, finite_strain, p);
  }
  if (filled < filled_share * cell.taylor.volume) return false;
  const Eigen::LDLT<Square> solver(normal);
  if (solver.vectorD().minCoeff() < 1e-4 * normal(0, 0)) return false;  // points on a line
  cell.inverse = solver.solve(Square::Identity());
  return true;
}

template bool determine<2>(const Particles<2>&, bool, FilledCell<2>&);
template bool determine<3>(const Particles<3>&, bool, FilledCell<3>&);
template std::vector<char> cells_inside<2>(const Space<2>&, const ActiveCells&, std::size_t);
template std::vector<char> cells_inside<3>(const Space<3>&, const ActiveCells&, std::size_t);

}  // namespace wisp
