// Bodies on walls in explicit dynamics: a block or a disc of elastic points, walls at any angle and offset.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "analysis/explicit.h"

namespace wisp::explicit_walls {

constexpr double cell = 0.1, density = 1000.0, gravity = 10.0;  ///< m, kg/m3, m/s2

/// Functions of the grid. Triangles are squares cut in two; those of splines, which have three functions a
/// vertex, are twice as large.
enum class Functions { linear, gimp, linear_triangles, powell_sabin };

/// What is varied: functions, scheme, mass, and where in its cell the wall lies.
struct Variant {
  Functions functions = Functions::gimp;
  StressUpdate update = StressUpdate::musl;
  bool consistent = false;  ///< with Ghost
  double offset = 0.0;      ///< of the wall along its normal, cells

  bool gimp() const { return functions == Functions::gimp; }
  /// Of a cell, or of the squares that are cut into triangles, m.
  double side() const { return functions == Functions::powell_sabin ? 2.0 * cell : cell; }
  bool triangles() const { return functions > Functions::gimp; }
  std::string name() const;
};

/// A scene: the options of a model and where its parts lie.
struct Scene {
  ModelOptions options;
  Vec<2> foot, along, up;  ///< a point of the wall under the body, its tangent and normal
};

/// An elastic law of the density above.
LinearElastic soft(double young_modulus);

/// A block of width x height (m) stands on a straight wall inclined by `degrees` (falling to the right), its
/// points in rows along the wall, `rows` a cell; `gap` m above it.
Scene block(const Variant& variant, double degrees, double width, double height, double young_modulus,
            int rows = 2, double gap = 0.0);
/// A disc touches the wall.
Scene disc(const Variant& variant, double degrees, double radius, double young_modulus);

/// The wall of a scene: unilateral, with friction.
WallOptions& wall(Scene& scene, double friction);

ExplicitOptions explicit_options(const Variant& variant, double duration, double dt, double damping = 0.0);

/// Longest step of `share` of the Courant number of the law on a grid of `cell`.
double time_step(double young_modulus, double share);

/// A running scene.
class Run {
 public:
  Run(const Scene& scene, const ExplicitOptions& options);
  Model<2>& model() { return *model_; }
  Explicit<2>& analysis() { return *analysis_; }
  /// Steps for a time; calls `watch` after each.
  void go(double duration, const std::function<void()>& watch = {});
  /// A new stage: other options, the same state.
  void change(const ExplicitOptions& options);

  double mass() const;
  Vec<2> momentum() const;
  Vec<2> centre() const;
  Vec<2> mean_displacement() const;
  double spin() const;  ///< angular velocity, rad/s: angular momentum about the centre over moment of inertia
  double energy() const;  ///< kinetic and elastic, J

 private:
  std::unique_ptr<Model<2>> model_;
  std::unique_ptr<Explicit<2>> analysis_;
  ExplicitOptions options_;
};

}  // namespace wisp::explicit_walls
