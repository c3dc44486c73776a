// What loads share: the body that they act on, the functions at a place.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "basis/space.h"
#include "core/error.h"
#include "particle/body.h"

namespace wisp {

/// Index of the body with a name. Errors (InputError).
template <int dim>
std::size_t body_index(const std::vector<Body<dim>>& bodies, const std::string& name,
                       const std::string& user) {
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].name == name) return b;
  std::string names;
  for (const auto& body : bodies) names += (names.empty() ? "" : ", ") + body.name;
  input_error("{}: there is no body '{}'; bodies are {}", user, name, names);
}

/// A list of numbers as a vector. Errors (InputError): wrong length.
template <int dim>
Vec<dim> as_vector(const std::vector<double>& list, const char* kind, const std::string& name,
                   const char* key) {
  if (list.size() != dim)
    input_error("{} '{}': {} needs {} values, found {}", kind, name, key, dim, list.size());
  return Eigen::Map<const Vec<dim>>(list.data());
}

/// Calls f(function, phi, dphi) at x for a point without extent: the basis' functions with a domain of zero
/// size.
template <int dim, class F>
void for_each_function(const Space<dim>& space, const Vec<dim>& x, const Vec<dim>& half_length, F&& f) {
  std::visit(
      [&](const auto& basis) {
        basis.tabulate(x, half_length).for_each([&](int, int i, double phi, const Vec<dim>& dphi) {
          f(i, phi, dphi);
        });
      },
      space.basis());
}

}  // namespace wisp
