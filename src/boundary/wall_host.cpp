#include "boundary/wall_host.h"

#include <cmath>
#include <limits>

namespace wisp {

namespace {

constexpr double nudge = 1e-6;  // of the shortest height
constexpr double infinite = std::numeric_limits<double>::infinity();

template <int dim>
std::optional<WallHost<dim>> host_on_grid(const Space<dim>& space, const ActiveCells& active,
                                          const WallPart<dim>& part) {
  const auto& grid = space.grid();
  const auto& window = space.window();
  MultiIndex<dim> cell = part.host;
  const auto filled = [&] {
    return window.cell_in_grid(cell) && window.contains_cell(cell) &&
           active.bits[static_cast<std::size_t>(window.cell_index(cell))] != 0;
  };
  const auto found = [&](bool extrapolated) {
    double extent = 0.0;
    for (int d = 0; d < dim; ++d) extent += part.normal[d] * part.normal[d] * grid.spacing(d, cell[d]);
    return WallHost<dim>{cell, window.cell_index(cell), extrapolated, extent};
  };
  if (filled()) return found(false);
  double reach = 0.0;
  for (int d = 0; d < dim; ++d)
    if (window.cell_in_grid(part.host))
      reach += part.normal[d] * part.normal[d] * grid.spacing(d, part.host[d]);
  if (reach == 0.0) reach = grid.shortest_side();
  // Along the ray from the middle to the next grid line, and the next.
  for (int crossings = 0; crossings < dim; ++crossings) {
    double nearest = infinite;
    int direction = 0;
    for (int d = 0; d < dim; ++d) {
      const double n = part.normal[d];
      if (std::abs(n) < 1e-12 || cell[d] < -1 || cell[d] > grid.cells(d)) continue;
      const double s = (grid.line(d, n > 0 ? cell[d] + 1 : cell[d]) - part.middle[d]) / n;
      if (s < nearest) nearest = s, direction = d;
    }
    if (nearest > reach) return {};
    cell[direction] += part.normal[direction] > 0 ? 1 : -1;
    if (filled()) return found(true);
  }
  return {};
}

/// A ray through a triangulation.
struct Ray {
  Vec<2> start, along;
  Vec<2> at(double s) const { return start + s * along; }
};

/// The triangle through whose boundary edge a ray first comes into the grid; -1 if it never does. `s` becomes
/// where.
int enter(const Triangulation& mesh, const Ray& ray, double& s) {
  int entered = -1;
  s = infinite;
  for (int e = 0; e < mesh.n_edges(); ++e) {
    const auto& edge = mesh.edge(e);
    if (!edge.boundary()) continue;
    const Vec<2> p = mesh.vertex(edge.vertex[0]), side = mesh.vertex(edge.vertex[1]) - p;
    const double into = side[0] * ray.along[1] - side[1] * ray.along[0];  // the triangle lies on the left
    if (into <= 0.0) continue;
    const Vec<2> d = p - ray.start;
    const double where = (side[0] * d[1] - side[1] * d[0]) / into;
    const double share = (ray.along[0] * d[1] - ray.along[1] * d[0]) / into;
    if (where >= 0.0 && where < s && share >= 0.0 && share <= 1.0) s = where, entered = edge.triangle[0];
  }
  return entered;
}

/// The corner from which the edge starts through which a ray leaves a triangle; `s` becomes where.
int leave(const Triangulation& mesh, int t, const Ray& ray, double& s) {
  const auto b = mesh.barycentric(t, ray.start);
  const auto gradient = mesh.barycentric_gradients(t);
  double least = infinite;
  int edge = 0;
  for (int opposite = 0; opposite < 3; ++opposite) {
    const auto k = static_cast<std::size_t>(opposite);
    const double rate = gradient[k].dot(ray.along);
    if (rate >= 0.0) continue;
    if (const double where = -b[k] / rate; where < least) least = where, edge = (opposite + 1) % 3;
  }
  s = std::max(s, least);
  return edge;
}

double width(const Triangulation& mesh, int t, const Vec<2>& direction) {
  double low = infinite, high = -infinite;
  for (int k = 0; k < 3; ++k) {
    const double x = direction.dot(mesh.corner(t, k));
    low = std::min(low, x), high = std::max(high, x);
  }
  return high - low;
}

double shortest_height(const Triangulation& mesh, int t) {
  return std::min({mesh.height(t, 0), mesh.height(t, 1), mesh.height(t, 2)});
}

std::optional<WallHost<2>> host_on_triangles(const Space<2>& space, const ActiveCells& active,
                                             const WallPart<2>& part) {
  const Triangulation& mesh = space.triangulation();
  const auto filled = [&](int t) { return active.bits[static_cast<std::size_t>(t)] != 0; };
  int t = part.host[0];
  if (t >= 0 && filled(t)) return WallHost<2>{part.host, t, false, shortest_height(mesh, t)};
  // A little aside, so that no ray from the middle of a part passes through vertices of regular grids.
  const double little = nudge * mesh.shortest_height();
  const Ray ray{part.middle + little * Vec<2>(-part.normal[1], part.normal[0]), part.normal};
  double s = 0.0;
  if (t < 0) t = enter(mesh, ray, s);
  if (t < 0) return {};
  const double reach = width(mesh, t, ray.along);
  for (int crossings = 0; s <= reach && crossings < mesh.n_triangles(); ++crossings) {
    if (filled(t))
      return WallHost<2>{{t, sub_triangle(space, t, ray.at(s + little))}, t, true, shortest_height(mesh, t)};
    t = mesh.neighbour(t, leave(mesh, t, ray, s));
    if (t < 0) return {};
  }
  return {};
}

}  // namespace

template <int dim>
std::optional<WallHost<dim>> find_host(const Space<dim>& space, const ActiveCells& active,
                                       const WallPart<dim>& part) {
  if constexpr (dim == 2)
    if (!space.structured()) return host_on_triangles(space, active, part);
  return host_on_grid(space, active, part);
}

template <int dim>
void cut_piece(const Space<dim>& space, const WallPiece<dim>& piece, WallCut<dim>& cut) {
  if constexpr (dim == 2)
    if (!space.structured())
      return visit_on_triangles(space, [&](const auto& basis) {
        const PowellSabinSplit* split = nullptr;
        if constexpr (requires { basis.split(); }) split = &basis.split();
        cut_piece(basis.triangulation(), split, basis.degree > 2 ? 4 : 3, piece, cut);
      });
  cut_piece(space.grid(), piece, cut);
}

template std::optional<WallHost<2>> find_host<2>(const Space<2>&, const ActiveCells&, const WallPart<2>&);
template std::optional<WallHost<3>> find_host<3>(const Space<3>&, const ActiveCells&, const WallPart<3>&);
template void cut_piece<2>(const Space<2>&, const WallPiece<2>&, WallCut<2>&);
template void cut_piece<3>(const Space<3>&, const WallPiece<3>&, WallCut<3>&);

}  // namespace wisp
