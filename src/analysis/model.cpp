#include "analysis/model.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "grid/triangulate.h"
#include "parallel/migrate.h"
#include "particle/order.h"
#include "particle/sampling.h"
#include "particle/triangle_sampling.h"

namespace wisp {

namespace {

/// Points out of order up to this share are left where they are: sorting costs more than they do. In the
/// block of `wisp bench`, which loses 1 % of its order a step, 0.02 is 10 % slower; 0.1 is as fast.
constexpr double tolerated_disorder = 0.05;

template <int dim>
MultiIndex<dim> cell_of(const StructuredGrid<dim>& grid, const Vec<dim>& x) {
  MultiIndex<dim> cell;
  for (int d = 0; d < dim; ++d) cell[d] = grid.locate_inside(d, x[d]);
  return cell;
}

}  // namespace

template <int dim>
Model<dim>::Model(const ModelOptions& given) : options(given) {
  if (options.triangulation)
    sample_on_triangulation();
  else
    sample_on_grid();
  keep_owned();
  for (const auto& o : options.boundaries)
    boundaries.push_back(make_boundary<dim>(o, *space, options.folder));
  constraints = constraints_of(boundaries, space->n_functions());
  for (const auto& o : options.loads) loads.push_back(make_load<dim>(o, bodies, *space));
  reactions.assign(boundaries.size(), Vec<dim>::Zero());
  moments.assign(boundaries.size(), Moment<dim>::Zero());
  settle();
}

template <int dim>
void Model<dim>::sample_on_grid() {
  const bool domains = std::holds_alternative<GimpOptions>(options.basis);
  for (const auto& body : options.bodies)
    if (body.sampling.method == SamplingMethod::random || body.sampling.volumes == PointVolumes::voronoi)
      input_error("body '{}': random points and Voronoi volumes need a triangulation", body.label);
  const StructuredGrid<dim> grid(options.grid);
  std::vector<Sampler<dim>> samplers;
  std::vector<MultiIndex<dim>> cells;
  for (const auto& body : options.bodies) {
    const auto& share = samplers.emplace_back(body, grid, options.folder).share();
    cells.insert(cells.end(), share.begin(), share.end());
  }
  space = std::make_unique<Space<dim>>(grid, BoxPartition<dim>(grid.cells(), cells), options.basis);
  std::int64_t id = 0;
  for (const auto& sampler : samplers) {
    bodies.push_back(sampler.points(space->window().owned_cells(), domains, id));
    id += sampler.count();
  }
}

template <int dim>
void Model<dim>::sample_on_triangulation() {
  if constexpr (dim == 2) {
    if (Session::size() > 1)
      input_error("grids of triangles run on one rank, but {} were started; use --ranks 1", Session::size());
    const auto mesh =
        std::make_shared<const Triangulation>(make_triangulation(*options.triangulation, options.folder));
    std::int64_t id = 0;
    for (const auto& body : options.bodies) {
      bodies.push_back(sample(body, *mesh, id, options.folder));
      id += bodies.back().points.size();
    }
    space = std::make_unique<Space<2>>(mesh, options.basis);
  } else {
    input_error("grids of triangles are for 2D; in 3D use a structured grid");
  }
}

/// Writes the cells of points.
template <int dim>
Location Model<dim>::find_cells(Particles<dim>& points) const {
  if constexpr (dim == 2)
    if (!space->structured()) return locate(points, space->triangulation());
  return locate(points, space->grid(), space->window());
}

template <int dim>
void Model<dim>::keep_owned() {
  for (auto& body : bodies) {
    const Location found = find_cells(body.points);
    const int outside = Session::rank() == 0 ? -1 : 0;  // rank 0 keeps those too
    std::vector<char> gone(body.points.cell.size());
    for (std::size_t p = 0; p < gone.size(); ++p)
      gone[p] = body.points.cell[p] < 0 && body.points.cell[p] != outside;
    remove(body, gone);
    if (found.outside == 0 || Session::rank() != 0) reorder(body, space->n_cells(), order_memory_);
  }
}

template <int dim>
Vec<dim> Model<dim>::gravity(double t) const {
  if (!options.gravity) return Vec<dim>::Zero();
  return options.gravity->factor(t) * Eigen::Map<const Vec<dim>>(options.gravity->acceleration.data());
}

template <int dim>
void Model<dim>::add_loads(double t, std::span<double> force) const {
  for (const auto& load : loads)
    std::visit([&](const auto& l) { l.add_force(*space, bodies, t, force); }, load);
  if (!body_acceleration) return;
  std::visit(
      [&](const auto& basis) {
        for (const auto& body : bodies) {
          const Particles<dim>& points = body.points;
          for (std::size_t p = 0; p < points.position.size(); ++p) {
            const Vec<dim> f =
                points.mass[p] * body_acceleration(points.position[p] - points.displacement[p], t);
            const Vec<dim> l = points.half_length.empty() ? Vec<dim>::Zero() : points.half_length[p];
            basis.tabulate(points.position[p], l).for_each([&](int, int i, double phi, const Vec<dim>&) {
              for (int d = 0; d < dim; ++d) force[static_cast<std::size_t>(i * dim + d)] += phi * f[d];
            });
          }
        }
      },
      space->basis());
}

template <int dim>
void Model<dim>::move_loads(std::span<const double> field, int stride, double factor) {
  for (auto& load : loads)
    std::visit(
        [&](auto& l) {
          if constexpr (requires { l.move(*space, field, stride, factor); })
            l.move(*space, field, stride, factor);
        },
        load);
}

template <int dim>
std::int64_t Model<dim>::n_points() const {
  std::int64_t n = 0;
  for (const auto& body : bodies) n += body.points.size();
  return Session::sum(n);
}

template <int dim>
void Model<dim>::settle() {
  Eigen::Matrix<int, 2, 1> found(0, 0);
  disorder_.clear();
  for (auto& body : bodies) {
    const Location location = find_cells(body.points);
    disorder_.push_back(location.disorder);
    found += Eigen::Matrix<int, 2, 1>(location.outside, location.elsewhere);
  }
  if (Session::size() > 1) found = Session::sum(found);
  if (found[0] > 0) remove_outside(static_cast<std::size_t>(found[0]));
  if (found[1] > 0) migrate();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const bool moved = found[0] > 0 || found[1] > 0;
    if (moved || disorder_[b] > tolerated_disorder * bodies[b].points.size())
      reorder(bodies[b], space->n_cells(), order_memory_), ++reorderings;
  }
  if (space->domains()) choose_width();
  std::optional<ActiveCells> active;
  for (auto& load : loads)
    std::visit(
        [&](auto& l) {
          if constexpr (requires(const ActiveCells& cells) { l.settle(*space, cells); }) {
            if (!active) active = active_cells(*space, bodies);
            l.settle(*space, *active);
          }
        },
        load);
}

template <int dim>
void Model<dim>::remove_outside(std::size_t outside) {
  std::string examples;
  int shown = 0;
  for (auto& body : bodies) {
    std::vector<char> gone(body.points.cell.size());
    for (std::size_t p = 0; p < gone.size(); ++p) {
      gone[p] = body.points.cell[p] == -1;
      if (!gone[p] || shown++ >= 5) continue;
      examples +=
          fmt::format("{}{} of '{}' at (", examples.empty() ? "" : ", ", body.points.id[p], body.name);
      for (int d = 0; d < dim; ++d)
        examples += fmt::format("{}{:.6g}", d ? ", " : "", body.points.position[p][d]);
      examples += ")";
    }
    if (options.leaving() == Leaving::remove) remove(body, gone);
  }
  if (options.leaving() == Leaving::remove) {
    removed += static_cast<std::int64_t>(outside);
    return;
  }
  std::string error;
  if (!examples.empty())
    error = fmt::format(
        "step {} at t = {:.6g} s: {} point{} left the grid: {}; enlarge the grid, hold its edge by a "
        "boundary, set leaving = \"remove\" in [grid], or if too long a step threw them out, use a smaller "
        "dt or "
        "cfl",
        step, time, outside, outside == 1 ? "" : "s", examples);
  Session::raise_together(error);
}

template <int dim>
void Model<dim>::migrate() {
  for (auto& body : bodies) {
    std::vector<int> destination;
    destination.reserve(body.points.position.size());
    for (const auto& x : body.points.position)
      destination.push_back(space->partition().owner_of_cell(cell_of(space->grid(), x)));
    const Migration migration(destination);
    body.for_each_field([&](std::string_view, auto& field) {
      // A rank without points still has to know which fields the others use.
      const bool used = Session::any_of(!field.empty());
      if (used) migration.move(field);
    });
    find_cells(body.points);
  }
}

template <int dim>
void Model<dim>::choose_width() {
  Vec<dim> longest = Vec<dim>::Zero();
  for (const auto& body : bodies)
    for (const auto& l : body.points.half_length) longest = longest.cwiseMax(l);
  const StructuredGrid<dim>& grid = space->grid();
  constexpr double rounding = 1.0 + 1e-12;
  bool narrow = true, wide = true;
  for (int d = 0; d < dim; ++d) {
    double h = grid.spacing(d, 0);
    for (int c = 1; c < grid.cells(d); ++c) h = std::min(h, grid.spacing(d, c));
    narrow &= 2.0 * longest[d] <= h * rounding;
    wide &= 2.0 * longest[d] <= 3.0 * h * rounding;
  }
  if (std::visit([](const auto& basis) { return basis.width; }, space->basis()) != (narrow ? 3 : 5))
    space->set_width(narrow ? 3 : 5);
  std::string fault;
  if (!wide) fault = oversized_domain();
  Session::raise_together(fault);
}

/// Words about a point whose domain covers more cells than a stencil has; none if there is no such point.
template <int dim>
std::string Model<dim>::oversized_domain() const {
  const StructuredGrid<dim>& grid = space->grid();
  // The shortest cell is too short for the longest domain; but they may be far apart.
  for (const auto& body : bodies)
    for (std::size_t p = 0; p < body.points.position.size(); ++p)
      for (int d = 0; d < dim; ++d) {
        const double x = body.points.position[p][d], l = body.points.half_length[p][d];
        const int c = grid.locate(d, x), first = grid.locate(d, x - l), last = grid.locate(d, x + l);
        if (!(std::isfinite(l)) || last - first > 3 || c - first > 2 || last - c > 2)
          return fmt::format(
              "step {} at t = {:.6g} s: the domain of point {} of '{}' has grown to {:.4g} m in direction {} "
              "and covers more "
              "than four cells; use larger cells, smaller domains (more points), or linear functions",
              step, time, body.points.id[p], body.name, 2 * l, "xyz"[d]);
      }
  return {};
}

template <int dim>
bool Model<dim>::rebalance() {
  if (Session::size() == 1 || !space->structured()) return false;
  std::int64_t n = 0;
  for (const auto& body : bodies) n += body.points.size();
  if (imbalance(n) <= 1.1) return false;
  const StructuredGrid<dim> grid = space->grid();
  std::vector<MultiIndex<dim>> cells;
  for (const auto& body : bodies)
    for (const auto& x : body.points.position) cells.push_back(cell_of(grid, x));
  const BoxPartition<dim> partition(grid.cells(), cells);
  if (partition == space->partition()) return false;
  make_space(partition);
  migrate();
  settle();
  return true;
}

template <int dim>
void Model<dim>::make_space(const BoxPartition<dim>& partition) {
  const StructuredGrid<dim> grid = space->grid();
  space = std::make_unique<Space<dim>>(grid, partition, options.basis);
  // Walls keep what they carry; conforming conditions find their functions anew.
  for (std::size_t k = 0; k < boundaries.size(); ++k)
    if (const auto* o = std::get_if<ConformingOptions>(&options.boundaries[k]))
      boundaries[k] = make_boundary<dim>(*o, *space);
  constraints = constraints_of(boundaries, space->n_functions());
}

template struct Model<2>;
template struct Model<3>;

}  // namespace wisp
