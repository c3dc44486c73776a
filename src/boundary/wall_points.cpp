// What walls do to the points near them.
#include <algorithm>
#include <cmath>

#include "boundary/wall_contact.h"

namespace wisp {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double return_share = 0.1;  // of what a point is too close by, a step
constexpr double blend_share = 0.1;   // of the difference to the grid's velocity, a step
constexpr double light_share = 0.05;  // of the mass of a full cell

}  // namespace

/// Whether this rank has the functions of the cell that x lies in.
template <int dim>
bool WallContact<dim>::in_window(const Vec<dim>& x) const {
  if (!x.allFinite()) return false;
  if (!space_->structured()) return space_->contains(x);
  const StructuredGrid<dim>& grid = space_->grid();
  MultiIndex<dim> cell;
  for (int d = 0; d < dim; ++d) {
    cell[d] = grid.locate_inside(d, x[d]);
    if (cell[d] < 0 || cell[d] >= grid.cells(d)) return false;
  }
  return space_->window().contains_cell(cell);
}

/// Calls f(points, p, stencil) for every point near a wall.
template <int dim>
template <class F>
void WallContact<dim>::for_each_near_stencil(const std::vector<Body<dim>>& bodies, F&& f) const {
  std::visit(
      [&](const auto& basis) {
        using Basis = std::decay_t<decltype(basis)>;
        const Vec<dim> none = Vec<dim>::Zero();
        for (const PointOf& which : points_) {
          const Particles<dim>& points = bodies[at(which.body)].points;
          const auto p = at(which.point);
          const Vec<dim>& half = Basis::uses_domains ? points.half_length[p] : none;
          // In a run that breaks up a point has left before the next step says so.
          if (in_window(points.position[p] - half) && in_window(points.position[p] + half))
            f(which, points, p, basis.tabulate(points.position[p], half));
        }
      },
      space_->basis());
}

/// Of triangulations: integrals of all functions, by the midpoints of edges (of sub-triangles of split ones),
/// and the triangles of each.
template <int dim>
void WallContact<dim>::list_functions() {
  if constexpr (dim == 2) {
    function_volume_.assign(slot_.size(), 0.0);
    triangles_of_.assign(slot_.size(), {});
    visit_on_triangles(*space_, [&](const auto& basis) {
      const Triangulation& mesh = basis.triangulation();
      const auto add = [&](int t, int sub, const std::array<Vec<2>, 3>& v) {
        const Vec<2> a = v[1] - v[0], b = v[2] - v[0];
        const double share = 0.5 * std::abs(a[0] * b[1] - a[1] * b[0]) / 3.0;
        for (std::size_t k = 0; k < 3; ++k) {
          const auto f = triangle_functions(*space_, t, sub, 0.5 * (v[k] + v[(k + 1) % 3]));
          for (std::size_t i = 0; i < static_cast<std::size_t>(f.n); ++i)
            function_volume_[at(f.function[i])] += share * f.phi[i];
        }
      };
      for (int t = 0; t < mesh.n_triangles(); ++t) {
        for (const int i : basis.functions(t)) triangles_of_[at(i)].push_back(t);
        if constexpr (requires { basis.split(); }) {
          for (int edge = 0; edge < 3; ++edge)
            for (int side = 0; side < 2; ++side)
              add(t, 2 * edge + side,
                  {mesh.corner(t, (edge + side) % 3), basis.split().edge_point(mesh.edge(t, edge)),
                   basis.split().centre(t)});
        } else {
          add(t, 0, {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)});
        }
      }
    });
  }
}

/// The cells in which a function is not zero.
template <int dim>
void WallContact<dim>::mark_cells_of(int function) {
  const auto mark = [&](int c) {
    if (!light_cell_[at(c)]) light_cell_[at(c)] = 1, light_cells_.push_back(c);
  };
  if (!space_->structured()) {
    for (const int t : triangles_of_[at(function)]) mark(t);
    return;
  }
  const auto& window = space_->window();
  const MultiIndex<dim> node = window.node_multi_index(function);
  for_each_in(IndexBox<dim>{node - MultiIndex<dim>::Ones(), node + MultiIndex<dim>::Ones()},
              [&](const MultiIndex<dim>& cell) {
                if (window.contains_cell(cell)) mark(window.cell_index(cell));
              });
}

/// Functions whose mass over their volume in full cells is less than `light` (kg/m3, kg/m2) get numbers; the
/// cells around them are marked.
template <int dim>
void WallContact<dim>::find_light_functions(const StepMass& mass, double light) {
  for (const int f : light_functions_) light_number_[at(f)] = -1;
  for (const int c : light_cells_) light_cell_[at(c)] = 0;
  light_functions_.clear();
  light_cells_.clear();
  light_number_.resize(slot_.size(), -1);
  light_cell_.resize(at(space_->n_cells()), 0);
  const bool triangles = !space_->structured();
  if (triangles && triangles_of_.empty()) list_functions();
  const double cell = std::pow(space_->shortest_side(), dim);
  for (std::size_t f = 0; f < slot_.size(); ++f) {
    const double m = mass.sums[f * at(mass.stride)];
    if (!(m > 0.0) || m >= light * (triangles ? function_volume_[f] : cell)) continue;
    light_number_[f] = static_cast<int>(light_functions_.size());
    light_functions_.push_back(static_cast<int>(f));
    mark_cells_of(static_cast<int>(f));
  }
}

template <int dim>
void WallContact<dim>::calm_light_functions(const std::vector<Body<dim>>& bodies, const StepMass& mass,
                                            double dt, std::span<double> motion, int stride) {
  double density = 0.0;
  for (const auto& body : bodies) density = std::max(density, body.density());
  find_light_functions(mass, light_share * density);
  if (!Session::any_of(!light_functions_.empty())) return;
  momentum_.assign(light_functions_.size() * dim, 0.0);
  std::visit(
      [&](const auto& basis) {
        for (const auto& body : bodies) {
          const Particles<dim>& points = body.points;
          for (std::size_t p = 0; p < points.position.size(); ++p) {
            if (!light_cell_[at(points.cell[p])]) continue;
            const auto stencil = basis.tabulate(points.position[p], Vec<dim>::Zero());
            Vec<dim> v = points.velocity[p];
            stencil.for_each([&](int, int i, double phi, const Vec<dim>&) {
              for (int d = 0; d < dim; ++d) v[d] += dt * phi * motion[at(i) * at(stride) + at(dim + d)];
            });
            stencil.for_each([&](int, int i, double phi, const Vec<dim>&) {
              if (const int k = light_number_[at(i)]; k >= 0)
                for (int d = 0; d < dim; ++d) momentum_[at(k) * dim + at(d)] += phi * points.mass[p] * v[d];
            });
          }
        }
      },
      space_->basis());
  if (Session::size() > 1) {  // points of other ranks reach the same functions
    std::vector<double> all(slot_.size() * dim, 0.0);
    for (std::size_t k = 0; k < light_functions_.size(); ++k)
      std::copy_n(momentum_.begin() + static_cast<std::ptrdiff_t>(k * dim), dim,
                  all.begin() + light_functions_[k] * dim);
    space_->nodes().add_update(all.data(), dim);
    for (std::size_t k = 0; k < light_functions_.size(); ++k)
      std::copy_n(all.begin() + light_functions_[k] * dim, dim,
                  momentum_.begin() + static_cast<std::ptrdiff_t>(k * dim));
  }
  for (std::size_t k = 0; k < light_functions_.size(); ++k) {
    const auto f = at(light_functions_[k]);
    const double m = mass.sums[f * at(mass.stride)];
    for (std::size_t d = 0; d < dim; ++d)
      if (mass.fixed.empty() || !mass.fixed[f * dim + d])
        motion[f * at(stride) + d] = momentum_[k * dim + d] / m;
  }
  if (live_.empty()) return;
  take_values([&](std::size_t f, std::size_t d) { return motion[f * at(stride) + d]; });
  project();
  give_values([&](std::size_t f, std::size_t d, std::size_t k) { motion[f * at(stride) + d] = value_[k]; });
}

template <int dim>
void WallContact<dim>::correct_points(std::vector<Body<dim>>& bodies) {
  if (space_->domains()) blend(bodies);
  for (const Touch& touch : touches_) {
    Particles<dim>& points = bodies[at(touch.at.body)].points;
    const Vec<dim> move = return_share * touch.missing * touch.normal;
    points.position[at(touch.at.point)] += move;
    points.displacement[at(touch.at.point)] += move;
  }
}

/// v_p += share sum_i phi_i (v_i + w_i x (x_p - x_i) - v_p) over the functions of loaded rows, with the mean
/// position, velocity and rotation of the same points: neither momentum nor angular momentum changes.
template <int dim>
void WallContact<dim>::blend(std::vector<Body<dim>>& bodies) {
  loaded_.assign(functions_.size(), 0);
  bool any = false;
  for (std::size_t r = 0; r < live_.size(); ++r)
    if (states_[r].loaded())
      for (std::size_t i = 0; i < live_[r].n; ++i) loaded_[at(live_[r].slot[i])] = 1, any = true;
  if (!any) return;
  using Sums = MotionSums<dim>;
  momentum_.assign(functions_.size() * Sums::count, 0.0);
  for_each_near_stencil(
      bodies, [&](const PointOf&, const Particles<dim>& points, std::size_t p, const auto& stencil) {
        stencil.for_each([&](int, int i, double phi, const Vec<dim>&) {
          const int s = slot_[at(i)];
          if (s >= 0 && loaded_[at(s)])
            Sums::add(phi * points.mass[p], points.position[p] - space_->node_position(i), points.velocity[p],
                      momentum_.data() + at(s) * Sums::count);
        });
      });
  if (Session::size() > 1) Session::sum_in_place(momentum_);
  std::vector<MeanMotion<dim>>& mean = mean_motion_;
  mean.resize(functions_.size());
  for (std::size_t s = 0; s < functions_.size(); ++s)
    if (loaded_[s]) mean[s] = Sums::motion(momentum_.data() + s * Sums::count);
  for_each_near_stencil(bodies, [&](const PointOf& which, const Particles<dim>& points, std::size_t p,
                                    const auto& stencil) {
    Vec<dim> change = Vec<dim>::Zero();
    stencil.for_each([&](int, int i, double phi, const Vec<dim>&) {
      const int s = slot_[at(i)];
      if (s >= 0 && loaded_[at(s)])
        change +=
            phi * (mean[at(s)].velocity(points.position[p] - space_->node_position(i)) - points.velocity[p]);
    });
    bodies[at(which.body)].points.velocity[p] += blend_share * change;
  });
}

template class WallContact<2>;
template class WallContact<3>;

}  // namespace wisp
