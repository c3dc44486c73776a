// `wisp bench`: the speed of the engine against yardsticks that are measured in the same run.
#pragma once
#include <array>
#include <ctime>
#include <string>

namespace wisp {

/// The parts that `bench` measures.
inline constexpr std::array bench_parts{"explicit", "splines", "newton", "consistent", "walls"};

/// Measures and prints; `points` is the size of the largest case, `only` one of the parts or empty for all.
/// Needs a Session of one rank. Errors (InputError): more than one rank.
void bench(int points, const std::string& only);

/// What walls cost for a rough footing pushed into a block of about `points` points (Cortis, Coombs and
/// Augarde 2018, section 5.5): shares of an explicit step and of Newton's assembly. Measures and prints.
void bench_walls(int points);

/// Processor time of this thread (s): what others do on the machine disturbs it least.
inline double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace wisp
