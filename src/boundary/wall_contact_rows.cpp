// Rows of walls from where the walls are, the same on every rank.
#include <algorithm>
#include <cstring>
#include <string>

#include "boundary/wall_contact.h"

namespace wisp {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

template <int dim>
void WallContact<dim>::cut_walls(double t) {
  rows_.clear();
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const auto& motion = walls_[w].motion();
    if (motion.moves()) {
      const Mat<dim> turn = motion.rotation(t);
      const Vec<dim> shift = motion.position(Vec<dim>::Zero(), t);
      for (WallPiece<dim> piece : pieces_[w]) {
        for (auto& v : piece.vertex) v = (shift + turn * v).eval();
        piece.normal = (turn * piece.normal).eval();
        cutter_.add(piece);
      }
    } else {
      for (const auto& piece : pieces_[w]) cutter_.add(piece);
    }
    cutter_.finish(static_cast<int>(w), rows_);
  }
  if (Session::size() > 1) share_rows();
  number_rows();
  mark_cells();
}

/// The rows of all ranks on every rank: each gives those of the cells that it owns. By wall and cell, so that
/// they come in the order in which one rank would have them.
template <int dim>
void WallContact<dim>::share_rows() {
  constexpr std::size_t n = WallRow<dim>::corners;
  using Packed = std::array<double, 3 + n + 2 * dim>;
  const auto& window = space_->window();
  std::vector<Packed> packed;
  for (const auto& row : rows_) {
    const MultiIndex<dim> cell = window.cell_multi_index(row.cell);
    if (!window.owns_cell(cell)) continue;
    Packed p{};
    p[0] = row.wall, p[1] = static_cast<double>(number_in(window.grid_cells(), cell)), p[2] = row.size;
    std::copy_n(row.weight.begin(), n, p.begin() + 3);
    Eigen::Map<Vec<dim>>(p.data() + 3 + n) = row.normal;
    Eigen::Map<Vec<dim>>(p.data() + 3 + n + dim) = row.middle;
    packed.push_back(p);
  }
  packed = Session::gather(packed);
  // Rows of one wall in one cell come from one rank and keep their order.
  std::stable_sort(packed.begin(), packed.end(),
                   [](const Packed& a, const Packed& b) { return a[0] != b[0] ? a[0] < b[0] : a[1] < b[1]; });
  std::string bytes(packed.size() * sizeof(Packed), '\0');
  if (!packed.empty()) std::memcpy(bytes.data(), packed.data(), bytes.size());
  bytes = Session::broadcast(bytes);
  packed.resize(bytes.size() / sizeof(Packed));
  if (!packed.empty()) std::memcpy(packed.data(), bytes.data(), bytes.size());
  rows_.assign(packed.size(), {});
  cell_of_row_.resize(packed.size());
  for (std::size_t r = 0; r < packed.size(); ++r) {
    const Packed& p = packed[r];
    rows_[r].wall = static_cast<int>(p[0]), rows_[r].size = p[2], rows_[r].n = static_cast<int>(n);
    cell_of_row_[r] = static_cast<std::int64_t>(p[1]);
    std::copy(p.begin() + 3, p.begin() + 3 + n, rows_[r].weight.begin());
    rows_[r].normal = Eigen::Map<const Vec<dim>>(p.data() + 3 + n);
    rows_[r].middle = Eigen::Map<const Vec<dim>>(p.data() + 3 + n + dim);
  }
}

/// Numbers in the whole grid of the rows' cells, and a short list of the functions that any row has.
template <int dim>
void WallContact<dim>::number_rows() {
  first_row_.assign(1, 0);
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    std::size_t r = first_row_.back();
    while (r < rows_.size() && rows_[r].wall == static_cast<int>(w)) ++r;
    first_row_.push_back(r);
  }
  if (!space_->structured()) return number_rows_on_triangles();
  const auto& window = space_->window();
  if (Session::size() == 1) {
    cell_of_row_.resize(rows_.size());
    for (std::size_t r = 0; r < rows_.size(); ++r)
      cell_of_row_[r] = number_in(window.grid_cells(), window.cell_multi_index(rows_[r].cell));
  }
  const auto node = [&](std::size_t r, int i) {
    MultiIndex<dim> index = index_in(window.grid_cells(), cell_of_row_[r]);
    for (int d = 0; d < dim; ++d) index[d] += (i >> d) & 1;
    return index;
  };
  wall_functions_.clear();
  for (std::size_t r = 0; r < rows_.size(); ++r)
    for (int i = 0; i < rows_[r].n; ++i)
      wall_functions_.push_back(number_in(window.grid_nodes(), node(r, i)));
  std::sort(wall_functions_.begin(), wall_functions_.end());
  wall_functions_.erase(std::unique(wall_functions_.begin(), wall_functions_.end()), wall_functions_.end());
  for (std::size_t r = 0; r < rows_.size(); ++r)
    for (int i = 0; i < rows_[r].n; ++i)
      rows_[r].function[at(i)] =
          static_cast<int>(std::lower_bound(wall_functions_.begin(), wall_functions_.end(),
                                            number_in(window.grid_nodes(), node(r, i))) -
                           wall_functions_.begin());
  local_.clear();
  for (const std::int64_t number : wall_functions_) {
    const MultiIndex<dim> index = index_in(window.grid_nodes(), number);
    local_.push_back(window.contains_node(index) ? window.node_index(index) : -1);
  }
  wall_slot_.assign(wall_functions_.size(), -1);
}

/// The same on a triangulation, which is whole on its one rank.
template <int dim>
void WallContact<dim>::number_rows_on_triangles() {
  cell_of_row_.clear();
  wall_functions_.clear();
  for (const auto& row : rows_) {
    cell_of_row_.push_back(row.cell);
    for (const int i : row.functions()) wall_functions_.push_back(i);
  }
  std::sort(wall_functions_.begin(), wall_functions_.end());
  wall_functions_.erase(std::unique(wall_functions_.begin(), wall_functions_.end()), wall_functions_.end());
  for (auto& row : rows_)
    for (int i = 0; i < row.n; ++i) {
      int& f = row.function[at(i)];
      f = static_cast<int>(std::lower_bound(wall_functions_.begin(), wall_functions_.end(), f) -
                           wall_functions_.begin());
    }
  local_.assign(wall_functions_.begin(), wall_functions_.end());
  wall_slot_.assign(wall_functions_.size(), -1);
}

/// Points within a cell's side of a wall lie in a host cell or a neighbour of one; in triangles, in one whose
/// box comes as near to that of a host.
template <int dim>
void WallContact<dim>::mark_cells() {
  for (const int c : near_cells_) near_[at(c)] = 0;
  near_cells_.clear();
  if constexpr (dim == 2)
    if (!space_->structured()) {
      const Triangulation& mesh = space_->triangulation();
      const Vec<2> margin = Vec<2>::Constant(space_->shortest_side());
      for (const auto& row : rows_) {
        const Vec<2>&a = mesh.corner(row.cell, 0), &b = mesh.corner(row.cell, 1),
              &c = mesh.corner(row.cell, 2);
        mesh.for_each_near(a.cwiseMin(b).cwiseMin(c) - margin, a.cwiseMax(b).cwiseMax(c) + margin,
                           [&](int t) {
                             if (!near_[at(t)]) near_[at(t)] = 1, near_cells_.push_back(t);
                           });
      }
      return;
    }
  const auto& window = space_->window();
  for (const std::int64_t number : cell_of_row_) {
    const MultiIndex<dim> cell = index_in(window.grid_cells(), number);
    for_each_in(IndexBox<dim>{cell - MultiIndex<dim>::Ones(), cell + MultiIndex<dim>::Constant(2)},
                [&](const MultiIndex<dim>& c) {
                  if (!window.contains_cell(c)) return;
                  const int k = window.cell_index(c);
                  if (near_[at(k)]) return;
                  near_[at(k)] = 1;
                  near_cells_.push_back(k);
                });
  }
}

template class WallContact<2>;
template class WallContact<3>;

}  // namespace wisp
