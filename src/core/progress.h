// The progress of a run: a bar with the time left on a terminal, plain lines otherwise.
#pragma once
#include <chrono>
#include <cstdio>
#include <string>
#include <string_view>

namespace wisp {

/// "1:02:03", "2:03" or "3.4 s".
std::string duration_text(double seconds);

/// Reports the share of a run that is done. On a terminal one line is redrawn at most ten times a second;
/// into a file a line is written about every tenth of the run. Ranks other than the first make it with
/// `quiet`.
class Progress {
 public:
  enum class Style { automatic, bar, lines, quiet };

  explicit Progress(std::string_view label, Style style = Style::automatic, std::FILE* out = stdout);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() { finish(); }

  /// `done` in [0, 1]; `remark` is shown behind it (energies, residuals).
  void update(double done, std::string_view remark = {});

  /// True when `update` would print now: build an expensive remark only then.
  bool wants_update(double done) const;

  /// A line of its own that does not tear the bar.
  void line(std::string_view text);

  /// Ends the bar's line, once.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  void draw(double done, std::string_view remark);
  void erase();

  std::string label_;
  Style style_;
  std::FILE* out_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_draw_{};
  double next_line_ = 0.1;
  double first_done_ = -1.0;  ///< share done at the first update (a resumed run does not start at zero)
  bool bar_open_ = false;
};

}  // namespace wisp
