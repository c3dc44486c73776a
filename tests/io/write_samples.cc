// Writes sample files and, beside them, every array as raw bytes, for the tests that read them with VTK and
// Python.
#include <fmt/format.h>

#include <bit>
#include <cstdio>
#include <fstream>
#include <random>

#include "io/history.h"
#include "io/pvd.h"
#include "io/rank_threads.h"
#include "io/vtu.h"

namespace {
namespace fs = std::filesystem;
using namespace wisp;

fs::path folder;

template <class T>
void dump(const std::string& file, const std::string& array, const std::vector<T>& values) {
  fs::create_directories(folder / "expected");
  std::ofstream(folder / "expected" / fmt::format("{}.{}.bin", file, array), std::ios::binary)
      .write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(T)));
}

void dump(const std::string& file, const VtuPoints& points) {
  dump(file, "Points", points.positions);
  for (const VtuField& field : points.fields)
    std::visit([&](const auto& values) { dump(file, field.name, values); }, field.values);
}

std::vector<double> random_doubles(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<double> values(count);
  for (double& value : values)
    value = std::bit_cast<double>(random());  // all kinds: tiny, huge, infinite, NaN
  return values;
}

VtuPoints points(std::size_t count, double time, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<double> positions(3 * count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    positions[3 * i] = uniform(random);
    positions[3 * i + 1] = uniform(random) + time;
  }
  std::vector<double> displacement(3 * count, 0.0);
  for (std::size_t i = 0; i < count; ++i) displacement[3 * i + 1] = time;
  std::vector<double> volume(count, 1.0 / static_cast<double>(count + 1));
  std::vector<std::int64_t> ids(count);
  for (std::size_t i = 0; i < count; ++i) ids[i] = static_cast<std::int64_t>(i) + (std::int64_t{1} << 40);
  return {positions,
          {{"displacement", 3, displacement, "m"},
           {"stress", 4, random_doubles(4 * count, seed + 1), "Pa", {"xx", "yy", "zz", "xy"}},
           {"volume", 1, volume, "m^3"},
           {"id", 1, ids},
           {"a < b & \"c\"", 1, random_doubles(count, seed + 2)}},
          {{"TimeValue", 1, std::vector<double>{time}}, {"step", 1, std::vector<std::int64_t>{10}}}};
}

void write_points(PvdSeries& series) {
  // 131072 doubles fill one compressed block exactly.
  for (const auto& [name, count] :
       {std::pair<std::string, std::size_t>{"empty", 0}, {"one", 1}, {"block", 131072}, {"many", 150001}}) {
    const VtuPoints sample = points(count, 0.0, 3 * count);
    write_vtu(folder / (name + ".vtu"), sample);
    dump(name + ".vtu", sample);
  }
  for (int i = 0; i < 3; ++i) {
    const double time = 0.1 * i;
    const VtuPoints sample = points(400, time, 99);
    const fs::path path = write_vtu_pieces(folder / step_name("points", 10 * i), sample, {});
    dump(path.filename().string(), sample);
    series.add(time, path);
  }
}

void write_pieces(PvdSeries& series) {
  VtuPoints all{{}, {}};
  test::run_as_ranks(3, [&](const OutputRanks& place) {
    const VtuPoints mine = points(place.rank == 1 ? 0 : 200, 0.3, static_cast<std::uint64_t>(place.rank));
    const fs::path path = write_vtu_pieces(folder / step_name("points", 30), mine, place);
    place.all_succeeded(true);
    if (place.rank != 0) return;
    series.add(0.3, path);
  });
  for (const std::uint64_t rank : {0u, 2u}) {
    const VtuPoints mine = points(200, 0.3, rank);
    all.positions.insert(all.positions.end(), mine.positions.begin(), mine.positions.end());
    if (all.fields.empty()) {
      all.fields = mine.fields;
      continue;
    }
    for (std::size_t f = 0; f < all.fields.size(); ++f)
      std::visit(
          [&](auto& values) {
            const auto& more = std::get<std::decay_t<decltype(values)>>(mine.fields[f].values);
            values.insert(values.end(), more.begin(), more.end());
          },
          all.fields[f].values);
  }
  dump("points-000030.pvtu", all);
}

void write_cells() {
  const VtuCells cells{{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1},
                       {0, 1, 2, 3, 0, 1, 2, 0, 1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 7, 4},
                       {4, 7, 15, 20},
                       {VtuCell::quad, VtuCell::triangle, VtuCell::hexahedron, VtuCell::polyline},
                       {{"node", 1, std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7}}},
                       {{"active", 1, std::vector<double>{1, 0, 1, 0}}}};
  write_vtu_cells(folder / "cells.vtu", cells);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  folder = argv[1];
  fs::remove_all(folder);
  PvdSeries series(folder / "points.pvd");
  write_points(series);
  write_pieces(series);
  write_cells();
  History history =
      History::start(folder / "history.csv", {"kinetic energy [J]", "strain energy [J]", "iterations"});
  for (int i = 0; i <= 30; ++i) {
    const double t = 0.01 * i;
    history.add(i, t, std::vector<double>{0.1 * t, 1.0 / 3.0 - 0.1 * t, 4.0});
  }
  return 0;
}
