#pragma once
#include <Eigen/Core>

namespace wisp {

/// Axis-aligned box; also the answer of `bounds`. Half-open, so that boxes side by side never share a point.
template <int dim>
struct Block {
  using Vector = Eigen::Matrix<double, dim, 1>;
  Vector lower;  ///< m
  Vector upper;  ///< m

  bool contains(const Vector& x) const {
    return (x.array() >= lower.array()).all() && (x.array() < upper.array()).all();
  }
};

}  // namespace wisp
