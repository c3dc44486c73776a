// `wisp bench`: the speed of the engine against yardsticks that are measured in the same run.
#pragma once
#include <ctime>

namespace wisp {

/// Measures and prints; `points` is the size of the largest case. Needs a Session of one rank. Errors
/// (InputError): more than one rank.
void bench(int points);

/// Processor time of this thread (s): what others do on the machine disturbs it least.
inline double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace wisp
