// What a run tells a person at its end.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/timers.h"

namespace wisp {

/// Time of one stage on this rank.
struct StageTimes {
  std::string title;  ///< "stage 1, explicit"
  Timers timers;
  double point_steps = 0.0;  ///< points of this rank, summed over the steps
};

/// Bandwidth of this core's memory (bytes/s) by a short triad a = b + s c (McCalpin 1995), with the traffic
/// of writing counted as the program sees it: three numbers an entry.
double triad_bandwidth();

/// The summary: where the results are, what they can be opened with, times of the steps.
std::string summary(const std::filesystem::path& folder, const std::vector<StageTimes>& stages,
                    double bandwidth);

}  // namespace wisp
