#include "basis/trace.h"

namespace wisp {

namespace {

template <class Basis>
constexpr bool has_split = requires(const Basis& basis) {
  basis.split();
};

/// Coordinates of x in a sub-triangle (near corner, R, Z), negative beyond it.
template <class Basis>
SplitPoint place_in(const Basis& basis, int t, int sub, const Vec<2>& x) {
  const Triangulation& mesh = basis.triangulation();
  SplitPoint p;
  p.edge = sub / 2, p.side = sub % 2;
  const int next = PowellSabinSplit::next(p.edge);
  const double share = basis.split().share(t, p.edge);
  const Vec<2> r = share * mesh.corner(t, p.edge) + (1.0 - share) * mesh.corner(t, next);
  const Vec<2> near = mesh.corner(t, p.side == 0 ? p.edge : next), z = basis.split().centre(t);
  Mat<2> sides;
  sides.col(0) = r - near, sides.col(1) = z - near;
  const Vec<2> s = sides.inverse() * (x - near);
  p.share = {1.0 - s[0] - s[1], s[0], s[1]};
  return p;
}

}  // namespace

int sub_triangle(const Space<2>& space, int t, const Vec<2>& x) {
  return visit_on_triangles(space, [&](const auto& basis) {
    if constexpr (has_split<std::decay_t<decltype(basis)>>) {
      const SplitPoint p = basis.split().locate(t, space.triangulation().barycentric(t, x));
      return 2 * p.edge + p.side;
    }
    return 0;
  });
}

CellFunctions<2> triangle_functions(const Space<2>& space, int t, int sub, const Vec<2>& x) {
  CellFunctions<2> out;
  visit_on_triangles(space, [&](const auto& basis) {
    using Basis = std::decay_t<decltype(basis)>;
    static_assert(Basis::max_functions <= CellFunctions<2>::max_functions);
    out.n = Basis::max_functions;
    const auto take = [&](const auto& stencil) {
      stencil.for_each([&](int k, int i, double phi, const Vec<2>& dphi) {
        const auto at = static_cast<std::size_t>(k);
        out.function[at] = i, out.phi[at] = phi, out.dphi[at] = dphi;
      });
    };
    if constexpr (has_split<Basis>) {
      take(basis.tabulate_at(t, place_in(basis, t, sub, x)));
    } else {
      take(basis.tabulate_in(t, x));
      if constexpr (Basis::degree == 1) {  // whose table never goes below zero
        const auto b = space.triangulation().barycentric(t, x);
        std::copy(b.begin(), b.end(), out.phi.begin());
      }
    }
  });
  return out;
}

}  // namespace wisp
