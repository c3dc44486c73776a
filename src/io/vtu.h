// Points and cells as VTK XML files (UnstructuredGrid, appended binary, zlib) that ParaView and VTK open.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "io/atomic_file.h"

namespace wisp {

/// One array of results. Symmetric tensors have 6 components xx, yy, zz, xy, yz, zx or, in plane strain, 4:
/// xx, yy, zz, xy.
struct VtuField {
  std::string name;
  int components = 1;
  /// n x components, point by point; integers for identifiers and counts.
  std::variant<std::vector<double>, std::vector<std::int64_t>> values;
  std::string unit = {};                          ///< SI unit, "" if none; VTK's key UNITS_LABEL
  std::vector<std::string> component_names = {};  ///< empty, or one for each component
};

/// Points without cells: each becomes a vertex.
struct VtuPoints {
  std::vector<double> positions;  ///< n x 3 [m]; z = 0 in 2D
  std::vector<VtuField> fields;   ///< n rows each; every rank names the same fields in the same order
  std::vector<VtuField> globals =
      {};  ///< numbers of the whole state: name TimeValue is VTK's own for the time [s]
};

/// VTK's numbers of the cell types that Wisp draws.
enum class VtuCell : std::uint8_t {
  vertex = 1,
  line = 3,
  polyline = 4,
  triangle = 5,
  quad = 9,
  tetrahedron = 10,
  hexahedron = 12
};

/// A mesh, a grid or a wall.
struct VtuCells {
  std::vector<double> positions;           ///< n x 3 [m]
  std::vector<std::int64_t> connectivity;  ///< points of cell 0, of cell 1, ... in VTK's order
  std::vector<std::int64_t> offsets;       ///< one past the last entry of each cell in `connectivity`
  std::vector<VtuCell> types;              ///< one for each cell
  std::vector<VtuField> point_fields = {};
  std::vector<VtuField> cell_fields = {};
  std::vector<VtuField> globals = {};
};

/// Writes one file atomically. RunError if it cannot be written, or if an array has not the announced size.
void write_vtu(const std::filesystem::path& path, const VtuPoints& points);
void write_vtu_cells(const std::filesystem::path& path, const VtuCells& cells);

/// Collective. Each rank writes its own points: on one rank `<stem>.vtu`; on several `<stem>.rank-<r>.vtu`
/// and, when all pieces are there, rank 0 writes `<stem>.pvtu`, which names them. Returns the file to open,
/// on every rank.
std::filesystem::path write_vtu_pieces(const std::filesystem::path& stem, const VtuPoints& points,
                                       const OutputRanks& place);

/// `points` and step 10: points-000010.
std::string step_name(const std::string& stem, std::int64_t step);

}  // namespace wisp
