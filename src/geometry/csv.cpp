#include "geometry/csv.h"

#include <charconv>
#include <cmath>
#include <system_error>

#include "core/error.h"

namespace wisp {
namespace {

constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace

std::string shown(std::string_view text) {
  constexpr std::size_t most = 40;
  std::string out(text.substr(0, most));
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  if (text.size() > most) out += "...";
  return out;
}

CsvFile::CsvFile(const std::filesystem::path& path) : name_(path.string()) {
  std::error_code code;
  if (!std::filesystem::exists(path, code)) input_error("{}: no such file", name_);
  if (std::filesystem::is_directory(path, code))
    input_error("{}: expected a CSV file, found a folder", name_);
  stream_.open(path, std::ios::binary);
  if (!stream_) input_error("{}: the file cannot be opened for reading", name_);
  const std::string_view mark = "\xef\xbb\xbf";
  std::string start(mark.size(), ' ');
  stream_.read(start.data(), static_cast<std::streamsize>(start.size()));
  stream_.clear();
  const std::streamoff first = start == mark ? static_cast<std::streamoff>(mark.size()) : 0;
  stream_.seekg(first);
  char c = '\0';
  const bool empty = !(stream_ >> c);
  if (stream_.bad()) input_error("{}: the file cannot be read", name_);
  if (empty) input_error("{}: the file is empty", name_);
  stream_.seekg(first);
}

bool CsvFile::next(CsvLine& line) {
  while (std::getline(stream_, text_)) {
    const std::string_view whole = text_;
    line.number = ++line_;
    line.cells.clear();
    const std::string_view content = trimmed(whole);
    if (content.starts_with('#')) continue;
    if (content.empty()) return true;
    std::size_t begin = 0;
    while (true) {
      const std::size_t end = std::min(whole.find(',', begin), whole.size());
      const std::string_view raw = whole.substr(begin, end - begin);
      const std::string_view text = trimmed(raw);
      const std::size_t at = text.empty() ? begin : static_cast<std::size_t>(text.data() - whole.data());
      line.cells.push_back({text, static_cast<int>(at) + 1});
      if (end == whole.size()) return true;
      begin = end + 1;
    }
  }
  if (stream_.bad()) input_error("{}: the file cannot be read", name_);
  return false;
}

double CsvFile::number(const CsvLine& line, std::size_t i, std::string_view name) const {
  const CsvCell& cell = line.cells[i];
  std::string_view text = cell.text;
  if (text.empty()) fail(line, cell, fmt::format("column '{}' is empty, expected a number", name));
  if (text.size() > 1 && text[0] == '+' && text[1] != '-')
    text.remove_prefix(1);  // from_chars knows no plus sign
  double value = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code == std::errc::result_out_of_range)
    fail(line, cell,
         fmt::format("column '{}': {} is out of the range of double precision", name, shown(text)));
  if (code != std::errc() || end != text.data() + text.size()) {
    const bool separator = text.find_first_of("; \t") != std::string_view::npos;
    fail(line, cell,
         fmt::format("column '{}': expected a number, found '{}'{}", name, shown(text),
                     separator ? " (cells are separated by commas)" : ""));
  }
  if (!std::isfinite(value))
    fail(line, cell, fmt::format("column '{}': expected a finite number, found '{}'", name, shown(text)));
  return value;
}

void CsvFile::fail(const CsvLine& line, std::string_view message) const {
  input_error("{}:{}: {}", name_, line.number, message);
}

void CsvFile::fail(const CsvLine& line, const CsvCell& cell, std::string_view message) const {
  input_error("{}:{}:{}: {}", name_, line.number, cell.column, message);
}

}  // namespace wisp
