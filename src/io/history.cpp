#include "io/history.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "io/atomic_file.h"

namespace wisp {
namespace fs = std::filesystem;

namespace {

std::string header_line(const std::vector<std::string>& columns) {
  std::string line = "step,time";
  std::vector<std::string> seen{"step", "time"};
  for (const std::string& name : columns) {
    if (name.empty() || name.find_first_of(",\"\r\n") != std::string::npos)
      input_error(
          "\"{}\" cannot name a column of the history: expected a name without comma, quote or line end",
          name);
    if (std::find(seen.begin(), seen.end(), name) != seen.end())
      input_error("the column \"{}\" of the history is named twice", name);
    seen.push_back(name);
    line += "," + name;
  }
  return line + "\n";
}

/// The step of a row, or false where the row has not the right number of numbers.
bool parse_row(std::string_view row, std::size_t columns, std::int64_t& step) {
  std::size_t at = 0;
  for (std::size_t c = 0; c < columns; ++c) {
    const std::size_t end = std::min(row.find(',', at), row.size());
    const char *first = row.data() + at, *last = row.data() + end;
    double number = 0.0;
    const auto result = c == 0 ? std::from_chars(first, last, step) : std::from_chars(first, last, number);
    if (result.ec != std::errc() || result.ptr != last) return false;
    if ((end == row.size()) != (c + 1 == columns)) return false;
    at = end + 1;
  }
  return true;
}

}  // namespace

History::History(fs::path path, std::size_t columns) : path_(std::move(path)), columns_(columns) {
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (descriptor_ < 0) run_error("cannot write {}: {}", path_.string(), std::strerror(errno));
}

History::History(History&& other) noexcept
    : path_(std::move(other.path_)),
      columns_(other.columns_),
      descriptor_(std::exchange(other.descriptor_, -1)),
      flush_every_(other.flush_every_),
      pending_rows_(std::exchange(other.pending_rows_, 0)),
      pending_(std::exchange(other.pending_, {})) {}

History::~History() {
  if (descriptor_ < 0) return;
  try {
    flush();
  } catch (const RunError&) {
    // A destructor cannot report it; whoever needs to know calls flush or sync.
  }
  ::close(descriptor_);
}

History History::start(const fs::path& path, const std::vector<std::string>& columns) {
  write_atomically(path, header_line(columns));
  return History(path, columns.size());
}

History History::resume(const fs::path& path, const std::vector<std::string>& columns, std::int64_t step) {
  if (!fs::exists(path)) return start(path, columns);
  const std::string header = header_line(columns);
  const std::string text = read_whole(path, "the history");
  if (!text.starts_with(header))
    input_error("{}: its columns are \"{}\", expected \"{}\"", path.string(), text.substr(0, text.find('\n')),
                header.substr(0, header.size() - 1));
  std::string kept = header;
  std::size_t line = 1;
  for (std::size_t at = header.size(); at < text.size(); ++line) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) break;  // torn when the run was killed
    const std::string_view row = std::string_view(text).substr(at, end - at);
    std::int64_t its_step = 0;
    if (!parse_row(row, columns.size() + 2, its_step))
      input_error("{}:{}: expected {} numbers separated by commas", path.string(), line + 1,
                  columns.size() + 2);
    if (its_step <= step) kept.append(row).append("\n");
    at = end + 1;
  }
  write_atomically(path, kept);
  return History(path, columns.size());
}

void History::add(std::int64_t step, double time, std::span<const double> values) {
  if (values.size() != columns_)
    run_error("a row of {} has {} values, expected {}", path_.string(), values.size(), columns_);
  auto out = std::back_inserter(pending_);
  fmt::format_to(out, "{},{}", step, time);
  for (const double value : values) fmt::format_to(out, ",{}", value);
  pending_ += '\n';
  if (++pending_rows_ >= flush_every_) flush();
}

void History::flush() {
  const char* next = pending_.data();
  std::size_t count = pending_.size();
  while (count > 0) {
    const ssize_t done = ::write(descriptor_, next, count);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) run_error("cannot write {}: {}", path_.string(), std::strerror(errno));
    next += done;
    count -= static_cast<std::size_t>(done);
  }
  pending_.clear();
  pending_rows_ = 0;
}

void History::sync() {
  flush();
  if (::fsync(descriptor_) != 0) run_error("cannot write {}: {}", path_.string(), std::strerror(errno));
}

}  // namespace wisp
