#include "boundary/conforming.h"

#include <cmath>

#include "basis/edge_functions.h"
#include "core/error.h"

namespace wisp {

namespace {

int direction_of(const std::string& text, int dim, const std::string& condition, const char* key) {
  const int d = text == "x" ? 0 : text == "y" ? 1 : text == "z" ? 2 : -1;
  if (d < 0 || d >= dim)
    input_error("boundary '{}': {} must be {}, found '{}'", condition, key, dim == 2 ? "x or y" : "x, y or z",
                text);
  return d;
}

/// Index of the grid line nearest to x; it must be there within a millionth of the shortest side.
template <int dim>
int line_at(const StructuredGrid<dim>& grid, int d, double x, const std::string& condition) {
  int best = 0;
  for (int i = 1; i <= grid.cells(d); ++i)
    if (std::abs(grid.line(d, i) - x) < std::abs(grid.line(d, best) - x)) best = i;
  if (std::abs(grid.line(d, best) - x) > 1e-6 * grid.shortest_side())
    input_error("boundary '{}': no grid line at {} = {}; the nearest is at {}", condition, "xyz"[d], x,
                grid.line(d, best));
  return best;
}

template <int dim>
void check_length(const std::vector<double>& list, const char* key, const std::string& condition) {
  if (!list.empty() && list.size() != dim)
    input_error("boundary '{}': {} needs {} values, found {}", condition, key, dim, list.size());
}

}  // namespace

template <int dim>
Conforming<dim>::Conforming(const ConformingOptions& options, const Space<dim>& space) : options_(options) {
  const auto& label = options.label;
  if (options.normal.empty() + options.node.empty() + options.part.empty() != 2)
    input_error(
        "boundary '{}': give either normal and at (a grid line or plane), or node, or part (of a "
        "triangulation)",
        label);
  if (options.displacement && options.velocity)
    input_error("boundary '{}': give either displacement or velocity", label);
  if (options.directions.empty())
    input_error("boundary '{}': directions is empty; name the constrained directions", label);
  for (const auto& text : options.directions)
    holds_[static_cast<std::size_t>(direction_of(text, dim, label, "directions"))] = true;
  check_length<dim>(options.node, "node", label);
  check_length<dim>(options.lower, "lower", label);
  check_length<dim>(options.upper, "upper", label);
  if (!options.profile.empty() && options.profile.size() != dim + 1)
    input_error("boundary '{}': profile needs {} values, found {}", label, dim + 1, options.profile.size());
  bool on_triangles = false;
  if constexpr (dim == 2)
    if (!space.structured()) hold_triangulation(space), on_triangles = true;
  if (!on_triangles) {
    if (!options.part.empty()) input_error("boundary '{}': part needs a triangulation", label);
    space.nodal() ? hold_nodes(space) : hold_splines(space);
  }
  set_factors(space);
}

/// Every basis reproduces linear functions with their values at the functions' places as coefficients.
template <int dim>
void Conforming<dim>::set_factors(const Space<dim>& space) {
  factors_.assign(functions_.size(), 1.0);
  if (options_.profile.empty()) return;
  for (std::size_t k = 0; k < functions_.size(); ++k) {
    const Vec<dim> x = space.node_position(functions_[k]);
    factors_[k] = options_.profile[0];
    for (int d = 0; d < dim; ++d) factors_[k] += options_.profile[static_cast<std::size_t>(d) + 1] * x[d];
  }
}

/// B-splines interpolate where knots are repeated, on the edges of the grid alone: one function a direction
/// makes up the motion there. Of a part of an edge all are held that do not vanish on it, so that the motion
/// is exact there and free a few cells further on.
template <int dim>
void Conforming<dim>::hold_splines(const Space<dim>& space) {
  const auto& label = options_.label;
  const StructuredGrid<dim>& grid = space.grid();
  IndexBox<dim> held = space.grid_functions();
  const IndexBox<dim> all = held;
  const auto hold_edge = [&](int d, double at) {
    const int line = line_at(grid, d, at, label);
    if (line != 0 && line != grid.cells(d))
      input_error(
          "boundary '{}': B-splines are held on edges of the grid (node: at its corners), and {} = {} "
          "is none; the edges are at {} and {}",
          label, "xyz"[d], at, grid.line(d, 0), grid.line(d, grid.cells(d)));
    if (line == 0)
      held.upper[d] = 1;
    else
      held.lower[d] = held.upper[d] - 1;
  };
  const int normal = options_.normal.empty() ? -1 : direction_of(options_.normal, dim, label, "normal");
  for (int d = 0; d < dim; ++d)
    if (normal < 0 || normal == d)
      hold_edge(d, normal < 0 ? options_.node[static_cast<std::size_t>(d)] : options_.at);
  const double tolerance = 1e-6 * grid.shortest_side();
  space.visit_splines([&](const auto& basis) {
    const int degree = std::decay_t<decltype(basis)>::degree;
    for (int d = 0; d < dim; ++d) {
      const auto k = static_cast<std::size_t>(d);
      const auto knot = [&](int i) { return basis.knots(d).knots()[static_cast<std::size_t>(i)]; };
      if (d == normal || normal < 0) {
        const double at = grid.line(d, held.lower[d] == 0 ? 0 : grid.cells(d));
        if ((!options_.lower.empty() && at < options_.lower[k] - tolerance) ||
            (!options_.upper.empty() && at > options_.upper[k] + tolerance))
          held.upper[d] = held.lower[d];
        continue;
      }
      while (!options_.lower.empty() && held.lower[d] < held.upper[d] &&
             knot(held.lower[d] + degree + 1) <= options_.lower[k] + tolerance)
        ++held.lower[d];
      while (!options_.upper.empty() && held.lower[d] < held.upper[d] &&
             knot(held.upper[d] - 1) >= options_.upper[k] - tolerance)
        --held.upper[d];
    }
  });
  if (held.count() == 0)
    input_error("boundary '{}': no part of the edge lies between lower and upper", label);
  for (int d = 0; d < dim; ++d) {
    bool whole = d == normal;
    for (int e = 0; e < dim; ++e)
      whole &= e == d || (held.lower[e] == all.lower[e] && held.upper[e] == all.upper[e]);
    if (whole) edge_[static_cast<std::size_t>(2 * d + (held.lower[d] == 0 ? 0 : 1))] = true;
  }
  for_each_in(held, [&](const MultiIndex<dim>& i) {
    if (space.window().contains_node(i)) functions_.push_back(space.window().node_index(i));
  });
}

template <int dim>
void Conforming<dim>::hold_nodes(const Space<dim>& space) {
  const ConformingOptions& options = options_;
  const auto& label = options.label;
  const StructuredGrid<dim>& grid = space.grid();
  IndexBox<dim> held = space.window().grid_nodes();
  if (!options.normal.empty()) {
    const int d = direction_of(options.normal, dim, label, "normal");
    held.lower[d] = line_at(grid, d, options.at, label), held.upper[d] = held.lower[d] + 1;
  } else {
    for (int d = 0; d < dim; ++d) {
      held.lower[d] = line_at(grid, d, options.node[static_cast<std::size_t>(d)], label);
      held.upper[d] = held.lower[d] + 1;
    }
  }
  const double tolerance = 1e-6 * grid.shortest_side();
  for (int d = 0; d < dim; ++d) {
    const auto k = static_cast<std::size_t>(d);
    while (!options.lower.empty() && held.lower[d] < held.upper[d] &&
           grid.line(d, held.lower[d]) < options.lower[k] - tolerance)
      ++held.lower[d];
    while (!options.upper.empty() && held.lower[d] < held.upper[d] &&
           grid.line(d, held.upper[d] - 1) > options.upper[k] + tolerance)
      --held.upper[d];
  }
  if (held.count() == 0) input_error("boundary '{}': no grid node lies between lower and upper", label);
  for (int d = 0; d < dim; ++d) {
    // Only a condition along the whole edge plane counts as one on the edge.
    const auto k = static_cast<std::size_t>(2 * d);
    const auto& all = space.window().grid_nodes();
    bool whole = held.upper[d] - held.lower[d] == 1;
    for (int e = 0; e < dim; ++e)
      whole &= e == d || (held.lower[e] == all.lower[e] && held.upper[e] == all.upper[e]);
    if (whole) edge_[k] = held.lower[d] == 0, edge_[k + 1] = held.lower[d] == grid.cells(d);
  }
  for_each_in(held, [&](const MultiIndex<dim>& i) {
    if (space.window().contains_node(i)) functions_.push_back(space.window().node_index(i));
  });
}

template <int dim>
void Conforming<dim>::hold_triangulation(const Space<2>& space) {
  const Triangulation& mesh = space.triangulation();
  const auto& label = options_.label;
  const double tolerance = 1e-6 * mesh.shortest_height();
  const auto in_bounds = [&](int v) {
    for (int d = 0; d < 2; ++d) {
      const auto k = static_cast<std::size_t>(d);
      if (!options_.lower.empty() && mesh.vertex(v)[d] < options_.lower[k] - tolerance) return false;
      if (!options_.upper.empty() && mesh.vertex(v)[d] > options_.upper[k] + tolerance) return false;
    }
    return true;
  };
  std::vector<int> vertices;  // that are held alone
  std::vector<int> candidates;
  if (!options_.part.empty()) {
    const NamedPart& part = mesh.part(options_.part);
    candidates = part.edges;
    if (part.edges.empty()) vertices = part.vertices;
  } else if (!options_.node.empty()) {
    for (int v = 0; v < mesh.n_vertices(); ++v)
      if ((mesh.vertex(v) - Vec<2>(options_.node[0], options_.node[1])).norm() <= tolerance) vertices = {v};
    if (vertices.empty())
      input_error("boundary '{}': no vertex at ({}, {})", label, options_.node[0], options_.node[1]);
  } else {
    const int d = direction_of(options_.normal, 2, label, "normal");
    for (int e = 0; e < mesh.n_edges(); ++e) {
      const auto& ends = mesh.edge(e).vertex;
      if (std::abs(mesh.vertex(ends[0])[d] - options_.at) <= tolerance &&
          std::abs(mesh.vertex(ends[1])[d] - options_.at) <= tolerance)
        candidates.push_back(e);
    }
    if (candidates.empty())
      input_error("boundary '{}': no edge of a triangle lies on {} = {}", label, "xy"[d], options_.at);
  }
  for (const int e : candidates)
    if (in_bounds(mesh.edge(e).vertex[0]) && in_bounds(mesh.edge(e).vertex[1])) edges_.push_back(e);
  std::erase_if(vertices, [&](int v) { return !in_bounds(v); });
  if (edges_.empty() && vertices.empty())
    input_error("boundary '{}': none of its edges lies between lower and upper", label);
  try {
    visit_on_triangles(space,
                       [&](const auto& basis) { functions_ = trace_functions(basis, edges_, vertices); });
  } catch (const InputError& error) {
    input_error("boundary '{}': {}", label, error.what());
  }
}

template <int dim>
double Conforming<dim>::increment(double t, double dt) const {
  if (options_.displacement) return (*options_.displacement)(t + dt) - (*options_.displacement)(t);
  if (options_.velocity) return 0.5 * dt * ((*options_.velocity)(t) + (*options_.velocity)(t + dt));
  return 0.0;
}

template <int dim>
double Conforming<dim>::velocity(double t, double dt) const {
  if (options_.velocity) return (*options_.velocity)(t + dt);
  return dt > 0 ? increment(t, dt) / dt : 0.0;
}

template class Conforming<2>;
template class Conforming<3>;

}  // namespace wisp
