// What a case file says about stages.
#pragma once
#include <optional>
#include <variant>

#include "core/describe.h"
#include "stabilise/mass_options.h"

namespace wisp {

enum class StressUpdate { usf, usl, musl, projected };
template <>
inline constexpr auto choices<StressUpdate> = choice_list<StressUpdate>({{"usf", StressUpdate::usf},
                                                                         {"usl", StressUpdate::usl},
                                                                         {"musl", StressUpdate::musl},
                                                                         {"projected",
                                                                          StressUpdate::projected}});

enum class VelocityUpdate { flip, pic, apic };
template <>
inline constexpr auto choices<VelocityUpdate> = choice_list<VelocityUpdate>({{"flip", VelocityUpdate::flip},
                                                                             {"pic", VelocityUpdate::pic},
                                                                             {"apic", VelocityUpdate::apic}});

enum class Integration { points, reconstructed, reconstructed_mass };
template <>
inline constexpr auto choices<Integration> =
    choice_list<Integration>({{"points", Integration::points},
                              {"reconstructed", Integration::reconstructed},
                              {"reconstructed-mass", Integration::reconstructed_mass}});

struct ExplicitOptions {
  double duration = 1.0;
  std::optional<int> steps;
  std::optional<double> dt;
  double cfl = 0.5;
  Mass mass = Mass::lumped;
  int fmpm_order = 4;
  double deactivate_below = 0.0;
  StressUpdate stress_update = StressUpdate::usl;
  bool updated_gradients = false;
  VelocityUpdate velocity_update = VelocityUpdate::flip;
  double pic_fraction = 0.0;
  Integration integration = Integration::points;
  double damping = 0.0;

  static constexpr std::string_view name = "explicit";
  static constexpr std::string_view summary =
      "Explicit dynamics, Euler-Cromer; lumped, consistent or approximately consistent mass";
  static constexpr std::string_view source =
      "Coombs 2023, eq. 4-11; Bardenhagen 2002; Jiang et al. 2015 (APIC); de Koster et al. 2021 (projected, "
      "partial); Nairn and Hammerquist 2021 (FMPM); Wobbes et al. 2019 (reconstructed)";
  static constexpr auto keys() {
    using O = ExplicitOptions;
    return std::tuple{
        key("duration", &O::duration, "s", "length of the stage").positive(),
        key("steps", &O::steps, "-", "number of equal time steps (instead of dt or cfl)").at_least(1),
        key("dt", &O::dt, "s", "time step; the last one is shortened to end at the duration").positive(),
        key("cfl", &O::cfl, "-",
            "without steps and dt: time step over (shortest cell side / (wave speed + point speed))")
            .positive(),
        key("mass", &O::mass, "",
            "lumped; consistent (Ghost-stabilised if [stabilisation] is given); partial: consistent, but "
            "lumped at "
            "functions of a populated and an empty cell; fmpm: series towards the consistent mass"),
        key("fmpm_order", &O::fmpm_order, "-", "only fmpm: terms of the series; 1 is lumping").at_least(1),
        key("deactivate_below", &O::deactivate_below, "kg",
            "not lumped: functions with a smaller diagonal of the mass matrix take no part (0: all do)")
            .at_least(0),
        key("stress_update", &O::stress_update, "",
            "stress first (usf), last (usl), or last after a second map of velocities (musl), which may also "
            "move "
            "the points and then is the only one (projected)"),
        key("updated_gradients", &O::updated_gradients, "",
            "usf: forces take gradients in the coordinates that the stress has moved to; keeps the energy at "
            "first order in the time step, not the angular momentum"),
        key("velocity_update", &O::velocity_update, "", "how points get their velocity from the grid"),
        key("pic_fraction", &O::pic_fraction, "-", "blend: this share of PIC in the FLIP update")
            .at_least(0)
            .at_most(1),
        key("integration", &O::integration, "",
            "internal forces by the points, or in filled cells by Gauss points of the stress reconstructed "
            "there; reconstructed-mass: consistent mass and weight as well, of the reconstructed density"),
        key("damping", &O::damping, "-",
            "local non-viscous damping: share of the out-of-balance force against the velocity")
            .at_least(0)
            .below(1)};
  }
};

struct QuasiStaticOptions {
  double duration = 1.0;
  int steps = 10;
  double tolerance = 1e-6;
  int max_iterations = 10;
  bool line_search = false;
  int cuts = 0;

  static constexpr std::string_view name = "quasi-static";
  static constexpr std::string_view summary = "Implicit quasi-static equilibrium in load steps, full Newton";
  static constexpr std::string_view source = "Coombs 2023, section 2.4; Charlton et al. 2017";
  static constexpr auto keys() {
    using O = QuasiStaticOptions;
    return std::tuple{
        key("duration", &O::duration, "s", "length of the stage (time only drives the curves)").positive(),
        key("steps", &O::steps, "-", "number of equal load steps").at_least(1),
        key("tolerance", &O::tolerance, "-", "out-of-balance force over external actions")
            .positive()
            .below(1),
        key("max_iterations", &O::max_iterations, "-",
            "most Newton iterations in a step; the first evaluation counts")
            .at_least(2),
        key("line_search", &O::line_search, "", "shorten a Newton step that does not reduce the residual"),
        key("cuts", &O::cuts, "-", "how often a step that fails may be halved (0: stop)")
            .at_least(0)
            .at_most(20)};
  }
};

struct ImplicitDynamicOptions {
  double duration = 1.0;
  int steps = 100;
  double numerical_damping = 0.0;
  double tolerance = 1e-8;
  int max_iterations = 20;
  bool line_search = false;
  int cuts = 0;

  static constexpr std::string_view name = "implicit-dynamic";
  static constexpr std::string_view summary = "Implicit dynamics, Newmark, consistent mass, full Newton";
  static constexpr std::string_view source = "Newmark 1959";
  static constexpr auto keys() {
    using O = ImplicitDynamicOptions;
    return std::tuple{
        key("duration", &O::duration, "s", "length of the stage").positive(),
        key("steps", &O::steps, "-", "number of equal time steps").at_least(1),
        key("numerical_damping", &O::numerical_damping, "-",
            "alpha: gamma = 1/2 + alpha, beta = (1 + alpha)^2/4; 0 is the trapezoidal rule")
            .at_least(0)
            .at_most(1),
        key("tolerance", &O::tolerance, "-", "out-of-balance force over external and inertia forces")
            .positive()
            .below(1),
        key("max_iterations", &O::max_iterations, "-", "most Newton iterations in a step").at_least(2),
        key("line_search", &O::line_search, "", "shorten a Newton step that does not reduce the residual"),
        key("cuts", &O::cuts, "-", "how often a step that fails may be halved (0: stop)")
            .at_least(0)
            .at_most(20)};
  }
};

using AnyStage = std::variant<ExplicitOptions, QuasiStaticOptions, ImplicitDynamicOptions>;

/// Point to follow in the history: the point of a body that is nearest to a position at the start.
struct TrackOptions {
  std::string label;
  std::string body;
  std::vector<double> nearest;

  static constexpr std::string_view name = "track";
  static constexpr std::string_view summary =
      "A point whose position, displacement and velocity go into the history";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    return std::tuple{
        key("name", &TrackOptions::label, "", "name used in the history's column titles").required(),
        key("body", &TrackOptions::body, "", "body of the point").required(),
        key("nearest", &TrackOptions::nearest, "m", "position; the nearest point is followed")
            .required()
            .per_direction()};
  }
};

struct OutputOptions {
  std::string folder;
  int frames = 20;
  int history_every = 1;
  bool energies = true;
  bool reactions = true;
  bool condition_numbers = false;
  bool critical_time_step = false;
  int checkpoint_every = 0;
  std::vector<TrackOptions> track;

  static constexpr std::string_view name = "output";
  static constexpr std::string_view summary = "What is written, where and how often";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = OutputOptions;
    return std::tuple{
        key("folder", &O::folder, "", "results folder (default results/<case name>; --out overrides)"),
        key("frames", &O::frames, "-", "number of .vtu files in a stage, besides the first").at_least(0),
        key("history_every", &O::history_every, "-", "steps between rows of history.csv").at_least(1),
        key("energies", &O::energies, "", "kinetic, strain and dissipated energy, work of external forces"),
        key("reactions", &O::reactions, "", "reaction force of every boundary condition"),
        key("condition_numbers", &O::condition_numbers, "",
            "condition number of the mass or stiffness matrix (costly)"),
        key("critical_time_step", &O::critical_time_step, "",
            "longest stable step of the stage's mass and stress update (costly)"),
        key("checkpoint_every", &O::checkpoint_every, "-",
            "steps between checkpoints (0: only at the end of a stage)")
            .at_least(0),
        key("track", &O::track, "", "points to follow in the history")};
  }
};

}  // namespace wisp
