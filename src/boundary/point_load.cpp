#include "boundary/point_load.h"

#include <algorithm>
#include <limits>

#include "boundary/on_body.h"
#include "parallel/session.h"

namespace wisp {

template <int dim>
std::int64_t nearest_point(const Body<dim>& body, const Vec<dim>& position) {
  double best = std::numeric_limits<double>::max();
  std::int64_t id = std::numeric_limits<std::int64_t>::max();
  for (std::size_t p = 0; p < body.points.position.size(); ++p) {
    const double distance = (body.points.position[p] - position).squaredNorm();
    if (distance < best || (distance == best && body.points.id[p] < id))
      best = distance, id = body.points.id[p];
  }
  const double least = Session::min(best);
  return Session::min(best == least ? id : std::numeric_limits<std::int64_t>::max());
}

template <int dim>
PointLoad<dim>::PointLoad(const PointLoadOptions& options, const std::vector<Body<dim>>& bodies,
                          const Space<dim>&)
    : options_(options) {
  body_ = body_index(bodies, options.body, "load '" + options.label + "'");
  if (options.nearest.empty()) input_error("load '{}': nearest needs at least one position", options.label);
  for (const auto& list : options.nearest)
    ids_.push_back(nearest_point(bodies[body_], as_vector<dim>(list, "load", options.label, "nearest")));
  auto sorted = ids_;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    input_error("load '{}': two positions in nearest choose the same point", options.label);
  share_ = as_vector<dim>(options.force, "load", options.label, "force") / static_cast<double>(ids_.size());
}

template <int dim>
void PointLoad<dim>::add_force(const Space<dim>& space, const std::vector<Body<dim>>& bodies, double t,
                               std::span<double> force) const {
  const Particles<dim>& points = bodies[body_].points;
  const Vec<dim> f = options_.factor(t) * share_;
  for (std::size_t p = 0; p < points.id.size(); ++p) {
    if (std::find(ids_.begin(), ids_.end(), points.id[p]) == ids_.end()) continue;
    const Vec<dim> l = points.half_length.empty() ? Vec<dim>::Zero() : points.half_length[p];
    for_each_function<dim>(space, points.position[p], l, [&](int i, double phi, const Vec<dim>&) {
      for (int d = 0; d < dim; ++d) force[static_cast<std::size_t>(i * dim + d)] += phi * f[d];
    });
  }
}

template class PointLoad<2>;
template class PointLoad<3>;
template std::int64_t nearest_point<2>(const Body<2>&, const Vec<2>&);
template std::int64_t nearest_point<3>(const Body<3>&, const Vec<3>&);

}  // namespace wisp
