// What walls carry from step to step.
#pragma once
#include "tensor/tensor.h"

namespace wisp {

/// What a Gauss point of a wall has gathered, in the frame of the wall at rest.
template <int dim>
struct WallState {
  Vec<dim> rest = Vec<dim>::Zero();      ///< m
  Vec<dim> traction = Vec<dim>::Zero();  ///< Pa, of the body on the wall
  Vec<dim> gap = Vec<dim>::Zero();       ///< m, displacement of the body less that of the wall
};

}  // namespace wisp
