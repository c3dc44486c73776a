// A wall of a run: what the case says of it, and what it carries from step to step.
#pragma once
#include <string>

#include "boundary/wall_options.h"
#include "tensor/tensor.h"

namespace wisp {

/// Moment of a reaction: one number in 2D (about z), a vector in 3D, N m (2D: N).
template <int dim>
using Moment = Eigen::Matrix<double, dim == 2 ? 1 : 3, 1>;

template <int dim>
class Wall {
 public:
  explicit Wall(const WallOptions& options) : options_(options) {}

  const std::string& name() const { return options_.label; }
  const WallOptions& options() const { return options_; }

  Vec<dim> reaction = Vec<dim>::Zero();      ///< N, on the body, all ranks, of the last step
  Moment<dim> moment = Moment<dim>::Zero();  ///< about options().centre

 private:
  WallOptions options_;
};

}  // namespace wisp
