// Named, numbered timers of the steps of an analysis.
#pragma once
#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wisp {

/// Accumulates seconds and counts for named parts of a step. Parts are reported in the order of their first
/// use, so that names such as "2 mass, momentum, forces to grid" read like the paper's list.
class Timers {
 public:
  /// Stops its timer when it goes out of scope.
  class Running {
   public:
    Running(Timers& timers, int part) : timers_(timers), part_(part), start_(Clock::now()) {}
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    ~Running() { timers_.add(part_, std::chrono::duration<double>(Clock::now() - start_).count()); }

   private:
    using Clock = std::chrono::steady_clock;
    Timers& timers_;
    int part_;
    Clock::time_point start_;
  };

  struct Part {
    std::string name;
    double seconds = 0.0;
    std::int64_t count = 0;
  };

  /// Index of the part with this name, made if new. Fetch it once, outside of loops.
  int part(std::string_view name) {
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (parts_[i].name == name) return static_cast<int>(i);
    parts_.push_back({std::string(name), 0.0, 0});
    return static_cast<int>(parts_.size()) - 1;
  }

  [[nodiscard]] Running start(int part) { return {*this, part}; }
  [[nodiscard]] Running start(std::string_view name) { return {*this, part(name)}; }

  void add(int part, double seconds, std::int64_t count = 1) {
    auto& p = parts_[static_cast<std::size_t>(part)];
    p.seconds += seconds;
    p.count += count;
  }

  const std::vector<Part>& parts() const { return parts_; }

  double total() const {
    double sum = 0.0;
    for (const auto& p : parts_) sum += p.seconds;
    return sum;
  }

  /// Table with seconds, share of the total and, if `point_steps` (points times steps) is not zero, ns per
  /// point and step.
  std::string report(double point_steps = 0.0) const {
    std::size_t width = 5;
    for (const auto& p : parts_) width = std::max(width, p.name.size());
    const double sum = total();
    std::string text = fmt::format("  {:<{}}  {:>10}  {:>6}  {:>9}{}\n", "step", width, "seconds", "share",
                                   "count", point_steps > 0 ? "  ns/point/step" : "");
    const auto line = [&](std::string_view name, double seconds, std::int64_t count) {
      text += fmt::format("  {:<{}}  {:>10.3f}  {:>5.1f}%  {:>9}", name, width, seconds,
                          sum > 0 ? 100.0 * seconds / sum : 0.0, count > 0 ? std::to_string(count) : "");
      text += point_steps > 0 ? fmt::format("  {:>13.2f}\n", 1e9 * seconds / point_steps) : std::string("\n");
    };
    for (const auto& p : parts_) line(p.name, p.seconds, p.count);
    line("total", sum, 0);
    return text;
  }

 private:
  std::vector<Part> parts_;
};

}  // namespace wisp
