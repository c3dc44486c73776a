#include "geometry/point_file.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "geometry/csv.h"

namespace wisp {
namespace {

/// The columns that a point file may have; a column's place in this list is its slot.
template <int dim>
constexpr std::array<std::string_view, 3 * dim + 1> slot_names();
template <>
constexpr std::array<std::string_view, 7> slot_names<2>() {
  return {"x", "y", "volume", "vx", "vy", "lx", "ly"};
}
template <>
constexpr std::array<std::string_view, 10> slot_names<3>() {
  return {"x", "y", "z", "volume", "vx", "vy", "vz", "lx", "ly", "lz"};
}

template <int dim>
constexpr std::size_t volume_slot = dim;
template <int dim>
constexpr std::size_t velocity_slot = dim + 1;
template <int dim>
constexpr std::size_t half_length_slot = 2 * dim + 1;

bool names_third_direction(std::string_view text) { return text == "z" || text == "vz" || text == "lz"; }

/// Which slot each column of the header fills.
template <int dim>
std::vector<std::size_t> read_header(const CsvFile& file, const CsvLine& header) {
  const auto names = slot_names<dim>();
  std::vector<std::size_t> slots;
  std::vector<bool> present(names.size(), false);
  for (const CsvCell& cell : header.cells) {
    const auto found = std::find(names.begin(), names.end(), cell.text);
    if (found == names.end()) {
      if (cell.text.empty()) file.fail(header, cell, "the header has a column without a name");
      if (dim == 2 && names_third_direction(cell.text))
        file.fail(header, cell, fmt::format("column '{}' has no meaning in 2D", cell.text));
      file.fail(header, cell,
                fmt::format("unknown column '{}', expected {}", shown(cell.text), fmt::join(names, ", ")));
    }
    const auto slot = static_cast<std::size_t>(found - names.begin());
    if (present[slot]) file.fail(header, cell, fmt::format("column '{}' appears twice", cell.text));
    present[slot] = true;
    slots.push_back(slot);
  }
  for (std::size_t slot = 0; slot <= volume_slot<dim>; ++slot)
    if (!present[slot]) file.fail(header, fmt::format("the required column '{}' is missing", names[slot]));
  for (const std::size_t first : {velocity_slot<dim>, half_length_slot<dim>}) {
    const auto begin = present.begin() + static_cast<std::ptrdiff_t>(first);
    if (std::find(begin, begin + dim, true) == begin + dim) continue;
    const auto missing = std::find(begin, begin + dim, false);
    if (missing != begin + dim)
      file.fail(header,
                fmt::format("column '{}' is missing: give {} or none of them",
                            names[static_cast<std::size_t>(missing - present.begin())],
                            fmt::join(names.begin() + static_cast<std::ptrdiff_t>(first),
                                      names.begin() + static_cast<std::ptrdiff_t>(first) + dim, ", ")));
  }
  return slots;
}

}  // namespace

template <int dim>
void for_each_point(const PointFile& points, const std::filesystem::path& folder,
                    const std::function<void(const PointRow<dim>&)>& visit) {
  using Vector = typename PointRow<dim>::Vector;
  if (points.file.empty()) input_error("points: 'file' is empty, expected the path of a CSV file");
  CsvFile file(folder / points.file);
  CsvLine line;
  do {
    if (!file.next(line))
      input_error("{}: no header, expected {}", file.name(), fmt::join(slot_names<dim>(), ", "));
  } while (line.cells.empty());
  const auto names = slot_names<dim>();
  const auto slots = read_header<dim>(file, line);
  const auto has = [&](std::size_t slot) {
    return std::find(slots.begin(), slots.end(), slot) != slots.end();
  };
  const bool has_velocities = has(velocity_slot<dim>);
  const bool has_half_lengths = has(half_length_slot<dim>);

  bool any = false;
  std::array<double, 3 * dim + 1> row{};
  while (file.next(line)) {
    if (line.cells.empty()) continue;
    if (line.cells.size() != slots.size())
      file.fail(line, fmt::format("found {} cells, but the header has {} columns", line.cells.size(),
                                  slots.size()));
    for (std::size_t i = 0; i < slots.size(); ++i) {
      const std::size_t slot = slots[i];
      row[slot] = file.number(line, i, names[slot]);
      if (slot == volume_slot<dim> && row[slot] <= 0.0)
        file.fail(line, line.cells[i],
                  fmt::format("column 'volume': {} is not positive", shown(line.cells[i].text)));
      if (slot >= half_length_slot<dim> && row[slot] < 0.0)
        file.fail(line, line.cells[i],
                  fmt::format("column '{}': {} is negative", names[slot], shown(line.cells[i].text)));
    }
    any = true;
    PointRow<dim> point{Eigen::Map<const Vector>(row.data()), row[volume_slot<dim>], {}, {}};
    if (has_velocities) point.velocity = Eigen::Map<const Vector>(row.data() + velocity_slot<dim>);
    if (has_half_lengths) point.half_length = Eigen::Map<const Vector>(row.data() + half_length_slot<dim>);
    visit(point);
  }
  if (!any) input_error("{}: a header but no points", file.name());
}

template <int dim>
PointTable<dim> read_points(const PointFile& points, const std::filesystem::path& folder) {
  PointTable<dim> table;
  for_each_point<dim>(points, folder, [&](const PointRow<dim>& row) {
    table.positions.push_back(row.position);
    table.volumes.push_back(row.volume);
    if (row.velocity) table.velocities.push_back(*row.velocity);
    if (row.half_length) table.half_lengths.push_back(*row.half_length);
  });
  return table;
}

template void for_each_point<2>(const PointFile&, const std::filesystem::path&,
                                const std::function<void(const PointRow<2>&)>&);
template void for_each_point<3>(const PointFile&, const std::filesystem::path&,
                                const std::function<void(const PointRow<3>&)>&);
template PointTable<2> read_points<2>(const PointFile&, const std::filesystem::path&);
template PointTable<3> read_points<3>(const PointFile&, const std::filesystem::path&);

}  // namespace wisp
