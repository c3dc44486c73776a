// Strict reading of comma separated values: every complaint names file, line and column of the text.
#pragma once
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace wisp {

/// One cell of a CSV line, blanks around it removed; `column` counts characters of the line from 1.
struct CsvCell {
  std::string_view text;
  int column = 1;
};

/// One line of a CSV file, counted from 1; a blank line has no cells. The cells point into the `CsvFile` and
/// last until its next line is read.
struct CsvLine {
  int number = 0;
  std::vector<CsvCell> cells;
};

/// A CSV file, read line by line. Cells are separated by commas and never quoted; lines that start with '#'
/// are comments; both line endings and a UTF-8 byte order mark are accepted.
class CsvFile {
 public:
  /// Throws InputError if the file is missing, not a regular file, unreadable or empty.
  explicit CsvFile(const std::filesystem::path& path);
  CsvFile(const CsvFile&) = delete;  // cells point into the text
  CsvFile& operator=(const CsvFile&) = delete;

  /// Moves to the next line that is no comment; false at the end of the file.
  bool next(CsvLine& line);

  /// The finite number in cell i of a line. Throws InputError, which calls the cell `name`, if it is anything
  /// else.
  double number(const CsvLine& line, std::size_t i, std::string_view name) const;

  /// Throws InputError "file:line: message".
  [[noreturn]] void fail(const CsvLine& line, std::string_view message) const;
  /// Throws InputError "file:line:column: message".
  [[noreturn]] void fail(const CsvLine& line, const CsvCell& cell, std::string_view message) const;

  const std::string& name() const { return name_; }

 private:
  std::string name_;
  std::ifstream stream_;
  std::string text_;  // of the current line
  int line_ = 0;
};

/// Text from a file made fit for a one-line message: cut after 40 characters, control characters shown as
/// '?'.
std::string shown(std::string_view text);

}  // namespace wisp
