#include "geometry/stl.h"

#include <Eigen/Geometry>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>

#include "core/error.h"
#include "geometry/csv.h"

namespace wisp {
namespace {

constexpr std::size_t header_bytes = 84, triangle_bytes = 50;

/// Joins equal corners.
class Joined {
 public:
  Triangles mesh;

  int vertex(const Eigen::Vector3d& x) {
    // -0.0 and 0.0 are the same place.
    const std::array<double, 3> key{x[0] + 0.0, x[1] + 0.0, x[2] + 0.0};
    const auto [it, added] = numbers_.try_emplace(key, static_cast<int>(mesh.vertices.size()));
    if (added) mesh.vertices.emplace_back(key[0], key[1], key[2]);
    return it->second;
  }

 private:
  std::map<std::array<double, 3>, int> numbers_;
};

std::string read_whole_file(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::error_code code;
  if (!std::filesystem::exists(path, code)) input_error("{}: no such file", name);
  if (std::filesystem::is_directory(path, code))
    input_error("{}: expected an STL file, found a folder", name);
  std::ifstream stream(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream && !stream.eof()) input_error("{}: the file cannot be read", name);
  if (text.empty()) input_error("{}: the file is empty", name);
  return text;
}

/// Words of a text file, each with its line.
class Words {
 public:
  Words(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  std::string_view next() {
    while (at_ < text_.size() && is_blank(text_[at_])) line_ += text_[at_++] == '\n';
    const std::size_t first = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return text_.substr(first, at_ - first);
  }
  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }
  void expect(std::string_view word) {
    if (const auto found = next(); found != word) wrong(fmt::format("\"{}\"", word), found);
  }
  double number() {
    auto word = next();
    const auto found = word;
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0.0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || code != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
      wrong("a finite number", found);
    return value;
  }
  [[noreturn]] void wrong(const std::string& expected, std::string_view found) const {
    if (found.empty()) input_error("{}:{}: the file is cut short: expected {}", file_, line_, expected);
    input_error("{}:{}: expected {}, found \"{}\"", file_, line_, expected, shown(found));
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

void read_text(std::string_view text, const std::string& file, Joined& joined) {
  Words words(text, file);
  words.expect("solid");
  words.skip_line();
  for (auto word = words.next();; word = words.next()) {
    if (word == "endsolid") return;
    if (word != "facet") words.wrong("\"facet\" or \"endsolid\"", word);
    words.expect("normal");
    for (int k = 0; k < 3; ++k) words.number();
    words.expect("outer");
    words.expect("loop");
    std::array<int, 3> triangle{};
    for (int& v : triangle) {
      words.expect("vertex");
      Eigen::Vector3d x;
      for (int k = 0; k < 3; ++k) x[k] = words.number();
      v = joined.vertex(x);
    }
    words.expect("endloop");
    words.expect("endfacet");
    joined.mesh.triangles.push_back(triangle);
  }
}

void read_binary(std::string_view text, const std::string& file, Joined& joined) {
  std::uint32_t count = 0;
  std::memcpy(&count, text.data() + 80, sizeof count);
  for (std::size_t t = 0; t < count; ++t) {
    std::array<int, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<float, 3> x{};
      std::memcpy(x.data(), text.data() + header_bytes + t * triangle_bytes + 12 * (k + 1), sizeof x);
      for (const float v : x)
        if (!std::isfinite(v)) input_error("{}: triangle {}: a coordinate is not finite", file, t + 1);
      triangle[k] = joined.vertex(Eigen::Vector3d(x[0], x[1], x[2]));
    }
    joined.mesh.triangles.push_back(triangle);
  }
}

std::string shown_point(const Eigen::Vector3d& x) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
}

void check_closed(const Triangles& mesh, const std::string& file) {
  if (mesh.triangles.empty()) input_error("{}: no triangles", file);
  struct Use {
    int forward = 0, backward = 0;  // number of the last triangle, from 1
    int count = 0;
  };
  std::map<std::pair<int, int>, Use> edges;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles[t];
    const int number = static_cast<int>(t) + 1;
    const auto corner = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(v[k])]; };
    const Eigen::Vector3d a = corner(1) - corner(0), b = corner(2) - corner(0);
    if (a.cross(b).norm() <= 1e-14 * std::max(a.squaredNorm(), b.squaredNorm()))
      input_error("{}: triangle {} at {} has no area", file, number, shown_point(corner(0)));
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = v[k], to = v[(k + 1) % 3];
      Use& use = edges[std::minmax(from, to)];
      int& slot = from < to ? use.forward : use.backward;
      if (++use.count > 2)
        input_error("{}: more than two triangles share the edge from {} to {}", file, shown_point(corner(k)),
                    shown_point(corner((k + 1) % 3)));
      if (slot != 0)
        input_error("{}: triangles {} and {} are flipped against each other at the edge from {} to {}", file,
                    slot, number, shown_point(corner(k)), shown_point(corner((k + 1) % 3)));
      slot = number;
    }
  }
  for (const auto& [edge, use] : edges)
    if (use.count == 1)
      input_error("{}: the surface has a hole: only triangle {} has the edge from {} to {}", file,
                  use.forward + use.backward,
                  shown_point(mesh.vertices[static_cast<std::size_t>(edge.first)]),
                  shown_point(mesh.vertices[static_cast<std::size_t>(edge.second)]));
}

}  // namespace

Triangles read_stl(const std::filesystem::path& path) {
  const std::string file = path.string(), text = read_whole_file(path);
  Joined joined;
  std::uint32_t count = 0;
  if (text.size() >= header_bytes) std::memcpy(&count, text.data() + 80, sizeof count);
  const std::size_t expected = header_bytes + triangle_bytes * std::size_t{count};
  // A binary header may begin with "solid" too: the size decides.
  if (text.size() >= header_bytes && text.size() == expected) {
    read_binary(text, file, joined);
  } else if (text.find_first_not_of(" \t\r\n") == text.find("solid")) {
    read_text(text, file, joined);
  } else if (text.size() < header_bytes) {
    input_error("{}: no STL file: neither \"solid\" nor the {} bytes of a binary header", file, header_bytes);
  } else {
    input_error("{}: {} triangles take {} bytes, but the file has {}: cut short, or no STL file", file, count,
                expected, text.size());
  }
  check_closed(joined.mesh, file);
  double volume = 0.0;
  const auto& x = joined.mesh.vertices;
  for (const auto& t : joined.mesh.triangles) {
    const auto corner = [&](std::size_t k) -> Eigen::Vector3d {
      return x[static_cast<std::size_t>(t[k])] - x[0];
    };
    volume += corner(0).dot(corner(1).cross(corner(2)));
  }
  if (volume < 0.0)
    for (auto& t : joined.mesh.triangles) std::swap(t[0], t[1]);
  return std::move(joined.mesh);
}

}  // namespace wisp
