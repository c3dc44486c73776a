// Ranks as threads that take turns: only one runs at a time, and they change over where they wait for each
// other. So collective writers are tested in one process, without MPI and with libraries that know no
// threads.
#pragma once
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "io/atomic_file.h"

namespace wisp::test {

inline void run_as_ranks(int ranks, const std::function<void(const OutputRanks&)>& work) {
  std::mutex turn;
  std::condition_variable changed;
  int waiting = 0;
  long round = 0;
  bool verdict = true, last_verdict = true;
  std::vector<std::thread> threads;
  for (int r = 0; r < ranks; ++r)
    threads.emplace_back([&, r] {
      std::unique_lock lock(turn);
      const auto all = [&](bool mine) {
        verdict = verdict && mine;
        const long my_round = round;
        if (++waiting == ranks) {
          waiting = 0;
          last_verdict = verdict;
          verdict = true;
          ++round;
          changed.notify_all();
        } else {
          changed.wait(lock, [&] { return round != my_round; });
        }
        return last_verdict;
      };
      work({r, ranks, all});
    });
  for (std::thread& thread : threads) thread.join();
}

}  // namespace wisp::test
