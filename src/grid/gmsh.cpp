#include "grid/gmsh.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <unordered_map>

#include "core/error.h"
#include "geometry/csv.h"

namespace wisp {

namespace {

/// Words of a file with the line that they stand in, and the numbers of its binary stretches.
class Words {
 public:
  explicit Words(const std::filesystem::path& file) : name_(file.string()) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) input_error("{}: no such file", name_);
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    if (!stream) input_error("{}: cannot be read", name_);
    text_ = std::move(text).str();
  }

  const std::string& name() const { return name_; }

  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    std::string text = fmt::format(format, std::forward<Args>(args)...);
    if (at_ == text_.size() && text.find("cut short") == std::string::npos)
      text += "; the file ends here: it was cut short";
    input_error("{}:{}: {}", name_, line_, text);
  }

  /// The next word; empty at the end of the file.
  std::string_view next() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) pass();
    const std::size_t start = at_;
    if (at_ < text_.size() && text_[at_] == '"') {
      pass();
      while (at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\n') pass();
      if (at_ < text_.size() && text_[at_] == '"') pass();
    } else {
      while (at_ < text_.size() && !std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    }
    return std::string_view(text_).substr(start, at_ - start);
  }

  template <class T>
  T number(const char* what) {
    const std::string_view word = next();
    if (word.empty()) fail("the file ends where {} is expected: it was cut short", what);
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size())
      fail("expected {}, found '{}'", what, shown(word));
    return value;
  }
  /// From here on numbers are bytes, after the end of the line if one stands here, or words again.
  void binary(bool bytes) {
    if (bytes && at_ < text_.size() && text_[at_] == '\n') pass();
    binary_ = bytes;
  }
  double real(const char* what) { return binary_ ? bytes<double>(what) : number<double>(what); }
  /// @param size  of the number where numbers are bytes: 4 or 8
  std::int64_t integer(const char* what, int size = 4) {
    if (!binary_) return number<std::int64_t>(what);
    return size == 4 ? bytes<std::int32_t>(what) : bytes<std::int64_t>(what);
  }
  int count(const char* what, int size = 4) {
    const auto n = integer(what, size);
    if (n < 0 || n > 2000000000) fail("expected {}, found {}", what, n);
    return static_cast<int>(n);
  }
  void skip(int n, const char* what) {
    for (int i = 0; i < n; ++i) real(what);
  }
  void expect(std::string_view word) {
    const std::string_view found = next();
    if (found.empty()) fail("the file ends before {}: it was cut short", word);
    if (found != word) fail("expected {}, found '{}'", word, shown(found));
  }
  void skip_section(const std::string& name) {
    const std::string end = "\n$End" + name;
    const std::size_t found = text_.find(end, at_);
    if (found == std::string::npos)
      at_ = text_.size(), fail("the file ends before $End{}: it was cut short", name);
    while (at_ < found + end.size()) pass();
  }

 private:
  void pass() { line_ += text_[at_++] == '\n'; }

  template <class T>
  T bytes(const char* what) {
    if (text_.size() - at_ < sizeof(T)) at_ = text_.size(), fail("the file ends where {} is expected", what);
    T value;
    std::memcpy(&value, text_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }

  bool binary_ = false;
  std::string name_, text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

using Group = std::pair<int, int>;  // dimension and number of a physical group

class Reader {
 public:
  Reader(const std::filesystem::path& file, double scale) : words_(file), scale_(scale) {}

  Triangulation read() {
    format();
    bool nodes = false, elements = false;
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      if (!word.starts_with("$")) words_.fail("expected the start of a section, found '{}'", shown(word));
      const std::string section(word.substr(1));
      if (section == "PhysicalNames")
        names();
      else if (section == "Entities" && version_ >= 4.0)
        entities();
      else if (section == "Nodes")
        version_ >= 4.0 ? node_blocks() : plain_nodes(), nodes = true;
      else if (section == "Elements")
        version_ >= 4.0 ? element_blocks() : plain_elements(), elements = true;
      else {
        words_.skip_section(section);
        continue;
      }
      words_.binary(false);
      words_.expect("$End" + section);
    }
    if (!nodes) input_error("{}: no section $Nodes", words_.name());
    if (!elements) input_error("{}: no section $Elements", words_.name());
    return finish();
  }

 private:
  void format() {
    if (words_.next() != "$MeshFormat")
      input_error("{}: not a Gmsh file: it does not start with $MeshFormat", words_.name());
    version_ = words_.real("the format's version");
    if (!((version_ >= 2.0 && version_ < 3.0) || (version_ >= 4.0 && version_ < 5.0)))
      words_.fail("Gmsh format {} is not known; expected 2 or 4 (in Gmsh: Mesh.MshFileVersion = 4.1)",
                  version_);
    binary_ = words_.integer("0 (ASCII) or 1 (binary)") != 0;
    if (binary_ && version_ >= 4.0 && version_ < 4.1)
      words_.fail("binary files of format 4.0 are not read (in Gmsh: Mesh.MshFileVersion = 4.1)");
    if (words_.integer("the size of a number") != 8 && binary_)
      words_.fail("expected numbers of 8 bytes in a binary file");
    if (binary_) {
      words_.binary(true);
      if (words_.integer("1") != 1)
        words_.fail("the numbers of this binary file have the other order of bytes");
      words_.binary(false);
    }
    words_.expect("$EndMeshFormat");
  }

  void names() {
    const int n = words_.count("a number of names");
    for (int i = 0; i < n; ++i) {
      const int dimension = words_.count("a dimension"), number = words_.count("a physical group");
      const std::string_view text = words_.next();
      if (text.size() < 3 || text.front() != '"' || text.back() != '"')
        words_.fail("expected a name in quotation marks, found '{}'", shown(text));
      names_[{dimension, number}] = std::string(text.substr(1, text.size() - 2));
    }
  }

  void entities() {
    words_.binary(binary_);
    std::array<int, 4> counts{};
    for (int& c : counts) c = words_.count("a number of entities", 8);
    for (int dimension = 0; dimension < 4; ++dimension)
      for (int i = 0; i < counts[static_cast<std::size_t>(dimension)]; ++i) {
        const auto entity = words_.integer("an entity");
        words_.skip(dimension == 0 && version_ >= 4.1 ? 3 : 6, "a coordinate");
        const int groups = words_.count("a number of physical groups", 8);
        for (int g = 0; g < groups; ++g)
          groups_[{dimension, entity}].push_back(
              static_cast<int>(std::abs(words_.integer("a physical group"))));
        if (dimension == 0) continue;
        const int bounds = words_.count("a number of bounding entities", 8);
        for (int b = 0; b < bounds; ++b) words_.integer("a bounding entity");
      }
  }

  void add_node(std::int64_t tag) {
    const double x = words_.real("x"), y = words_.real("y"), z = words_.real("z");
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z))
      words_.fail("the coordinates of node {} are not finite numbers", tag);
    if (!index_.try_emplace(tag, static_cast<int>(vertices_.size())).second)
      words_.fail("node {} is listed twice", tag);
    vertices_.emplace_back(scale_ * x, scale_ * y);
    tags_.push_back(tag), heights_.push_back(z);
  }

  void plain_nodes() {
    const int n = words_.count("a number of nodes");
    words_.binary(binary_);
    for (int i = 0; i < n; ++i) add_node(words_.integer("a node"));
  }

  void node_blocks() {
    words_.binary(binary_);
    const int blocks = words_.count("a number of blocks", 8);
    words_.count("a number of nodes", 8);
    if (version_ >= 4.1) words_.integer("the least node", 8), words_.integer("the greatest node", 8);
    std::vector<std::int64_t> tags;
    for (int b = 0; b < blocks; ++b) {
      words_.integer("an entity"), words_.integer("an entity");
      if (words_.integer("0 or 1") != 0)
        words_.fail("parametric nodes are not read (in Gmsh: Mesh.SaveParametric = 0)");
      const int n = words_.count("a number of nodes", 8);
      if (version_ >= 4.1) {
        tags.clear();
        for (int i = 0; i < n; ++i) tags.push_back(words_.integer("a node", 8));
        for (const auto tag : tags) add_node(tag);
      } else {
        for (int i = 0; i < n; ++i) add_node(words_.integer("a node"));
      }
    }
  }

  int node_of_element() {
    const auto tag = words_.integer("a node", version_ >= 4.0 ? 8 : 4);
    const auto found = index_.find(tag);
    if (found == index_.end()) words_.fail("an element names node {}, which is not listed", tag);
    return found->second;
  }

  /// One element, whose nodes come next.
  void element(int type, const std::vector<int>& groups) {
    if (type == 15) {
      const int v = node_of_element();
      for (const int g : groups) points_[g].push_back(v);
    } else if (type == 1) {
      const int a = node_of_element(), b = node_of_element();
      for (const int g : groups) lines_[g].push_back({a, b});
    } else if (type == 2) {
      const std::array<int, 3> t{node_of_element(), node_of_element(), node_of_element()};
      // Format 2 repeats an element for each of its groups.
      std::array<int, 3> sorted = t;
      std::sort(sorted.begin(), sorted.end());
      const auto [place, isnew] = known_.try_emplace(sorted, static_cast<int>(triangles_.size()));
      if (isnew) triangles_.push_back(t);
      for (const int g : groups) surfaces_[g].push_back(place->second);
    } else {
      words_.fail("elements of type {} are not read; expected triangles with three nodes{}", type,
                  type == 3                              ? " (in Gmsh: no recombination)"
                  : type == 8 || type == 9 || type == 20 ? " (in Gmsh: Mesh.ElementOrder = 1)"
                                                         : "");
    }
  }

  void plain_elements() {
    const int n = words_.count("a number of elements");
    words_.binary(binary_);
    int type = 0, tags = 0;
    for (int i = 0, left = 0; i < n; ++i, --left) {
      // Binary files say type and tags once for some elements that follow.
      if (binary_ && left == 0) {
        type = words_.count("a type"), left = words_.count("a number of elements");
        tags = words_.count("a number of tags");
        if (left == 0) words_.fail("a block of no elements");
      }
      words_.integer("an element");
      if (!binary_) type = words_.count("a type"), tags = words_.count("a number of tags");
      std::vector<int> groups;
      for (int k = 0; k < tags; ++k) {
        const auto tag = words_.integer("a tag");
        if (k == 0 && tag != 0) groups.push_back(static_cast<int>(std::abs(tag)));
      }
      element(type, groups);
    }
  }

  void element_blocks() {
    words_.binary(binary_);
    const int blocks = words_.count("a number of blocks", 8);
    words_.count("a number of elements", 8);
    if (version_ >= 4.1) words_.integer("the least element", 8), words_.integer("the greatest element", 8);
    for (int b = 0; b < blocks; ++b) {
      auto dimension = words_.integer("a dimension"), entity = words_.integer("an entity");
      if (version_ < 4.1) std::swap(dimension, entity);
      const int type = words_.count("a type"), n = words_.count("a number of elements", 8);
      const auto found = groups_.find({static_cast<int>(dimension), entity});
      const std::vector<int> groups = found == groups_.end() ? std::vector<int>() : found->second;
      for (int i = 0; i < n; ++i) {
        words_.integer("an element", 8);
        element(type, groups);
      }
    }
  }

  std::string name_of(int dimension, int group) const {
    const auto found = names_.find({dimension, group});
    return found == names_.end() ? "physical " + std::to_string(group) : found->second;
  }

  Triangulation finish() {
    if (triangles_.empty()) input_error("{}: no triangles", words_.name());
    std::vector<char> used(vertices_.size(), 0);
    for (const auto& t : triangles_)
      for (const int v : t) used[static_cast<std::size_t>(v)] = 1;
    if (const auto isolated = std::count(used.begin(), used.end(), char{0}); isolated > 0) {
      const auto first =
          static_cast<std::size_t>(std::find(used.begin(), used.end(), char{0}) - used.begin());
      input_error(
          "{}: {} of {} nodes belong to no triangle, the first is node {} at ({}, {}); leave them out of the "
          "file",
          words_.name(), isolated, used.size(), tags_[first], vertices_[first].x(), vertices_[first].y());
    }
    const auto [low, high] = std::minmax_element(heights_.begin(), heights_.end());
    Vec<2> extent = vertices_.front(), lower = extent;
    for (const auto& x : vertices_) extent = extent.cwiseMax(x), lower = lower.cwiseMin(x);
    if (scale_ * (*high - *low) > 1e-9 * (extent - lower).norm())
      input_error("{}: the nodes lie at heights z from {} to {}; expected a plane", words_.name(), *low,
                  *high);
    Triangulation result(std::move(vertices_), std::move(triangles_), words_.name());
    for (const auto& [g, list] : lines_)
      for (const auto& [a, b] : list)
        if (result.find_edge(a, b) < 0)
          input_error("{}: boundary '{}': no edge of a triangle joins nodes {} and {}", words_.name(),
                      name_of(1, g), tags_[static_cast<std::size_t>(a)], tags_[static_cast<std::size_t>(b)]);
    try {
      for (const auto& [g, list] : lines_) result.add_part(name_of(1, g), list);
      for (const auto& [g, list] : points_) result.add_part(name_of(0, g), {}, list);
      for (const auto& [g, list] : surfaces_) result.add_part(name_of(2, g), {}, {}, list);
    } catch (const InputError& error) {
      input_error("{}: {}", words_.name(), error.what());
    }
    return result;
  }

  Words words_;
  double scale_, version_ = 0.0;
  bool binary_ = false;
  std::map<Group, std::string> names_;
  std::map<std::pair<int, std::int64_t>, std::vector<int>> groups_;  // of the entities of format 4
  std::unordered_map<std::int64_t, int> index_;
  std::vector<std::int64_t> tags_;
  std::vector<double> heights_;
  std::vector<Vec<2>> vertices_;
  std::vector<std::array<int, 3>> triangles_;
  std::map<std::array<int, 3>, int> known_;
  std::map<int, std::vector<int>> points_, surfaces_;
  std::map<int, std::vector<std::array<int, 2>>> lines_;
};

}  // namespace

Triangulation read_gmsh(const std::filesystem::path& file, double scale) {
  return Reader(file, scale).read();
}

}  // namespace wisp
