// Random motions and states for the contract tests, and every pair of law and dimension of the list.
#pragma once
#include <gtest/gtest.h>

#include <random>
#include <type_traits>
#include <variant>

#include "material/list.h"

namespace wisp::test {

template <class Law, int d>
struct Pair {
  using law_type = Law;
  static constexpr int dim = d;
};
template <class List>
struct PairsOf;
template <class... Laws>
struct PairsOf<std::variant<Laws...>> {
  using type = ::testing::Types<Pair<Laws, 2>..., Pair<Laws, 3>...>;
};
/// Every law of the list in two and three dimensions.
using AllPairs = PairsOf<AnyLaw>::type;

/// Laws in rate form keep objectivity and energy only to first order in the step.
template <class Law>
inline constexpr bool in_small_steps = requires {
  requires Law::rate_form;
};

/// Sets a key of a law if it has one of that name.
template <class Law>
void set(Law& law, std::string_view name, double value) {
  for_each_key<Law>([&](const auto& k) {
    if constexpr (std::is_same_v<typename std::decay_t<decltype(k)>::value_type, double>)
      if (k.name == name) law.*(k.member) = value;
  });
}

/// A law whose parameters matter: stiff against 1 Pa, yields at a strain of some percent, hardens.
template <class Law>
Law sample_law() {
  Law law;
  set(law, "young_modulus", 1000.0);
  set(law, "poisson_ratio", 0.3);
  set(law, "yield_stress", 20.0);
  set(law, "hardening_modulus", 50.0);
  return law;
}

class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }

  template <int dim>
  Mat<dim> matrix(double amplitude) {
    Mat<dim> m;
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) m(i, j) = uniform(-amplitude, amplitude);
    return m;
  }

  template <int dim>
  Kinematics<dim> motion(double amplitude) {
    return {Mat<dim>::Identity() + matrix<dim>(amplitude), 0.01};
  }

  template <int dim>
  Mat<dim> rotation() {
    Mat<dim> r = Mat<dim>::Identity();
    for (int p = 0; p < dim; ++p)
      for (int q = p + 1; q < dim; ++q) {
        const double angle = uniform(-3.0, 3.0);
        Mat<dim> plane = Mat<dim>::Identity();
        plane(p, p) = plane(q, q) = std::cos(angle);
        plane(q, p) = std::sin(angle);
        plane(p, q) = -std::sin(angle);
        r = plane * r;
      }
    return r;
  }

 private:
  std::mt19937 generator_;
};

/// The state after one step.
template <int dim, class Law>
auto after(const Law& law, const Kinematics<dim>& kinematics, const typename Law::template State<dim>& old) {
  typename Law::template State<dim> now;
  law.template stress<dim>(kinematics, old, now);
  return now;
}

}  // namespace wisp::test
