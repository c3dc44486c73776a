#include "boundary/wall_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "parallel/session.h"

namespace wisp {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double nudge = 1e-6;  // cells: a closest point on a grid line belongs to the cell on the solid side
constexpr double held_gap = 0.1;  // cells: a wall that holds takes hold of what is nearer than this
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Half the distance between points that fill their volume evenly.
template <int dim>
double half_spacing(double volume) {
  return 0.5 * (dim == 2 ? std::sqrt(volume) : std::cbrt(volume));
}

}  // namespace

template <int dim>
Vec<dim> ContactWall<dim>::prescribed(const Vec<dim>& n, double t, double dt) const {
  const WallOptions& options = this->options();
  const bool rate = !options.velocity.empty();
  const auto& curves = rate ? options.velocity : options.displacement;
  Vec<dim> v = Vec<dim>::Zero();
  for (std::size_t d = 0; d < curves.size() && d < dim; ++d)
    v[static_cast<int>(d)] = (rate ? integral(curves[d], t, t + dt) : curves[d](t + dt) - curves[d](t)) / dt;
  if (curves.empty()) return v;
  if constexpr (dim == 2) {
    return v[0] * n + v[1] * Vec<2>(-n.y(), n.x());
  } else {
    const Vec<3> a = n.unitOrthogonal();
    return v[0] * n + v[1] * a + v[2] * n.cross(a);
  }
}

template <int dim>
WallContact<dim>::WallContact(const std::vector<Wall<dim>>& walls, const Space<dim>& space)
    : walls_(walls.begin(), walls.end()), space_(&space), cutter_(space) {
  if (walls_.empty()) return;
  // Walls without bounds come as far as the grid reaches, and as far again if they move.
  const Vec<dim> reach = space.upper() - space.lower();
  for (const auto& wall : walls_) {
    const double margin = wall.motion().moves() ? 2.0 : 0.0;
    const Vec<dim> more = margin * Vec<dim>::Constant(reach.norm());
    pieces_.push_back(
        wall.shape().pieces(0.25 * space.shortest_side(), {space.lower() - more, space.upper() + more}));
    any_moves_ |= wall.motion().moves();
  }
  near_.assign(at(space.n_cells()), 0);
  slot_.assign(at(space.n_functions()), -1);
  reactions_.resize(walls_.size());
  cut_walls(0.0);
  for (std::size_t w = 0; w < walls_.size(); ++w)
    if (first_row_[w] == first_row_[w + 1] && !walls_[w].motion().moves())
      input_error("boundary '{}': the whole wall lies outside the grid", walls_[w].name());
}

template <int dim>
void WallContact<dim>::find(const std::vector<Body<dim>>& bodies, double t, double dt) {
  time_ = t;
  if (any_moves_) cut_walls(t);
  gap_.assign(rows_.size(), infinite);
  points_.clear();
  touches_.clear();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const std::vector<int>& cell = bodies[b].points.cell;
    for (std::size_t p = 0; p < cell.size(); ++p)
      if (near_[at(cell[p])]) {
        points_.push_back({static_cast<int>(b), static_cast<int>(p)});
        touch(bodies[b], points_.back(), t);
      }
  }
  if (Session::size() > 1) {  // of a row, the least over the points of all ranks
    Eigen::Map<Eigen::VectorXd> all(gap_.data(), static_cast<Eigen::Index>(gap_.size()));
    all = Session::min(Eigen::VectorXd(all));
  }
  choose_rows(t, dt);
}

/// Distances of one point to all walls: gaps of rows, and what a point is too close by.
template <int dim>
void WallContact<dim>::touch(const Body<dim>& body, PointOf which, double t) {
  const auto p = at(which.point);
  const Vec<dim>& x = body.points.position[p];
  const double h = space_->shortest_side(), half = half_spacing<dim>(body.points.volume[p]);
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const auto& wall = walls_[w];
    const bool moves = wall.motion().moves();
    WallDistance<dim> d = wall.shape().signed_distance(moves ? wall.motion().rest(x, t) : x);
    if (d.beyond || d.distance > h + half || d.distance < -h) continue;
    // A point that began nearer than half a spacing stays as near as that: nothing jumps at the start.
    const Vec<dim> start = x - body.points.displacement[p];
    const double initial =
        wall.shape().signed_distance(moves ? wall.motion().rest(start, 0.0) : start).distance;
    if (initial < -0.5 * h) continue;  // it began behind the wall, as another body's neighbour may
    if (moves) {
      d.closest = wall.motion().position(d.closest, t);
      d.normal = (wall.motion().rotation(t) * d.normal).eval();
    }
    // The distance follows the stretch of the fibre that now points to the wall: else a body that is squeezed
    // and released would be pushed out by every squeeze and fall back after it, and sink into itself.
    const double stretch = 1.0 / (body.points.deformation_gradient[p].inverse() * d.normal).norm();
    const double allowed = std::min(half, initial) * (std::isfinite(stretch) ? stretch : 1.0),
                 missing = allowed - d.distance;
    const int row = row_at(static_cast<int>(w), d.closest, d.normal);
    if (row >= 0) gap_[at(row)] = std::min(gap_[at(row)], -missing);
    const bool kept = !wall.unilateral() && wall.options().kind != WallKind::prescribed && initial <= half;
    if (wall.holds_normal() && wall.options().velocity.empty() && wall.options().displacement.empty() &&
        (missing > 0.0 || kept))
      touches_.push_back({which, missing, d.normal});
  }
}

/// Number in the whole grid of the cell at x, -1 outside of the grid.
template <int dim>
std::int64_t WallContact<dim>::cell_number(const Vec<dim>& x) const {
  if constexpr (dim == 2)
    if (!space_->structured()) return space_->triangulation().locate(x);
  MultiIndex<dim> index;
  for (int d = 0; d < dim; ++d) index[d] = space_->grid().locate(d, x[d]);
  return space_->window().cell_in_grid(index) ? number_in(space_->window().grid_cells(), index) : -1;
}

/// The row of a wall at a point of it; -1 if there is none (outside the grid).
template <int dim>
int WallContact<dim>::row_at(int wall, const Vec<dim>& x, const Vec<dim>& normal) const {
  const std::int64_t cell = cell_number(x + nudge * space_->shortest_side() * normal);
  if (cell < 0) return -1;
  const auto begin = cell_of_row_.begin(),
             end = begin + static_cast<std::ptrdiff_t>(first_row_[at(wall) + 1]);
  auto row = std::lower_bound(begin + static_cast<std::ptrdiff_t>(first_row_[at(wall)]), end, cell);
  int best = -1;
  double most = -2.0;
  for (; row != end && *row == cell; ++row)
    if (const double c = rows_[static_cast<std::size_t>(row - begin)].normal.dot(normal); c > most)
      most = c, best = static_cast<int>(row - begin);
  return best;
}

template <int dim>
void WallContact<dim>::choose_rows(double t, double dt) {
  live_.clear();
  states_.clear();
  const double h = space_->shortest_side();
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const double gap = gap_[r];
    if (gap > h) continue;
    const WallRow<dim>& row = rows_[r];
    const auto& wall = walls_[at(row.wall)];
    const bool reached = gap <= held_gap * h;
    RowState<dim> live;
    live.normal = row.normal;
    live.normal_held = wall.holds_normal();
    live.pushes = wall.unilateral() || !reached;
    live.tangent_held = wall.holds_tangent() && (reached || wall.unilateral());
    live.slips = wall.slips();
    live.friction = wall.options().friction;
    if (!live.normal_held && !live.tangent_held) continue;
    live.bias = live.pushes ? -std::max(gap, 0.0) / dt : 0.0;
    live.target = wall.motion().moves() ? Vec<dim>(wall.motion().increment(row.middle, t, dt) / dt)
                                        : Vec<dim>(Vec<dim>::Zero());
    live.target += wall.prescribed(row.normal, t, dt);
    states_.push_back(live);
    live_.emplace_back().row = static_cast<int>(r);
  }
}

template struct ContactWall<2>;
template struct ContactWall<3>;
template class WallContact<2>;
template class WallContact<3>;

}  // namespace wisp
