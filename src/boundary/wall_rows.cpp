#include "boundary/wall_rows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "boundary/wall_host.h"

namespace wisp {
namespace {

/// Shares of a cell's side: lengths below are rounding; a part on a grid line looks so far into the solid
/// side.
constexpr double rounding = 1e-9, nudge = 1e-6;
/// Pieces of one row: cosine of the largest angle between their normals.
constexpr double one_row = 0.94;

}  // namespace

template <int dim>
void WallRow<dim>::add(int i, double w) {
  const auto end = function.begin() + n;
  const auto it = std::find(function.begin(), end, i);
  if (it == end) *it = i, ++n;
  weight[static_cast<std::size_t>(it - function.begin())] += w;
}

/// The parts of a piece in triangles, and in sub-triangles of split ones, which share a row.
template <int dim>
void WallCutter<dim>::add_on_triangles(const WallPiece<dim>& piece) {
  if constexpr (dim == 2) {
    cut_.clear();
    cut_piece(*space_, piece, cut_);
    for (const auto& of : cut_.parts) {
      if (of.host[0] < 0) continue;
      Part part{of.host[0], static_cast<int>(parts_.size()), piece.normal, {}};
      for (std::size_t q = of.first; q < of.first + of.count; ++q) {
        const double w = cut_.weight[q];
        const CellFunctions<2> f = triangle_functions(*space_, of.host[0], of.host[1], cut_.position[q]);
        for (std::size_t i = 0; i < static_cast<std::size_t>(f.n); ++i)
          part.row.add(f.function[i], w * f.phi[i]);
        part.row.middle += w * cut_.position[q], part.row.size += w;
      }
      parts_.push_back(part);
    }
  }
}

template <int dim>
void WallCutter<dim>::add(const WallPiece<dim>& piece) {
  if (!space_->structured()) return add_on_triangles(piece);
  Convex shape;
  shape.n = dim;
  for (std::size_t k = 0; k < dim; ++k) shape.vertex[k] = piece.vertex[k];
  cut(shape, 0, MultiIndex<dim>::Zero(), piece.normal);
}

/// Cuts by the lines of one direction and hands what is left to the next.
template <int dim>
void WallCutter<dim>::cut(const Convex& shape, int direction, MultiIndex<dim> cell, const Vec<dim>& normal) {
  if (direction == dim) return integrate(shape, cell, normal);
  const int d = direction;
  const StructuredGrid<dim>& grid = space_->grid();
  double low = shape.vertex[0][d], high = low;
  for (std::size_t k = 1; k < shape.n; ++k) {
    low = std::min(low, shape.vertex[k][d]);
    high = std::max(high, shape.vertex[k][d]);
  }
  const double h = grid.shortest_side();
  if (high - low <= rounding * h) {
    cell[d] = grid.locate(d, 0.5 * (low + high) + nudge * h * normal[d]);
    if (cell[d] >= 0 && cell[d] < grid.cells(d)) cut(shape, d + 1, cell, normal);
    return;
  }
  const int first = std::max(0, grid.locate(d, low + 0.5 * rounding * h)),
            last = std::min(grid.cells(d) - 1, grid.locate(d, high - 0.5 * rounding * h));
  for (int c = first; c <= last; ++c) {
    Convex part = shape, next;
    for (const double side : {-1.0, 1.0}) {
      const double line = grid.line(d, side > 0.0 ? c + 1 : c);
      next.n = 0;
      const auto keep = [&](const Vec<dim>& x) {
        if (next.n < next.vertex.size()) next.vertex[next.n++] = x;
      };
      const std::size_t edges = dim == 2 ? 1 : part.n;
      for (std::size_t k = 0; k < edges; ++k) {
        const Vec<dim>&a = part.vertex[k], &b = part.vertex[(k + 1) % part.n];
        const double da = side * (a[d] - line), db = side * (b[d] - line);
        if (da <= 0.0) keep(a);
        if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) {
          Vec<dim> x = a + da / (da - db) * (b - a);
          x[d] = line;
          keep(x);
        }
        if (dim == 2 && db <= 0.0) keep(b);
      }
      part = next;
      if (part.n < dim) break;
    }
    if (part.n < dim) continue;
    cell[d] = c;
    cut(part, d + 1, cell, normal);
  }
}

template <int dim>
void WallCutter<dim>::add_point(const Vec<dim>& x, double weight, const MultiIndex<dim>& cell,
                                Part& part) const {
  std::array<double, dim> r{};
  for (int d = 0; d < dim; ++d)
    r[static_cast<std::size_t>(d)] = std::clamp(
        (x[d] - space_->grid().line(d, cell[d])) * space_->grid().per_spacing(d)[cell[d]], 0.0, 1.0);
  for (std::size_t k = 0; k < WallRow<dim>::corners; ++k) {
    double phi = weight;
    for (std::size_t d = 0; d < dim; ++d) phi *= (k >> d) & 1 ? r[d] : 1.0 - r[d];
    part.row.weight[k] += phi;
  }
  part.row.middle += weight * x;
}

template <int dim>
void WallCutter<dim>::integrate(const Convex& shape, const MultiIndex<dim>& cell, const Vec<dim>& normal) {
  const auto& window = space_->window();
  if (!window.contains_cell(cell)) return;
  Part part{window.cell_index(cell), static_cast<int>(parts_.size()), normal, {}};
  part.row.n = WallRow<dim>::corners;
  for (int i = 0; i < part.row.n; ++i) {
    MultiIndex<dim> node = cell;
    for (int d = 0; d < dim; ++d) node[d] += (i >> d) & 1;
    part.row.function[static_cast<std::size_t>(i)] = window.node_index(node);
  }
  const auto& v = shape.vertex;
  if constexpr (dim == 2) {
    // Two Gauss points: the functions are quadratic along a segment.
    const double length = (v[1] - v[0]).norm(), g = 0.5 / std::sqrt(3.0);
    part.row.size = length;
    for (const double s : {0.5 - g, 0.5 + g}) add_point(v[0] + s * (v[1] - v[0]), 0.5 * length, cell, part);
  } else {
    // A fan of triangles; six points, exact to degree 4 (Dunavant 1985): the functions are cubic on a plane.
    constexpr double a[2] = {0.445948490915965, 0.091576213509771},
                     w[2] = {0.223381589678011, 0.109951743655322};
    for (std::size_t k = 2; k < shape.n; ++k) {
      const double area = 0.5 * (v[k - 1] - v[0]).cross(v[k] - v[0]).norm();
      part.row.size += area;
      for (int s = 0; s < 2; ++s)
        for (int corner = 0; corner < 3; ++corner) {
          double l[3] = {a[s], a[s], a[s]};
          l[corner] = 1.0 - 2.0 * a[s];
          add_point(l[0] * v[0] + l[1] * v[k - 1] + l[2] * v[k], w[s] * area, cell, part);
        }
    }
  }
  const double h = space_->grid().shortest_side();
  if (part.row.size > rounding * (dim == 2 ? h : h * h)) parts_.push_back(part);
}

template <int dim>
void WallCutter<dim>::finish(int wall, std::vector<WallRow<dim>>& rows) {
  std::sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.order < b.order;
  });
  std::size_t first_of_cell = rows.size();
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Part& part = parts_[k];
    if (k > 0 && part.cell != parts_[k - 1].cell) first_of_cell = rows.size();
    std::size_t r = first_of_cell;
    while (r < rows.size() && rows[r].normal.normalized().dot(part.normal) < one_row) ++r;
    if (r == rows.size()) {
      rows.emplace_back();
      rows[r].wall = wall, rows[r].cell = part.cell;
    }
    WallRow<dim>& row = rows[r];
    for (std::size_t i = 0; i < static_cast<std::size_t>(part.row.n); ++i)
      row.add(part.row.function[i], part.row.weight[i]);
    row.middle += part.row.middle;
    row.normal += part.row.size * part.normal;
    row.size += part.row.size;
  }
  for (auto row = rows.rbegin(); row != rows.rend() && row->wall == wall; ++row) {
    double sum = 0.0;
    for (const double w : row->weight) sum += w;
    for (double& w : row->weight) w /= sum;
    row->middle /= row->size;
    row->normal.normalize();
  }
  parts_.clear();
}

template struct WallRow<2>;
template struct WallRow<3>;
template class WallCutter<2>;
template class WallCutter<3>;

}  // namespace wisp
