#include "io/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "parallel/session.h"

namespace wisp {

namespace {
/// Processor time of this thread (s): waiting for a core is not the memory's fault.
double processor_time() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}
}  // namespace

double triad_bandwidth() {
  constexpr std::size_t n = std::size_t{1} << 22;  // 96 MB in three arrays: beyond most caches
  std::vector<double> a(n, 0.0), b(n, 1.0), c(n, 2.0);
  double best = 0.0;
  for (int repeat = 0; repeat < 4; ++repeat) {
    const double start = processor_time();
    const double s = 1.0 + repeat;
    for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + s * c[i];
    const double seconds = processor_time() - start;
    b[static_cast<std::size_t>(repeat)] = a[n / 2];  // the result is used, so the loop stays
    best = std::max(best, 3.0 * sizeof(double) * static_cast<double>(n) / seconds);
  }
  return best;
}

std::string summary(const std::filesystem::path& folder, const std::vector<StageTimes>& stages,
                    double bandwidth) {
  std::string text;
  const std::string ranks = Session::size() > 1 ? fmt::format(" (rank 0 of {})", Session::size()) : "";
  for (const auto& stage : stages)
    text += fmt::format("{}{}\n{}", stage.title, ranks, stage.timers.report(stage.point_steps));
  text += fmt::format("  memory bandwidth (triad, one core): {:.1f} GB/s, so 100 bytes take {:.1f} ns\n",
                      bandwidth * 1e-9, 100.0 / bandwidth * 1e9);
  const std::string name = folder.string();
  text += fmt::format("Results in {}\n", name);
  text += fmt::format("  picture   wisp picture {}\n", name);
  text += fmt::format("  ParaView  {}\n", (folder / "points.pvd").string());
  text += fmt::format("  history   {}", (folder / "history.csv").string());
  return text;
}

}  // namespace wisp
