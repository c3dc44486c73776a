// A force on chosen points.
#pragma once
#include <string>
#include <vector>

#include "basis/space.h"
#include "core/curve.h"
#include "core/describe.h"
#include "particle/body.h"

namespace wisp {

template <int dim>
class PointLoad;

/// A force on chosen points, shared equally among them.
struct PointLoadOptions {
  std::string label;
  std::string body;
  std::vector<std::vector<double>> nearest;
  std::vector<double> force;
  Curve factor{1.0};

  template <int dim>
  using Load = PointLoad<dim>;

  static constexpr std::string_view name = "point-load";
  static constexpr std::string_view summary =
      "A force on the points nearest to given positions, shared equally";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = PointLoadOptions;
    return std::tuple{
        key("name", &O::label, "", "name of the load").required(),
        key("body", &O::body, "", "body whose points carry it").required(),
        key("nearest", &O::nearest, "m", "for each loaded point a position; the nearest point is taken")
            .required(),
        key("force", &O::force, "N", "total force (per metre of thickness in 2D)").required().per_direction(),
        key("factor", &O::factor, "-", "factor on the force in time")};
  }
};

/// A force shared equally by the points nearest to given positions.
template <int dim>
class PointLoad {
 public:
  /// Chooses the points; `bodies` are this rank's. Collective. Errors (InputError): no such body, wrong
  /// lengths, one point chosen twice.
  PointLoad(const PointLoadOptions& options, const std::vector<Body<dim>>& bodies, const Space<dim>& space);

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

/// The point of a body nearest to a position, over all ranks; its id. Ties go to the lowest id. Collective.
template <int dim>
std::int64_t nearest_point(const Body<dim>& body, const Vec<dim>& position);

}  // namespace wisp
