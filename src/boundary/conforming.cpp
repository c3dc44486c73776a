#include "boundary/conforming.h"

#include <cmath>

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
  const StructuredGrid<dim>& grid = space.grid();
  if (options.normal.empty() == options.node.empty())
    input_error("boundary '{}': give either normal and at (a grid line or plane), or node", label);
  if (options.displacement && options.velocity)
    input_error("boundary '{}': give either displacement or velocity", label);
  if (options.directions.empty())
    input_error("boundary '{}': directions is empty; name the constrained directions", label);
  for (const auto& text : options.directions)
    holds_[static_cast<std::size_t>(direction_of(text, dim, label, "directions"))] = true;
  check_length<dim>(options.node, "node", label);
  check_length<dim>(options.lower, "lower", label);
  check_length<dim>(options.upper, "upper", label);

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
