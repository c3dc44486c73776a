// Published numbers, read from the CSV files in verification/published, and what figures leave behind.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wisp {

/// A file that belongs to the verification, such as "published/ghost-table-1.csv" or "ghost/outline.csv":
/// beside an installed program, else in the source. Errors (RunError): it is in neither place.
std::filesystem::path verification_file(const std::string& name);

/// One published table. Its first line names the columns, the leading columns name the rows.
class Published {
 public:
  /// @param name such as "ghost-table-1"
  explicit Published(const std::string& name);

  /// The number at a row, found by the words of its leading cells, and a column. Absent where nothing legible
  /// is printed. Errors (RunError): no such row or column.
  std::optional<double> at(const std::vector<std::string>& row, std::string_view column) const;
  /// Cells of each row, without the titles.
  const std::vector<std::vector<std::string>>& rows() const { return rows_; }

 private:
  std::string name_;
  std::vector<std::string> titles_;
  std::vector<std::vector<std::string>> rows_;
};

/// The data of a figure: one column of numbers each, all of one length; the first is the abscissa.
struct FigureColumn {
  std::string title;
  std::vector<double> values;
};

/// Writes FOLDER/NAME.csv and, where Python has Matplotlib, draws FOLDER/NAME.png: curves over the first
/// column (a logarithmic axis where they span many decades).
void write_curves(const std::filesystem::path& folder, const std::string& name, const std::string& title,
                  const std::vector<FigureColumn>& columns);

/// The same for points in the plane: columns x, y, the value that colours them and, optionally, the number of
/// the panel that a point is drawn in.
void write_points(const std::filesystem::path& folder, const std::string& name, const std::string& title,
                  const std::vector<FigureColumn>& columns);

/// The same for line segments in the plane: columns x0, y0, x1, y1 and the kind of each (0: grid, 1: split,
/// 2: control triangle), which gives its style.
void write_segments(const std::filesystem::path& folder, const std::string& name, const std::string& title,
                    const std::vector<FigureColumn>& columns);

/// The same for surfaces over the plane: columns x, y, height and, optionally, the number of the panel.
void write_surface(const std::filesystem::path& folder, const std::string& name, const std::string& title,
                   const std::vector<FigureColumn>& columns);

}  // namespace wisp
