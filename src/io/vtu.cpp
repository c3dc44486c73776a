#include "io/vtu.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>
#include <span>

#include "core/error.h"
#include "io/xml.h"

namespace wisp {
namespace fs = std::filesystem;

namespace {

constexpr std::size_t block_size = std::size_t{1} << 20;  // bytes before compression
constexpr std::string_view byte_order =
    std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";

/// An array to be written: bytes and what VTK must know of them.
struct ArrayView {
  std::string_view type;
  std::span<const std::byte> bytes;
  std::size_t count;  ///< numbers, not bytes
};

template <class T>
ArrayView view(std::string_view type, const std::vector<T>& values) {
  return {type, std::as_bytes(std::span(values)), values.size()};
}

ArrayView view(const VtuField& field) {
  if (const auto* reals = std::get_if<std::vector<double>>(&field.values)) return view("Float64", *reals);
  return view("Int64", std::get<std::vector<std::int64_t>>(field.values));
}

std::string_view type_name(const VtuField& field) { return view(field).type; }

void append_number(std::string& bytes, std::uint64_t number) {
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof raw);
}

/// VTK's compressed array: number of blocks, size of a full block, size of the last block if it is not full
/// (else 0), the compressed size of each block, then the blocks.
void append_compressed(std::string& appended, std::span<const std::byte> bytes) {
  const std::size_t blocks = (bytes.size() + block_size - 1) / block_size;
  std::vector<std::uint64_t> sizes;
  std::string packed;
  for (std::size_t b = 0; b < blocks; ++b) {
    const auto block = bytes.subspan(b * block_size, std::min(block_size, bytes.size() - b * block_size));
    const std::size_t start = packed.size();
    uLongf length = ::compressBound(static_cast<uLong>(block.size()));
    packed.resize(start + length);
    const int status = ::compress2(reinterpret_cast<Bytef*>(packed.data() + start), &length,
                                   reinterpret_cast<const Bytef*>(block.data()),
                                   static_cast<uLong>(block.size()), Z_BEST_SPEED);
    if (status != Z_OK)
      run_error("zlib could not compress a block of {} bytes (status {})", block.size(), status);
    packed.resize(start + length);
    sizes.push_back(length);
  }
  append_number(appended, blocks);
  append_number(appended, block_size);
  append_number(appended, bytes.size() % block_size);
  for (const std::uint64_t size : sizes) append_number(appended, size);
  appended += packed;
}

std::string component_names(const VtuField& field) {
  std::string text;
  for (std::size_t i = 0; i < field.component_names.size(); ++i)
    text += fmt::format(" ComponentName{}=\"{}\"", i, xml_escape(field.component_names[i]));
  return text;
}

/// The document while it grows: its text, and the appended bytes that the text points into.
struct Document {
  std::string text;
  std::string appended;

  void array(std::string_view name, int components, const ArrayView& values,
             const std::string& attributes = {}, std::string_view unit = {}) {
    text += fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} format=\"appended\" offset=\"{}\"",
        values.type, xml_escape(name), components, attributes, appended.size());
    if (unit.empty())
      text += "/>\n";
    else
      text += fmt::format(
          "><InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">{}</InformationKey></DataArray>\n",
          xml_escape(unit));
    append_compressed(appended, values.bytes);
  }

  void fields(std::string_view section, const std::vector<VtuField>& list, std::size_t rows) {
    text += fmt::format("<{}>\n", section);
    for (const VtuField& field : list) {
      const ArrayView values = view(field);
      if (field.components < 1 || values.count != rows * static_cast<std::size_t>(field.components))
        run_error("field \"{}\" has {} numbers, expected {} rows of {}", field.name, values.count, rows,
                  field.components);
      array(field.name, field.components, values, component_names(field), field.unit);
    }
    text += fmt::format("</{}>\n", section);
  }

  void globals(const std::vector<VtuField>& list) {
    if (list.empty()) return;
    text += "<FieldData>\n";
    for (const VtuField& field : list) {
      const ArrayView values = view(field);
      if (field.components < 1 || values.count % static_cast<std::size_t>(field.components) != 0)
        run_error("field \"{}\" has {} numbers, which are no rows of {}", field.name, values.count,
                  field.components);
      const std::size_t rows = values.count / static_cast<std::size_t>(field.components);
      array(field.name, field.components, values, fmt::format(" NumberOfTuples=\"{}\"", rows), field.unit);
    }
    text += "</FieldData>\n";
  }
};

struct CellArrays {
  ArrayView connectivity, offsets, types;
};

void write_document(const fs::path& path, const std::vector<double>& positions, const CellArrays& cells,
                    const std::vector<VtuField>& point_fields, const std::vector<VtuField>& cell_fields,
                    const std::vector<VtuField>& globals) {
  if (positions.size() % 3 != 0) run_error("positions for {} are no rows of 3", path.string());
  const std::size_t rows = positions.size() / 3;
  Document document;
  document.text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" "
      "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n",
      byte_order);
  document.globals(globals);
  document.text +=
      fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", rows, cells.types.count);
  document.fields("PointData", point_fields, rows);
  document.fields("CellData", cell_fields, cells.types.count);
  document.text += "<Points>\n";
  document.array("Points", 3, view("Float64", positions));
  document.text += "</Points>\n<Cells>\n";
  document.array("connectivity", 1, cells.connectivity);
  document.array("offsets", 1, cells.offsets);
  document.array("types", 1, cells.types);
  document.text += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  AtomicFile file(path);
  file.write(document.text);
  file.write(document.appended);
  file.write("\n</AppendedData>\n</VTKFile>\n");
  file.commit();
}

void declare_fields(std::string& text, const std::vector<VtuField>& fields) {
  text += "<PPointData>\n";
  for (const VtuField& field : fields)
    text += fmt::format("<PDataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{}/>\n",
                        type_name(field), xml_escape(field.name), field.components, component_names(field));
  text += "</PPointData>\n";
}

void write_pvtu(const fs::path& path, const VtuPoints& points, const std::vector<std::string>& pieces) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" "
      "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<PUnstructuredGrid GhostLevel=\"0\">\n",
      byte_order);
  declare_fields(text, points.fields);
  text += "<PPoints>\n<PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n</PPoints>\n";
  for (const std::string& piece : pieces) text += fmt::format("<Piece Source=\"{}\"/>\n", xml_escape(piece));
  text += "</PUnstructuredGrid>\n</VTKFile>\n";
  write_atomically(path, text);
}

}  // namespace

void write_vtu(const fs::path& path, const VtuPoints& points) {
  const std::size_t rows = points.positions.size() / 3;
  std::vector<std::int64_t> connectivity(rows), offsets(rows);
  std::iota(connectivity.begin(), connectivity.end(), std::int64_t{0});
  std::iota(offsets.begin(), offsets.end(), std::int64_t{1});
  const std::vector<std::uint8_t> types(rows, static_cast<std::uint8_t>(VtuCell::vertex));
  write_document(path, points.positions,
                 {view("Int64", connectivity), view("Int64", offsets), view("UInt8", types)}, points.fields,
                 {}, points.globals);
}

void write_vtu_cells(const fs::path& path, const VtuCells& cells) {
  const auto rows = static_cast<std::int64_t>(cells.positions.size() / 3);
  if (cells.offsets.size() != cells.types.size())
    run_error("{} cells have {} offsets", cells.types.size(), cells.offsets.size());
  const std::int64_t last = cells.offsets.empty() ? 0 : cells.offsets.back();
  if (!std::is_sorted(cells.offsets.begin(), cells.offsets.end()) ||
      last != static_cast<std::int64_t>(cells.connectivity.size()))
    run_error("the offsets of the cells for {} do not rise to the {} entries of their connectivity",
              path.string(), cells.connectivity.size());
  for (const std::int64_t point : cells.connectivity)
    if (point < 0 || point >= rows)
      run_error("a cell for {} names point {} of {}", path.string(), point, rows);
  write_document(
      path, cells.positions,
      {view("Int64", cells.connectivity), view("Int64", cells.offsets), view("UInt8", cells.types)},
      cells.point_fields, cells.cell_fields, cells.globals);
}

fs::path write_vtu_pieces(const fs::path& stem, const VtuPoints& points, const OutputRanks& place) {
  const std::string name = stem.filename().string();
  const auto piece = [&](int rank) { return fmt::format("{}.rank-{}.vtu", name, rank); };
  if (place.ranks == 1) {
    const fs::path path = fs::path(stem) += ".vtu";
    write_vtu(path, points);
    return path;
  }
  const fs::path path = fs::path(stem) += ".pvtu";
  together(place, path.string(), [&] { write_vtu(stem.parent_path() / piece(place.rank), points); });
  together(place, path.string(), [&] {
    if (place.rank != 0) return;
    std::vector<std::string> pieces;
    for (int r = 0; r < place.ranks; ++r) pieces.push_back(piece(r));
    write_pvtu(path, points, pieces);
  });
  return path;
}

std::string step_name(const std::string& stem, std::int64_t step) {
  return fmt::format("{}-{:06}", stem, step);
}

}  // namespace wisp
