// Traction or pressure on a surface that moves with a body.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "basis/space.h"
#include "core/curve.h"
#include "core/describe.h"
#include "particle/body.h"
#include "transfer/active.h"

namespace wisp {

template <int dim>
class Traction;

/// Marked surface points that move with a body and carry a traction or a pressure.
struct TractionOptions {
  std::string label;
  std::string body;
  std::vector<double> corner;
  std::vector<std::vector<double>> edges;
  std::vector<int> points;
  std::vector<double> traction;
  std::optional<Curve> pressure;
  Curve factor{1.0};

  template <int dim>
  using Load = Traction<dim>;

  static constexpr std::string_view name = "traction";
  static constexpr std::string_view summary =
      "Traction (dead) or pressure (following) on surface points that move with a body";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = TractionOptions;
    return std::tuple{
        key("name", &O::label, "", "name of the traction").required(),
        key("body", &O::body, "", "body whose motion the surface follows").required(),
        key("corner", &O::corner, "m", "start of the segment (2D) or corner of the parallelogram (3D)")
            .required()
            .per_direction(),
        key("edges", &O::edges, "m",
            "one edge vector in 2D, two in 3D; the outward normal is the edge turned by -90 degrees (2D) or "
            "e1 x e2 (3D)")
            .required(),
        key("points", &O::points, "-", "number of surface points along each edge").at_least(1).required(),
        key("traction", &O::traction, "Pa", "force per initial area").per_direction(),
        key("pressure", &O::pressure, "Pa",
            "pressure against the outward normal on the current area, in time"),
        key("factor", &O::factor, "-", "factor on the traction in time")};
  }
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
  void add_force(const Space<dim>& space, const std::vector<Body<dim>>& bodies, double t,
                 std::span<double> force) const;
  /// Moves the surface points with a field of displacements (n_functions x dim, times `factor`),
  /// start-of-step functions.
  void move(const Space<dim>& space, std::span<const double> field, int stride, double factor);

  /// Positions of the surface points (m).
  const std::vector<Vec<dim>>& positions() const { return position_; }
  /// Calls f(name, array) for what moves with the body: checkpoints keep it.
  template <class F>
  void for_each_field(F&& f) {
    f(std::string_view("position"), position_);
    f(std::string_view("deformation_gradient"), deformation_gradient_);
  }

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

}  // namespace wisp
