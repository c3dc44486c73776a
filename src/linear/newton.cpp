#include "linear/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace wisp {
namespace {

constexpr int most_halvings = 5;

/// Takes u + du, halving du while the residual grows if a line search is wanted. Returns the residual at the
/// new u.
double advance(const NewtonOptions& options, double last, std::span<double> u, std::span<const double> du,
               const std::function<double(std::span<const double>)>& residual) {
  for (std::size_t i = 0; i < u.size(); ++i) u[i] += du[i];
  double r = residual(u);
  if (!options.line_search) return r;
  double factor = 1.0;
  for (int k = 0; k < most_halvings && !(r < last); ++k) {  // a residual that is not finite is halved as well
    factor *= 0.5;
    for (std::size_t i = 0; i < u.size(); ++i) u[i] -= factor * du[i];
    r = residual(u);
  }
  return r;
}

}  // namespace

NewtonReport newton(const NewtonOptions& options, std::span<double> u,
                    const std::function<double(std::span<const double>)>& residual,
                    const std::function<std::string(std::span<double>)>& correct) {
  NewtonReport report;
  report.margin = std::numeric_limits<double>::infinity();
  std::vector<double> du(u.size(), 0.0);
  double r = residual(u);
  for (;;) {
    ++report.iterations;
    report.residuals.push_back(r);
    if (!std::isfinite(r)) {
      report.cause = "the residual is not finite";
      return report;
    }
    if (r > 0.0) report.margin = std::min(report.margin, std::abs(std::log10(r / options.tolerance)));
    if (r <= options.tolerance) {
      report.converged = true;
      return report;
    }
    if (report.iterations >= options.max_iterations) {
      report.cause = fmt::format("the residual is {:.2e} after {} iterations, above the tolerance {:.0e}", r,
                                 report.iterations, options.tolerance);
      return report;
    }
    report.cause = correct(du);
    if (!report.cause.empty()) return report;
    r = advance(options, r, u, du, residual);
  }
}

}  // namespace wisp
