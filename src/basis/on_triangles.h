// A basis of a triangulation in the form that loops over points take.
#pragma once
#include <memory>

#include "grid/triangulation.h"

namespace wisp {

/// Cheap to copy, as kernels do. Points come in the order of triangles, so the triangle of the point before
/// is a good hint. Each copy keeps its own, so one must not be shared between threads.
template <class Basis_>
class OnTriangles {
 public:
  using Basis = Basis_;
  static constexpr int dimension = 2;
  static constexpr int width = 0;  ///< no tensor product
  static constexpr int degree = Basis::degree;
  static constexpr int continuity = Basis::continuity;
  static constexpr bool non_negative = Basis::non_negative;
  static constexpr bool uses_domains = false;
  using Stencil = typename Basis::Stencil;

  explicit OnTriangles(std::shared_ptr<const Basis> basis) : basis_(std::move(basis)) {}

  const Basis& basis() const { return *basis_; }
  /// Stencil at x, which must lie in the grid. Values without unit, gradients in 1/m.
  inline __attribute__((always_inline)) Stencil tabulate(const Vec<2>& x,
                                                         const Vec<2>& /*half_length*/) const {
    const Basis& b = *basis_;
    last_ = b.triangulation().locate(x, last_);
    return b.tabulate_in(last_, x);
  }

 private:
  std::shared_ptr<const Basis> basis_;
  mutable int last_ = -1;
};

template <class Basis>
inline constexpr bool is_on_triangles = false;
template <class Basis>
inline constexpr bool is_on_triangles<OnTriangles<Basis>> = true;

}  // namespace wisp
