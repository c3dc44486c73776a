#pragma once
#include "geometry/faceted_surface.h"
#include "geometry/outline.h"
#include "geometry/wall_options.h"

namespace wisp {

/// The segments of a polyline with the solid side on their left. Throws InputError for fewer than two
/// vertices, numbers that are not finite, repeated neighbours, crossings (also with itself at an end, unless
/// the last vertex is the first), and an open line whose solid side is inside or outside.
FacetedSurface<2> polyline_surface(const PolylineWall& line);

/// The edges of a polygon with the inside on their left, or the outside.
FacetedSurface<2> rings_surface(const Outline& outline, bool inside);

}  // namespace wisp
