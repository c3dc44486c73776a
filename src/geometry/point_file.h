#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/describe.h"

namespace wisp {

/// Material points from a CSV file with a header line, in any order of columns: x, y, (z,) volume are
/// required; vx, vy, (vz) velocities and lx, ly, (lz) half-lengths of the points' domains are optional, all
/// directions or none.
struct PointFile {
  static constexpr std::string_view name = "points";
  static constexpr std::string_view summary = "material points listed in a CSV file";
  static constexpr std::string_view source = "";

  std::string file{};  ///< relative to the folder of the case

  static constexpr auto keys() {
    return std::tuple{
        key("file", &PointFile::file, "",
            "CSV file with a header: x,y[,z],volume in m and m^3 (m^2 in 2D); optional vx,vy[,vz] in m/s, "
            "lx,ly[,lz] half-lengths in m")
            .required()};
  }
};

/// The rows of a point file, one entry per point.
template <int dim>
struct PointTable {
  using Vector = Eigen::Matrix<double, dim, 1>;
  std::vector<Vector> positions;     ///< m
  std::vector<double> volumes;       ///< m^3, in 2D m^2; positive
  std::vector<Vector> velocities;    ///< m/s; empty if the file has none
  std::vector<Vector> half_lengths;  ///< m, not negative; empty if the file has none
};

/// One row of a point file.
template <int dim>
struct PointRow {
  using Vector = Eigen::Matrix<double, dim, 1>;
  Vector position;                    ///< m
  double volume;                      ///< m^3, in 2D m^2; positive
  std::optional<Vector> velocity;     ///< m/s
  std::optional<Vector> half_length;  ///< m, not negative
};

/// Calls visit(row) for every point of a file in turn, without keeping any. Throws InputError
/// "file:line:column: ..." for unknown, missing, repeated and half-given columns, rows with too few or too
/// many cells, cells that are no finite numbers, volumes that are not positive, negative half-lengths, and a
/// file without points.
template <int dim>
void for_each_point(const PointFile& points, const std::filesystem::path& folder,
                    const std::function<void(const PointRow<dim>&)>& visit);

/// All rows of a point file. Errors as above.
template <int dim>
PointTable<dim> read_points(const PointFile& points, const std::filesystem::path& folder = {});

extern template void for_each_point<2>(const PointFile&, const std::filesystem::path&,
                                       const std::function<void(const PointRow<2>&)>&);
extern template void for_each_point<3>(const PointFile&, const std::filesystem::path&,
                                       const std::function<void(const PointRow<3>&)>&);
extern template PointTable<2> read_points<2>(const PointFile&, const std::filesystem::path&);
extern template PointTable<3> read_points<3>(const PointFile&, const std::filesystem::path&);

}  // namespace wisp
