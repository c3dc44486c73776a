// Newton's method as a function of two callbacks.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/describe.h"

namespace wisp {

/// When an iteration ends.
struct NewtonOptions {
  static constexpr std::string_view name = "newton";
  static constexpr std::string_view summary = "how equilibrium is found within a step";
  static constexpr std::string_view source = "";

  double tolerance = 1e-6;
  int max_iterations = 10;
  bool line_search = false;

  static constexpr auto keys() {
    return std::tuple{
        key("tolerance", &NewtonOptions::tolerance, "-",
            "out-of-balance force relative to the external forces and reactions, at which a step has "
            "converged")
            .positive()
            .below(1.0),
        key("max_iterations", &NewtonOptions::max_iterations, "-",
            "most evaluations of the residual in a step; the first, before any correction, counts")
            .at_least(1),
        key("line_search", &NewtonOptions::line_search, "",
            "halve a correction that makes the residual larger, up to five times")};
  }
};

/// What an iteration did.
struct NewtonReport {
  bool converged = false;
  int iterations = 0;             ///< evaluations of the residual, the first included: at least 2 under load
  std::vector<double> residuals;  ///< relative residual of each iteration
  /// Least |log10(residual / tolerance)| over the iterations: how far rounding is from changing their number.
  double margin = 0.0;
  std::string cause;  ///< why it did not converge
};

/// Solves r(u) = 0 from the given u (an increment starts from zero).
///
/// `residual(u)` evaluates the out-of-balance forces at u, keeps them, and returns their norm relative to the
/// external forces and reactions. `correct(du)` solves K du = r with the tangent and residual of the last
/// evaluation and returns an empty string, or why it cannot. An iteration is an evaluation; it converges when
/// the value is at most the tolerance, so linear problems take 2. Values that are not finite end it. On
/// several ranks the returned values must be equal.
NewtonReport newton(const NewtonOptions& options, std::span<double> u,
                    const std::function<double(std::span<const double> u)>& residual,
                    const std::function<std::string(std::span<double> du)>& correct);

}  // namespace wisp
