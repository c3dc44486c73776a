// Every shape that a case file can name. A new one is one file and one word here (and in region.h if it has
// an inside).
#pragma once
#include <variant>

#include "geometry/ball.h"
#include "geometry/box.h"
#include "geometry/mesh_shape.h"
#include "geometry/point_file.h"
#include "geometry/polygon.h"
#include "geometry/solid.h"

namespace wisp {

/// Shapes of which a body can be made.
using AnyShape = std::variant<Box, Ball, Polygon, PointFile, MeshShape, StlSolid>;

/// Shapes with an inside, for choosing points or nodes.
using AnyRegion = std::variant<Box, Ball, Polygon>;

}  // namespace wisp
