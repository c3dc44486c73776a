#include "particle/initial_state.h"

#include <algorithm>

#include "core/error.h"

namespace wisp {

namespace {

template <int dim>
Vec<dim> vector_or_zero(const std::vector<double>& list, const char* key, const std::string& body) {
  if (list.empty()) return Vec<dim>::Zero();
  if (list.size() != dim) input_error("body '{}': {} needs {} values, found {}", body, key, dim, list.size());
  return Eigen::Map<const Vec<dim>>(list.data());
}

template <int dim>
Mat<dim> velocity_gradient(const BodyOptions& options) {
  Mat<dim> gradient = Mat<dim>::Zero();
  const auto& rows = options.velocity_gradient;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows.size() != dim || rows[i].size() != dim)
      input_error("body '{}': velocity_gradient needs {} rows of {} values", options.label, dim, dim);
    for (std::size_t j = 0; j < dim; ++j) gradient(static_cast<int>(i), static_cast<int>(j)) = rows[i][j];
  }
  return gradient;
}

}  // namespace

template <int dim>
InitialState<dim>::InitialState(const BodyOptions& options)
    : options_(options),
      body_{options.label, {}, make_material<dim>(options.material)},
      velocity_(vector_or_zero<dim>(options.velocity, "velocity", options.label)),
      centre_(vector_or_zero<dim>(options.velocity_centre, "velocity_centre", options.label)),
      gradient_(velocity_gradient<dim>(options)) {
  if (options.k0 && !options.initial_stress.empty())
    input_error("body '{}': give either initial_stress or k0", options.label);
  if (!options.initial_stress.empty() && options.initial_stress.size() != sym_size<dim>)
    input_error("body '{}': initial_stress needs {} values, found {}", options.label, sym_size<dim>,
                options.initial_stress.size());
}

template <int dim>
Sym<dim> InitialState<dim>::stress_at(const Vec<dim>& x) const {
  if (!options_.initial_stress.empty()) return Eigen::Map<const Sym<dim>>(options_.initial_stress.data());
  Sym<dim> sigma = Sym<dim>::Zero();
  if (!options_.k0) return sigma;
  const double depth = std::max(0.0, options_.k0->surface - x[dim - 1]);
  const double vertical = -body_.density() * options_.k0->gravity * depth;
  for (int a = 0; a < 3; ++a) sigma[a] = options_.k0->k0 * vertical;
  sigma[dim - 1] = vertical;
  return sigma;
}

template <int dim>
void InitialState<dim>::add(std::int64_t id, const Vec<dim>& x, double volume, const Vec<dim>& velocity) {
  Particles<dim>& points = body_.points;
  points.id.push_back(id);
  points.cell.push_back(0);
  points.position.push_back(x);
  points.displacement.push_back(Vec<dim>::Zero());
  points.velocity.push_back(velocity_ + gradient_ * (x - centre_) + velocity);
  points.mass.push_back(body_.density() * volume);
  points.volume.push_back(volume);
  points.deformation_gradient.push_back(Mat<dim>::Identity());
  std::visit([&](auto& m) { m.old.push_back(m.law.template initial<dim>(stress_at(x))); }, body_.material);
}

template class InitialState<2>;
template class InitialState<3>;

}  // namespace wisp
