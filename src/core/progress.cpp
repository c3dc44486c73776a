#include "core/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace wisp {

std::string duration_text(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0.0) return "?";
  if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<long>(std::lround(seconds));
  const long hours = whole / 3600, minutes = whole / 60 % 60, rest = whole % 60;
  if (hours > 0) return fmt::format("{}:{:02}:{:02}", hours, minutes, rest);
  return fmt::format("{}:{:02}", minutes, rest);
}

namespace {

/// Columns of the terminal behind a file, 0 if there is none. mpirun gives its ranks a pseudo terminal
/// whatever its own output is, so there only the word of the process that started them counts: the width in
/// WISP_TERMINAL.
int terminal_width(std::FILE* out) {
  if (std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr) {
    const char* told = out == stdout ? std::getenv("WISP_TERMINAL") : nullptr;
    return told ? std::max(0, std::atoi(told)) : 0;
  }
  if (isatty(fileno(out)) == 0) return 0;
  winsize size{};
  return ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col : 80;
}

}  // namespace

Progress::Progress(std::string_view label, Style style, std::FILE* out)
    : label_(label), style_(style), out_(out) {
  if (style_ == Style::automatic) style_ = terminal_width(out_) > 0 ? Style::bar : Style::lines;
}

bool Progress::wants_update(double done) const {
  if (style_ == Style::quiet) return false;
  if (first_done_ < 0.0 || done >= 1.0) return true;
  if (style_ == Style::bar) return Clock::now() - last_draw_ >= std::chrono::milliseconds(100);
  return done >= next_line_;
}

void Progress::update(double done, std::string_view remark) {
  if (style_ == Style::quiet) return;
  done = std::clamp(done, 0.0, 1.0);
  if (first_done_ < 0.0) {
    first_done_ = done;
    next_line_ = (std::floor(done * 10.0 + 1e-9) + 1.0) / 10.0;
  }
  if (style_ == Style::bar) {
    if (done >= 1.0 || Clock::now() - last_draw_ >= std::chrono::milliseconds(100)) draw(done, remark);
    return;
  }
  if (done + 1e-12 < next_line_) return;
  next_line_ = (std::floor(done * 10.0 + 1e-9) + 1.0) / 10.0;
  fmt::print(out_, "{} {:3.0f} %  {}{}{}\n", label_, 100.0 * done, duration_text(seconds()),
             remark.empty() ? "" : "  ", remark);
  std::fflush(out_);
}

void Progress::draw(double done, std::string_view remark) {
  constexpr int cells = 24;
  last_draw_ = Clock::now();
  const int full = static_cast<int>(std::lround(done * cells));
  std::string bar;
  for (int i = 0; i < cells; ++i) bar += i < full ? "#" : ".";
  const double fresh = done - std::max(0.0, first_done_);
  const std::string left = done >= 1.0     ? duration_text(seconds())
                           : fresh > 1e-12 ? duration_text(seconds() * (1.0 - done) / fresh) + " left"
                                           : std::string("...");
  std::string text = fmt::format("{} [{}] {:3.0f} %  {}", label_, bar, 100.0 * done, left);
  if (!remark.empty()) text += fmt::format("  {}", remark);
  const int columns = terminal_width(out_);
  const auto width = static_cast<std::size_t>(columns > 0 ? columns : 120);
  if (text.size() >= width) text.resize(width - 1);  // a wrapped line could not be redrawn
  fmt::print(out_, "\r\x1b[2K{}", text);
  std::fflush(out_);
  bar_open_ = true;
}

void Progress::erase() {
  if (bar_open_) fmt::print(out_, "\r\x1b[2K");
}

void Progress::line(std::string_view text) {
  if (style_ == Style::quiet) return;
  erase();
  fmt::print(out_, "{}\n", text);
  std::fflush(out_);
  bar_open_ = false;
}

void Progress::finish() {
  if (bar_open_) fmt::print(out_, "\n");
  std::fflush(out_);
  bar_open_ = false;
}

}  // namespace wisp
