// Walls split at the edges of triangles.
#include <algorithm>
#include <cmath>

#include "boundary/wall_cut.h"

namespace wisp {

namespace {

constexpr double nudge = 1e-6;       // of the shortest height
constexpr double negligible = 1e-9;  // of the shortest height: cuts closer together are one

/// Where a segment a + t side, 0 < t < 1, meets other segments. Ends of those on its line count as well, so
/// that a wall along edges is cut at their vertices.
class Crossings {
 public:
  Crossings(const WallPiece<2>& piece, double rounding)
      : a_(piece.vertex[0]), side_(piece.vertex[1] - a_), length_(side_.norm()), rounding_(rounding) {}

  void add(const Vec<2>& p, const Vec<2>& q) {
    const double dp = distance(p), dq = distance(q);
    const bool on_p = std::abs(dp) <= rounding_, on_q = std::abs(dq) <= rounding_;
    if (on_p) add(p);
    if (on_q) add(q);
    if (!on_p && !on_q && (dp < 0.0) != (dq < 0.0)) add(p + dp / (dp - dq) * (q - p));
  }

  /// Increasing, with 0 at the start and 1 at the end, none closer together than rounding.
  std::vector<double> sorted() {
    const double least = rounding_ / length_;
    std::sort(at_.begin(), at_.end());
    std::vector<double> out{0.0};
    for (const double t : at_)
      if (t - out.back() > least && t < 1.0 - least) out.push_back(t);
    out.push_back(1.0);
    return out;
  }

 private:
  double distance(const Vec<2>& x) const {
    return (side_[0] * (x[1] - a_[1]) - side_[1] * (x[0] - a_[0])) / length_;
  }
  void add(const Vec<2>& x) { at_.push_back(side_.dot(x - a_) / (length_ * length_)); }

  Vec<2> a_, side_;
  double length_, rounding_;
  std::vector<double> at_;
};

}  // namespace

void cut_piece(const Triangulation& mesh, const PowellSabinSplit* split, int points,
               const WallPiece<2>& piece, WallCut<2>& cut) {
  const Vec<2> a = piece.vertex[0], side = piece.vertex[1] - a;
  const double h = mesh.shortest_height();
  const Vec<2> margin = Vec<2>::Constant(nudge * h);
  Crossings crossings(piece, negligible * h);
  mesh.for_each_near(a.cwiseMin(piece.vertex[1]) - margin, a.cwiseMax(piece.vertex[1]) + margin, [&](int t) {
    for (int k = 0; k < 3; ++k) {
      const Vec<2>&v = mesh.corner(t, k), &next = mesh.corner(t, (k + 1) % 3);
      crossings.add(v, next);
      if (!split) continue;
      const Vec<2> centre = split->centre(t);
      crossings.add(v, centre);
      crossings.add(split->edge_point(mesh.edge(t, k)), centre);
    }
  });
  const std::vector<double> at = crossings.sorted();
  int t = -1;
  for (std::size_t k = 0; k + 1 < at.size(); ++k) {
    const Vec<2> from = a + at[k] * side, to = a + at[k + 1] * side;
    const Vec<2> inside = 0.5 * (from + to) + nudge * h * piece.normal;
    t = mesh.locate(inside, t);
    MultiIndex<2> host(t, 0);
    if (t >= 0 && split) {
      const SplitPoint p = split->locate(t, mesh.barycentric(t, inside));
      host[1] = 2 * p.edge + p.side;
    }
    add_part(from, to, piece.normal, host, points, cut);
  }
}

}  // namespace wisp
