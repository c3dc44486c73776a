#include "verification/published.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <charconv>

#include "app/launch.h"
#include "core/error.h"
#include "geometry/csv.h"
#include "io/atomic_file.h"
#include "parallel/session.h"

extern char** environ;

namespace wisp {

namespace {

/// "4.72e1 (dagger)" is 47.2; "9.08e?" is no number.
std::optional<double> leading_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || (end != text.data() + text.size() && *end != ' ')) return std::nullopt;
  return value;
}

/// A figure without a picture is still a figure: data come first, so trouble here is told and no more.
void draw(const std::filesystem::path& csv, const std::string& title, const char* kind) {
  std::vector<std::string> words{WISP_PYTHON, verification_file("draw.py").string(), csv.string(), "--title",
                                 title};
  if (kind) words.emplace_back(kind);
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  int status = 1;
  if (posix_spawnp(&child, argv[0], nullptr, nullptr, argv.data(), environ) != 0 ||
      waitpid(child, &status, 0) < 0 || status != 0)
    fmt::print(stderr, "note: no picture of {}; Python with NumPy and Matplotlib draws it\n", csv.string());
}

void write_figure(const std::filesystem::path& folder, const std::string& name, const std::string& title,
                  const std::vector<FigureColumn>& columns, const char* kind) {
  if (Session::rank() != 0) return;
  std::string text;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const std::string& words = columns[c].title;
    // A comma in a title would shift the names of all later columns, so such a title is quoted.
    text += (c ? "," : "") + (words.find(',') == std::string::npos ? words : '"' + words + '"');
  }
  text += "\n";
  for (std::size_t i = 0; i < columns[0].values.size(); ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c)
      text += fmt::format("{}{}", c ? "," : "", columns[c].values.at(i));
    text += "\n";
  }
  const auto csv = folder / (name + ".csv");
  write_atomically(csv, text);
  draw(csv, title, kind);
}

}  // namespace

std::filesystem::path verification_file(const std::string& name) {
  for (const auto& folder : {executable().parent_path() / "../share/wisp/verification",
                             std::filesystem::path(WISP_VERIFICATION_FOLDER)})
    if (std::filesystem::exists(folder / name)) return (folder / name).lexically_normal();
  run_error("the file {} of the verification is not installed beside {}", name, executable().string());
}

Published::Published(const std::string& name) : name_(name) {
  CsvFile file(verification_file("published/" + name + ".csv"));
  CsvLine line;
  while (file.next(line)) {
    std::vector<std::string> cells;
    for (const auto& cell : line.cells) cells.emplace_back(cell.text);
    if (cells.empty()) continue;
    if (titles_.empty())
      titles_ = std::move(cells);
    else
      rows_.push_back(std::move(cells));
  }
}

std::optional<double> Published::at(const std::vector<std::string>& row, std::string_view column) const {
  const auto title = std::find(titles_.begin(), titles_.end(), column);
  if (title == titles_.end()) run_error("{}: there is no column '{}'", name_, column);
  const auto c = static_cast<std::size_t>(title - titles_.begin());
  for (const auto& cells : rows_)
    if (cells.size() > c && cells.size() >= row.size() && std::equal(row.begin(), row.end(), cells.begin()))
      return leading_number(cells[c]);
  run_error("{}: there is no row '{}'", name_, fmt::join(row, ", "));
}

void write_curves(const std::filesystem::path& folder, const std::string& name, const std::string& title,
                  const std::vector<FigureColumn>& columns) {
  write_figure(folder, name, title, columns, nullptr);
}

void write_points(const std::filesystem::path& folder, const std::string& name, const std::string& title,
                  const std::vector<FigureColumn>& columns) {
  write_figure(folder, name, title, columns, "--points");
}

void write_segments(const std::filesystem::path& folder, const std::string& name, const std::string& title,
                    const std::vector<FigureColumn>& columns) {
  write_figure(folder, name, title, columns, "--segments");
}

void write_surface(const std::filesystem::path& folder, const std::string& name, const std::string& title,
                   const std::vector<FigureColumn>& columns) {
  write_figure(folder, name, title, columns, "--surface");
}

}  // namespace wisp
