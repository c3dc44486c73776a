// The thesis's benchmarks, one-dimensional motions of a two-dimensional strip: set-up and run, shared by its
// tables and figures.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/explicit.h"

namespace wisp::powell_sabin {

/// A strip along x (a bar between two walls) or along y (a column on its base), on a grid of blocks, each
/// split into four triangles, or on a random Delaunay triangulation of about the same triangles.
struct StripCase {
  bool column = false;
  double length = 25.0, width = 2.0;  ///< m, along and across the motion
  double density = 1.0, young_modulus = 100.0;
  double speed = 0.0;    ///< m/s, bar: v0 of v0 sin(pi x/L)
  double gravity = 0.0;  ///< m/s2, column
  int blocks = 12, blocks_across = 1;
  int points = 8, points_across = 6;  ///< a block
  int empty_blocks = 0;               ///< rows of blocks without points above a column
  std::optional<int> delaunay_seed;   ///< random triangulation instead of blocks
  bool splines = true;                ///< Powell-Sabin or linear
  bool cubic = false;                 ///< with splines
  /// Hencky's law: the thesis's, in rate form, takes dl/l of the old length, and the sum of dl/l misses the
  /// logarithm by dt/2 times the integral of the squared strain rate, a drift of first order in dt.
  bool hencky = false;
  Mass mass = Mass::consistent;
  int fmpm_order = 4;
  double deactivate_below = 0.0;  ///< kg
  std::optional<GhostOptions> ghost;
  Integration integration = Integration::points;
  double dt = 1e-4, duration = 1.0;
  /// Velocities start at -dt/2, which makes the symplectic Euler steps those of the leapfrog: without it the
  /// column is g dt t/2 off at once.
  bool staggered = true;
  int record_every = 10;
  bool with_conditions = false;  ///< condition numbers of the mass, every 50th record
};

/// The thesis's four: tables 4.1, 4.4, 4.5, 4.6.
StripCase small_bar();
StripCase large_bar();
StripCase small_column();
StripCase large_column();

struct StripRun {
  std::vector<double> time;                    ///< s
  std::vector<double> displacement, velocity;  ///< of the point nearest to the middle, along the motion
  std::vector<double> energy;                  ///< J: kinetic, strain, minus work of gravity
  std::vector<double> condition;               ///< where asked for
  double middle = 0.0;                         ///< m, initial coordinate of the middle point
  double kinetic_scale = 0.0;                  ///< J, largest kinetic energy
  std::string failure;                         ///< empty if the run came to its end
  double end = 0.0;                            ///< s, of the last step that was done
  std::vector<Vec<2>> start, moved,
      point_velocity;          ///< of all points at the end: initial position, displacement
  std::vector<double> volume;  ///< m2, initial
  int axis = 0;

  bool stable() const { return failure.empty(); }
  /// Largest difference of the middle point's displacement from a reference over the run, m; infinity if it
  /// failed.
  double largest_error(const std::function<double(double x, double t)>& reference) const;
  /// Root of the mean square of the same.
  double rms_error(const std::function<double(double x, double t)>& reference) const;
  /// The same for its velocity, m/s.
  double rms_velocity_error(const std::function<double(double x, double t)>& reference) const;
  /// E_u at the end (thesis, eq. 4.4), m2.
  double field_error(const std::function<double(double x)>& reference) const;
};

StripRun run_strip(const StripCase& strip);

/// Displacement and velocity of the one-dimensional updated-Lagrangian reference at the middle point and at
/// the times of a run.
struct Reference {
  std::vector<double> time, displacement, velocity;
};
Reference ulfem_reference(const StripCase& strip, double middle, const std::vector<double>& times);

/// The reference's errors, as in StripRun.
double largest_error(const StripRun& run, const Reference& reference);
double rms_error(const StripRun& run, const Reference& reference);
double rms_velocity_error(const StripRun& run, const Reference& reference);

}  // namespace wisp::powell_sabin
