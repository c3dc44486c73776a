// What a run shows: the points as a picture, the scene around them, the columns of its history.
#pragma once
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "analysis/model.h"
#include "analysis/record.h"
#include "io/case.h"
#include "io/vtu.h"

namespace wisp {

/// The points of this rank with their fields: id, body (its number in the case), displacement, velocity,
/// stress (Cauchy), mass, volume (now), half_lengths and initial_half_lengths (bases with domains),
/// deformation_gradient, plastic_strain. Per metre of thickness in 2D.
template <int dim>
VtuPoints picture(const Model<dim>& model);

/// The text of scene.json: title and grid lines or triangles (see python/wisp/scene.py).
std::string scene_json(const Case& c);

/// A triangulation with the areas of its triangles and a flag for the vertices of each named boundary.
VtuCells grid_cells(const Triangulation& mesh);

/// What a row of the history is made of, beside the step and time.
template <int dim>
struct Row {
  int stage = 1;    ///< counted from 1
  double dt = 0.0;  ///< s
  EnergyRecord energy;
  double first_energy = 0.0;             ///< J, total of the first row, which the balance starts from
  std::vector<Vec<dim>> reactions;       ///< N
  std::vector<Vec<dim>> tracked;         ///< position, displacement, velocity of each tracked point
  std::optional<ImplicitRecord> newton;  ///< implicit steps
  double condition = std::numeric_limits<double>::quiet_NaN();           ///< of the mass or stiffness
  double critical_time_step = std::numeric_limits<double>::quiet_NaN();  ///< s
};

/// The columns of history.csv and the numbers below them.
template <int dim>
class HistoryColumns {
 public:
  HistoryColumns(const Case& c, const Model<dim>& model);
  /// Titles, behind step and time.
  const std::vector<std::string>& titles() const { return titles_; }
  std::vector<double> values(const Row<dim>& row, const Model<dim>& model) const;

 private:
  OutputOptions output_;
  bool newton_ = false, removal_ = false;
  std::vector<std::vector<int>> held_;  ///< directions that each boundary holds
  std::vector<std::size_t> walls_;      ///< boundaries with a moment
  std::vector<std::string> titles_;
};

/// Points that are followed through the run.
template <int dim>
class Tracked {
 public:
  /// Chooses the points among those at the start. Collective. Errors (InputError): no such body.
  Tracked(const std::vector<TrackOptions>& options, const Model<dim>& model);
  /// Position, displacement and velocity of each; NaN for a point that was removed. Collective.
  std::vector<Vec<dim>> now(const Model<dim>& model);

 private:
  struct Point {
    std::size_t body;
    std::int64_t id;
    std::size_t place = 0;  ///< where it was last: points keep their places for many steps
  };
  std::vector<Point> points_;
};

}  // namespace wisp
