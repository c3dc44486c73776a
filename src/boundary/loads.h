// Forces on chosen points and on surfaces that move with a body.
#pragma once
#include <string>
#include <vector>

#include "basis/space.h"
#include "boundary/options.h"
#include "particle/body.h"
#include "transfer/active.h"

namespace wisp {

/// A force shared equally by the points nearest to given positions.
template <int dim>
class PointLoad {
 public:
  /// Chooses the points; `bodies` are this rank's. Collective. Errors (InputError): no such body, wrong
  /// lengths, one point chosen twice.
  PointLoad(const PointLoadOptions& options, const std::vector<Body<dim>>& bodies);

  const std::string& name() const { return options_.label; }
  const std::vector<std::int64_t>& ids() const { return ids_; }
  /// Adds phi_i P(t)/n to `force` (n_functions x dim).
  void add_force(const Space<dim>& space, const std::vector<Body<dim>>& bodies, double t,
                 std::span<double> force) const;

 private:
  PointLoadOptions options_;
  std::size_t body_ = 0;
  Vec<dim> share_;
  std::vector<std::int64_t> ids_;
};

/// Surface points that move with a body and carry a traction (dead load on the initial area) or a pressure
/// (on the current area, against the current normal: n da = J F^-T N dA, Nanson). Each rank keeps all surface
/// points of a traction and adds the forces of those in its own cells, so every basis can carry them; their
/// motion is summed over ranks.
template <int dim>
class Traction {
 public:
  Traction(const TractionOptions& options, const std::vector<Body<dim>>& bodies, const Space<dim>& space);

  const std::string& name() const { return options_.label; }
  int size() const { return static_cast<int>(position_.size()); }
  /// Before a step: surface points beyond the body's active cells, or on the line where these end, act
  /// through the nearest one (its polynomial, continued), or part of the load would go to functions without
  /// mass.
  void settle(const Space<dim>& space, const ActiveCells& active);
  void add_force(const Space<dim>& space, double t, std::span<double> force) const;
  /// Moves the surface points with a field of displacements (n_functions x dim, times `factor`),
  /// start-of-step functions.
  void move(const Space<dim>& space, std::span<const double> field, int stride, double factor);

  std::vector<Vec<dim>>& positions() { return position_; }
  std::vector<Mat<dim>>& deformation_gradients() { return deformation_gradient_; }

 private:
  bool mine(const Space<dim>& space, const Vec<dim>& x) const;

  TractionOptions options_;
  std::size_t body_ = 0;
  Vec<dim> traction_ = Vec<dim>::Zero();
  std::vector<Vec<dim>> position_;
  std::vector<Vec<dim>> host_;  // where the functions of each surface point are evaluated, see `settle`
  std::vector<Mat<dim>> deformation_gradient_;
  Vec<dim> area_ = Vec<dim>::Zero();  // initial area times outward normal of one surface point
};

/// The point of a body nearest to a position, over all ranks; its id. Ties go to the lowest id. Collective.
template <int dim>
std::int64_t nearest_point(const Body<dim>& body, const Vec<dim>& position);

/// Index of the body with a name. Errors (InputError).
template <int dim>
std::size_t body_index(const std::vector<Body<dim>>& bodies, const std::string& name,
                       const std::string& user);

}  // namespace wisp
