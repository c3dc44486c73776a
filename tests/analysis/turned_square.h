// A unit square turned so that its base runs along (0.8, 0.6), and walls in its own axes.
#pragma once
#include "analysis/fixtures.h"

namespace wisp::analysis_test {

inline constexpr double cosine = 0.8, sine = 0.6;

/// With points cut at its outline.
inline BodyOptions turned_square(const AnyLaw& law) {
  BodyOptions body;
  body.label = "square";
  Polygon outline;
  outline.vertices = {{0.0, 0.0}, {cosine, sine}, {cosine - sine, sine + cosine}, {-sine, cosine}};
  body.shape = outline;
  body.sampling.clip = true;
  body.material = law;
  return body;
}

/// From one corner or point to another, m along and across the base; the solid lies on the left.
inline WallOptions& add_wall(ModelOptions& o, const char* name, Vec<2> from, Vec<2> to, WallKind kind) {
  Mat<2> r;
  r << cosine, -sine, sine, cosine;
  from = r * from, to = r * to;
  WallOptions w;
  w.label = name, w.kind = kind;
  PolylineWall line;
  line.vertices = {{from[0], from[1]}, {to[0], to[1]}};
  w.shape = line;
  return std::get<WallOptions>(o.boundaries.emplace_back(w));
}

/// Rollers on three sides, the right one pressed inwards by `push` (m).
inline void contain(ModelOptions& o, double push) {
  add_wall(o, "left", {0, 1}, {0, 0}, WallKind::roller);
  add_wall(o, "base", {0, 0}, {1, 0}, WallKind::roller);
  add_wall(o, "top", {1, 1}, {0, 1}, WallKind::roller);
  add_wall(o, "press", {1, 0}, {1, 1}, WallKind::roller).displacement = {ramp(push), Curve(0.0)};
}

}  // namespace wisp::analysis_test
