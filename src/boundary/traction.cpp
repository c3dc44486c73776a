#include "boundary/traction.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "boundary/on_body.h"
#include "parallel/session.h"

namespace wisp {

namespace {

template <int dim>
std::string place(const Vec<dim>& x) {
  std::string text;
  for (int d = 0; d < dim; ++d) text += fmt::format("{}{:.6g}", d == 0 ? "(" : ", ", x[d]);
  return text + ")";
}

/// Where a surface point at x acts on a triangulation: there if its triangle is active, else at the nearest
/// place in an active triangle around the corners of its own, a little inside, as an edge may belong to the
/// next one.
Vec<2> host_on(const Triangulation& mesh, const Vec<2>& x, const ActiveCells& active, int bit) {
  const int t = mesh.locate(x);
  if (active.bits[static_cast<std::size_t>(t)] & bit) return x;
  Vec<2> host = x;
  double nearest = std::numeric_limits<double>::max();
  for (const int v : mesh.triangle(t))
    for (const int u : mesh.triangles_of_vertex(v)) {
      if (!(active.bits[static_cast<std::size_t>(u)] & bit)) continue;
      for (int k = 0; k < 3; ++k) {  // x is outside of u, so the nearest place is on a side
        const Vec<2>&a = mesh.corner(u, k), &b = mesh.corner(u, (k + 1) % 3);
        const double along = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
        const Vec<2> on_side = a + along * (b - a);
        const double distance = (on_side - x).squaredNorm();
        if (distance >= nearest) continue;
        nearest = distance;
        host = on_side + 1e-9 * (mesh.centroid(u) - on_side);
      }
    }
  return host;
}

}  // namespace

template <int dim>
Traction<dim>::Traction(const TractionOptions& options, const std::vector<Body<dim>>& bodies,
                        const Space<dim>& space)
    : options_(options) {
  const auto& label = options.label;
  body_ = body_index(bodies, options.body, "traction '" + label + "'");
  if (options.traction.empty() == !options.pressure)
    input_error("traction '{}': give either traction or pressure", label);
  if (!options.traction.empty()) traction_ = as_vector<dim>(options.traction, "traction", label, "traction");
  if (options.edges.size() != dim - 1 || options.points.size() != dim - 1)
    input_error("traction '{}': edges and points need {} entr{} each", label, dim - 1,
                dim == 2 ? "y" : "ies");
  const Vec<dim> corner = as_vector<dim>(options.corner, "traction", label, "corner");
  Mat<dim> edge = Mat<dim>::Zero();
  for (int e = 0; e < dim - 1; ++e)
    edge.col(e) = as_vector<dim>(options.edges[static_cast<std::size_t>(e)], "traction", label, "edges");
  if constexpr (dim == 2) {
    area_ = Vec<2>(edge(1, 0), -edge(0, 0));
  } else {
    area_ = edge.col(0).cross(edge.col(1));
  }
  if (!(area_.norm() > 0)) input_error("traction '{}': the edges span no area", label);
  IndexBox<dim> box;
  box.upper.setOnes();
  for (int e = 0; e < dim - 1; ++e) box.upper[e] = options.points[static_cast<std::size_t>(e)];
  area_ /= static_cast<double>(box.count());
  for_each_in(box, [&](const MultiIndex<dim>& k) {
    Vec<dim> x = corner;
    for (int e = 0; e < dim - 1; ++e) x += edge.col(e) * ((k[e] + 0.5) / box.upper[e]);
    if (!space.contains(x))
      input_error("traction '{}': a surface point at {} lies outside the grid", label, place(x));
    position_.push_back(x);
  });
  deformation_gradient_.assign(position_.size(), Mat<dim>::Identity());
  host_ = position_;
}

template <int dim>
void Traction<dim>::settle(const Space<dim>& space, const ActiveCells& active) {
  if constexpr (dim == 2)
    if (!space.structured()) {
      for (std::size_t s = 0; s < position_.size(); ++s)
        host_[s] = host_on(space.triangulation(), position_[s], active, 1 << body_);
      return;
    }
  const auto& window = space.window();
  const auto& grid = space.grid();
  host_ = position_;
  for (std::size_t s = 0; s < position_.size(); ++s) {
    if (!mine(space, position_[s])) continue;
    const Vec<dim>& x = position_[s];
    MultiIndex<dim> cell;
    for (int d = 0; d < dim; ++d) cell[d] = grid.locate_inside(d, x[d]);
    double nearest = std::numeric_limits<double>::max();
    for_each_in(IndexBox<dim>{cell - MultiIndex<dim>::Ones(), cell + MultiIndex<dim>::Constant(2)},
                [&](const MultiIndex<dim>& c) {
                  if (!window.cell_in_grid(c) ||
                      !(active.bits[static_cast<std::size_t>(window.cell_index(c))] & (1 << body_)))
                    return;
                  Vec<dim> inside = x;
                  for (int d = 0; d < dim; ++d) {
                    // Not on the line itself, which may belong to the cell beyond.
                    const double margin = 1e-9 * grid.spacing(d, c[d]);
                    inside[d] =
                        std::clamp(x[d], grid.line(d, c[d]) + margin, grid.line(d, c[d] + 1) - margin);
                  }
                  const double distance = (inside - x).squaredNorm();
                  if (c == cell || distance < nearest)
                    nearest = c == cell ? -1.0 : distance, host_[s] = c == cell ? x : inside;
                });
  }
}

template <int dim>
bool Traction<dim>::mine(const Space<dim>& space, const Vec<dim>& x) const {
  if (!space.structured()) return true;
  MultiIndex<dim> cell;
  for (int d = 0; d < dim; ++d) cell[d] = space.grid().locate_inside(d, x[d]);
  return space.window().owns_cell(cell);
}

template <int dim>
void Traction<dim>::add_force(const Space<dim>& space, const std::vector<Body<dim>>&, double t,
                              std::span<double> force) const {
  for (std::size_t s = 0; s < position_.size(); ++s) {
    if (!mine(space, position_[s])) continue;
    Vec<dim> f;
    if (options_.pressure) {
      const Mat<dim>& F = deformation_gradient_[s];
      f = -(*options_.pressure)(t)*F.determinant() * (F.inverse().transpose() * area_);
    } else {
      f = options_.factor(t) * area_.norm() * traction_;
    }
    for_each_function<dim>(space, host_[s], Vec<dim>::Zero(), [&](int i, double phi, const Vec<dim>&) {
      for (int d = 0; d < dim; ++d) force[static_cast<std::size_t>(i * dim + d)] += phi * f[d];
    });
  }
}

template <int dim>
void Traction<dim>::move(const Space<dim>& space, std::span<const double> field, int stride, double factor) {
  for (std::size_t s = 0; s < position_.size(); ++s) {
    Vec<dim> u = Vec<dim>::Zero();
    Mat<dim> gradient = Mat<dim>::Zero();
    if (mine(space, position_[s]))
      for_each_function<dim>(space, host_[s], Vec<dim>::Zero(), [&](int i, double phi, const Vec<dim>& dphi) {
        const Vec<dim> v = Eigen::Map<const Vec<dim>>(field.data() + i * stride);
        u += phi * v, gradient += v * dphi.transpose();
      });
    // Only the rank that evaluates knows the host.
    u += gradient * (position_[s] - host_[s]);
    u = Session::sum(u), gradient = Session::sum(gradient);
    position_[s] += factor * u;
    host_[s] = position_[s];
    if (!space.contains(position_[s]))
      run_error("traction '{}': a surface point left the grid at {}; use a larger grid", name(),
                place(position_[s]));
    deformation_gradient_[s] = (Mat<dim>::Identity() + factor * gradient) * deformation_gradient_[s];
  }
}

template class Traction<2>;
template class Traction<3>;

}  // namespace wisp
