// The list of material laws: a new law is one file and one word here.
#pragma once
#include <utility>
#include <variant>
#include <vector>

#include "material/hencky.h"
#include "material/jaumann_elastic.h"
#include "material/linear_elastic.h"
#include "material/von_mises.h"

namespace wisp {

using AnyLaw = std::variant<LinearElastic, Hencky, VonMises, JaumannElastic>;

/// A law with the states of its points: `old` at the start of a step, `now` the trial at its end. Explicit
/// steps update `old` in place and may leave `now` empty.
template <Material M, int dim>
struct MaterialStates {
  M law;
  std::vector<typename M::template State<dim>> old, now;
};

template <int dim, class List>
struct MaterialVariant;
template <int dim, class... Laws>
struct MaterialVariant<dim, std::variant<Laws...>> {
  using type = std::variant<MaterialStates<Laws, dim>...>;
};

/// States of any law of the list: visit once for a whole loop, never once a point.
template <int dim>
using AnyMaterial = typename MaterialVariant<dim, AnyLaw>::type;

/// The group of a law, without points yet.
template <int dim>
inline AnyMaterial<dim> make_material(const AnyLaw& any) {
  return std::visit(
      [](const auto& law) -> AnyMaterial<dim> {
        return MaterialStates<std::decay_t<decltype(law)>, dim>{law, {}, {}};
      },
      any);
}

/// Initial density [kg/m3] of any law.
inline double density(const AnyLaw& any) {
  return std::visit([](const auto& law) { return law.density; }, any);
}

/// lambda + 2 mu [Pa] of any law.
inline double p_wave_modulus(const AnyLaw& any) {
  return std::visit([](const auto& law) { return law.p_wave_modulus(); }, any);
}

}  // namespace wisp
