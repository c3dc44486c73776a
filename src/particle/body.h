// A body: points of one material.
#pragma once
#include <string>

#include "material/list.h"
#include "particle/particles.h"

namespace wisp {

/// The points of one body on this rank and the states of its material, in the same order.
template <int dim>
struct Body {
  std::string name;
  Particles<dim> points;
  AnyMaterial<dim> material;

  double density() const {
    return std::visit([](const auto& m) { return m.law.density; }, material);
  }
  double p_wave_modulus() const {
    return std::visit([](const auto& m) { return m.law.p_wave_modulus(); }, material);
  }
  bool finite_strain() const {
    return std::visit([](const auto& m) { return std::decay_t<decltype(m.law)>::finite_strain; }, material);
  }

  /// Calls f(name, array) for every array with one entry per point that is kept when points move (see
  /// Particles); the states of the material are among them as "material_state".
  template <class F>
  void for_each_field(F&& f) {
    points.for_each_field(f);
    std::visit([&](auto& m) { f(std::string_view("material_state"), m.old); }, material);
  }
};

/// Kirchhoff stress of every point as of the last finished step: calls f(p, stress, state's law, state).
template <int dim, class F>
void for_each_state(const Body<dim>& body, F&& f) {
  std::visit(
      [&](const auto& m) {
        for (int p = 0; p < static_cast<int>(m.old.size()); ++p)
          f(p, m.law, m.old[static_cast<std::size_t>(p)]);
      },
      body.material);
}

}  // namespace wisp
