// A wall of a run: what the case says of it, and what it carries from step to step.
#pragma once
#include <filesystem>
#include <string>

#include "boundary/wall_options.h"
#include "geometry/wall_shape.h"
#include "tensor/tensor.h"

namespace wisp {

/// Moment of a reaction: one number in 2D (about z, N), a vector in 3D (N m).
template <int dim>
using Moment = Eigen::Matrix<double, dim == 2 ? 1 : 3, 1>;

template <int dim>
class Wall {
 public:
  /// Checks the wall. `folder` is where relative file names start from. Errors: InputError.
  Wall(const WallOptions& options, const std::filesystem::path& folder)
      : options_(options), shape_(options.shape, folder) {
    if (options.motion) motion_ = RigidMotion<dim>(*options.motion);
  }

  const std::string& name() const { return options_.label; }
  const WallOptions& options() const { return options_; }
  /// At rest; where it is at a time is up to `motion`.
  const WallShape<dim>& shape() const { return shape_; }
  const RigidMotion<dim>& motion() const { return motion_; }

  Vec<dim> reaction = Vec<dim>::Zero();      ///< N, on the body, all ranks, of the last step
  Moment<dim> moment = Moment<dim>::Zero();  ///< about motion().centre(t)

 private:
  WallOptions options_;
  WallShape<dim> shape_;
  RigidMotion<dim> motion_;
};

}  // namespace wisp
