#include "io/placement.h"

#include <array>
#include <limits>

#include "core/error.h"
#include "geometry/wall_shape.h"
#include "grid/gmsh.h"

namespace wisp {
namespace {

/// Lattice points along each side of the bounding box.
template <int dim>
constexpr int divisions = dim == 2 ? 40 : 16;

std::size_t at(int d) { return static_cast<std::size_t>(d); }

template <int dim>
std::vector<Vec<dim>> lattice(const Region<dim>& shape) {
  const Block<dim> box = bounds(shape);
  const Vec<dim> step = (box.upper - box.lower) / divisions<dim>;
  std::vector<Vec<dim>> points;
  std::array<int, dim> i{};
  while (i[at(dim - 1)] < divisions<dim>) {
    Vec<dim> x;
    for (int d = 0; d < dim; ++d) x[d] = box.lower[d] + (i[at(d)] + 0.5) * step[d];
    if (contains(shape, x)) points.push_back(x);
    ++i[0];
    for (int d = 0; d + 1 < dim && i[at(d)] == divisions<dim>; ++d) i[at(d)] = 0, ++i[at(d + 1)];
  }
  return points;
}

enum class WallForm { container, obstacle, unbounded, open };

/// What a wall looks like from a body; the side of a closed polyline that is left or right of it may be
/// either.
WallForm form(const AnyWallShape& shape) {
  const auto closed = [](bool outside) { return outside ? WallForm::obstacle : WallForm::container; };
  return std::visit(
      [&]<class Shape>(const Shape& s) {
        if constexpr (std::is_same_v<Shape, PlaneWall>) {
          return s.edges.empty() ? WallForm::unbounded : WallForm::open;
        } else if constexpr (std::is_same_v<Shape, PolylineWall>) {
          return s.vertices.front() == s.vertices.back() ? closed(s.solid == LineSide::outside)
                                                         : WallForm::open;
        } else if constexpr (std::is_same_v<Shape, ArcWall>) {
          return s.to - s.from >= 360.0 ? closed(s.solid == SolidSide::outside) : WallForm::open;
        } else {
          return closed(s.solid == SolidSide::outside);
        }
      },
      shape);
}

/// True if none of the points lies on the solid side of the wall.
template <int dim>
bool behind(const std::vector<Vec<dim>>& points, const WallShape<dim>& wall, bool is_open, double reach) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& x : points) {
    const WallDistance<dim> to = wall.signed_distance(x);
    if (to.distance >= 0.0 || (is_open && to.beyond)) return false;
    nearest = std::min(nearest, -to.distance);
  }
  return !is_open || nearest <= reach;
}

}  // namespace

template <int dim>
std::vector<Vec<dim>> points_inside(const BodyOptions& body, const std::filesystem::path& folder) {
  if (const auto* file = std::get_if<PointFile>(&body.shape))
    return read_points<dim>(*file, folder).positions;
  if constexpr (dim == 2)
    if (const auto* mesh = std::get_if<MeshShape>(&body.shape)) {
      const Triangulation triangles = read_gmsh(folder / mesh->file, mesh->scale);
      std::vector<Vec<2>> middles;
      if (mesh->surface.empty())
        for (int t = 0; t < triangles.n_triangles(); ++t) middles.push_back(triangles.centroid(t));
      else
        for (const int t : triangles.part(mesh->surface).triangles) middles.push_back(triangles.centroid(t));
      return middles;
    }
  return lattice<dim>(region<dim>(body.shape, folder));
}

template <int dim>
void check_beside_walls(const BodyOptions& body, const std::vector<Vec<dim>>& inside,
                        const std::vector<WallOptions>& walls, double reach,
                        const std::filesystem::path& folder) {
  if (inside.empty()) return;
  std::string container;
  int containers = 0;
  bool held = false;
  for (const auto& wall : walls) {
    if (wall.motion) continue;
    const WallForm what = form(wall.shape);
    const bool wrong = behind(inside, WallShape<dim>(wall.shape, folder), what == WallForm::open, reach);
    if (what == WallForm::container) {
      held = held || !wrong;
      if (containers++ == 0) container = wall.label;
    } else if (wrong && what == WallForm::obstacle) {
      input_error("body \"{}\" lies wholly within wall \"{}\", whose outside is its solid side", body.label,
                  wall.label);
    } else if (wrong) {
      input_error("body \"{}\" lies wholly behind wall \"{}\": {}", body.label, wall.label,
                  what == WallForm::unbounded ? "the normal must point into the body"
                                              : "the body must be on its solid side");
    }
  }
  if (containers > 0 && !held)
    input_error("body \"{}\" lies wholly outside of {}, whose inside is solid", body.label,
                containers == 1 ? fmt::format("wall \"{}\"", container)
                                : fmt::format("each of {} walls", containers));
}

void check_on_triangles(const BodyOptions& body, const std::vector<Vec<2>>& inside,
                        const Triangulation& grid) {
  std::size_t outside = 0, first = 0;
  for (std::size_t p = 0; p < inside.size(); ++p)
    if (grid.locate(inside[p]) < 0 && outside++ == 0) first = p;
  if (outside == 0) return;
  const Vec<2>& x = inside[first];
  if (std::holds_alternative<PointFile>(body.shape))
    input_error("body \"{}\": {} of its {} points {} outside of the triangles, the first at ({:.6g}, {:.6g})",
                body.label, outside, inside.size(), outside == 1 ? "lies" : "lie", x.x(), x.y());
  input_error("body \"{}\" reaches past the triangles of the grid, at ({:.6g}, {:.6g}) for one", body.label,
              x.x(), x.y());
}

template <int dim>
void check_in_grid(const WallOptions& wall, const Block<dim>& within, const std::filesystem::path& folder) {
  if (wall.motion) return;
  const Vec<dim> extent = within.upper - within.lower;
  const Vec<dim> slack = Vec<dim>::Constant(1e-9 * extent.minCoeff());
  const Block<dim> box{within.lower - slack, within.upper + slack};
  for (const auto& piece : WallShape<dim>(wall.shape, folder).pieces(extent.minCoeff() / 64, box)) {
    Vec<dim> low = piece.vertex[0], high = low;
    for (const auto& v : piece.vertex) low = low.cwiseMin(v), high = high.cwiseMax(v);
    if ((low.array() <= box.upper.array()).all() && (high.array() >= box.lower.array()).all()) return;
  }
  const auto text = [](const Vec<dim>& x) {
    return dim == 2 ? fmt::format("({}, {})", x[0], x[1])
                    : fmt::format("({}, {}, {})", x[0], x[1], x[dim - 1]);
  };
  input_error("no part of wall \"{}\" lies in the grid, which reaches from {} to {} m", wall.label,
              text(within.lower), text(within.upper));
}

template std::vector<Vec<2>> points_inside(const BodyOptions&, const std::filesystem::path&);
template std::vector<Vec<3>> points_inside(const BodyOptions&, const std::filesystem::path&);
template void check_beside_walls(const BodyOptions&, const std::vector<Vec<2>>&,
                                 const std::vector<WallOptions>&, double, const std::filesystem::path&);
template void check_beside_walls(const BodyOptions&, const std::vector<Vec<3>>&,
                                 const std::vector<WallOptions>&, double, const std::filesystem::path&);
template void check_in_grid(const WallOptions&, const Block<2>&, const std::filesystem::path&);
template void check_in_grid(const WallOptions&, const Block<3>&, const std::filesystem::path&);

}  // namespace wisp
