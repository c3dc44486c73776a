// Gmsh files: both formats, names, and everything that can be wrong with them.
#include "grid/gmsh.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include <fstream>

#include "core/error.h"
#include "grid/triangulation_samples.h"

namespace wisp {
namespace {

using namespace grid_test;

/// A file that vanishes at the end of the test.
class File {
 public:
  explicit File(const std::string& text) {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() / fmt::format("wisp-gmsh-{}-{}.msh", ::getpid(), count++);
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~File() { std::filesystem::remove(path_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string message(const std::string& text) {
  const File file(text);
  try {
    read_gmsh(file.path());
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no error)";
}

const std::string names =
    "$PhysicalNames\n3\n1 7 \"base line\"\n2 8 \"soil\"\n0 9 \"pin\"\n$EndPhysicalNames\n";

// A unit square of two triangles, nodes numbered as Gmsh may: not from 1, not in order.
const std::string version2 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names +
    "$Nodes\n4\n10 0 0 0\n3 1 0 0\n12 1 1 0\n5 0 1 0\n$EndNodes\n"
    "$Elements\n5\n1 15 2 9 1 10\n2 1 2 7 1 10 3\n3 2 2 8 1 10 3 12\n4 2 2 8 1 10 12 5\n"
    "5 2 2 11 1 10 12 5\n$EndElements\n";
const std::string version41 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + names +
    "$Entities\n1 1 1 0\n1 0 0 0 1 9\n1 0 0 0 1 0 0 1 7 2 1 -2\n1 0 0 0 1 1 0 1 8 1 1\n$EndEntities\n"
    "$Nodes\n2 4 3 12\n1 1 0 2\n10\n3\n0 0 0\n1 0 0\n2 1 0 2\n12\n5\n1 1 0\n0 1 0\n$EndNodes\n"
    "$Elements\n3 4 1 4\n0 1 15 1\n1 10\n1 1 1 1\n2 10 3\n2 1 2 2\n3 10 3 12\n4 10 12 5\n$EndElements\n"
    "$Periodic\nwhatever 1 2\n$EndPeriodic\n";
const std::string version40 =
    "$MeshFormat\n4 0 8\n$EndMeshFormat\n" + names +
    "$Entities\n1 1 1 0\n1 0 0 0 0 0 0 1 9\n1 0 0 0 1 0 0 1 7 2 1 -2\n1 0 0 0 1 1 0 1 8 1 1\n$EndEntities\n"
    "$Nodes\n2 4\n1 1 0 2\n10 0 0 0\n3 1 0 0\n1 2 0 2\n12 1 1 0\n5 0 1 0\n$EndNodes\n"
    "$Elements\n3 4\n1 0 15 1\n1 10\n1 1 1 1\n2 10 3\n1 2 2 2\n3 10 3 12\n4 10 12 5\n$EndElements\n";

TEST(Gmsh, ReadsFormats2And4) {
  for (const auto& text : {version2, version40, version41}) {
    const File file(text);
    const auto mesh = read_gmsh(file.path(), 2.0);
    EXPECT_EQ(mesh.n_triangles(), 2);
    EXPECT_EQ(mesh.n_vertices(), 4);
    EXPECT_DOUBLE_EQ(mesh.total_area(), 4.0);
    ASSERT_EQ(mesh.part("base line").edges.size(), 1U);
    for (const int v : mesh.part("base line").vertices) EXPECT_EQ(mesh.vertex(v).y(), 0.0);
    EXPECT_EQ(mesh.part("soil").triangles.size(), 2U);
    ASSERT_EQ(mesh.part("pin").vertices.size(), 1U);
    EXPECT_EQ(mesh.vertex(mesh.part("pin").vertices[0]), Vec<2>(0, 0));
  }
  const File file(version2);  // the triangle that is listed twice, with another group
  EXPECT_EQ(read_gmsh(file.path()).part("physical 11").triangles, std::vector<int>{1});
}

/// Bytes of numbers.
class Bytes {
 public:
  Bytes& text(const std::string& t) { return bytes_ += t, *this; }
  Bytes& ints(std::initializer_list<std::int32_t> list) { return put(list); }
  Bytes& sizes(std::initializer_list<std::uint64_t> list) { return put(list); }
  Bytes& reals(std::initializer_list<double> list) { return put(list); }
  const std::string& str() const { return bytes_; }

 private:
  template <class T>
  Bytes& put(std::initializer_list<T> list) {
    for (const T value : list) bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    return *this;
  }
  std::string bytes_;
};

/// The square of `version2` in binary, as the Gmsh manual lays it out.
std::string binary2() {
  Bytes b;
  b.text("$MeshFormat\n2.2 1 8\n").ints({1}).text("\n$EndMeshFormat\n" + names + "$Nodes\n4\n");
  b.ints({10}).reals({0, 0, 0}).ints({3}).reals({1, 0, 0}).ints({12}).reals({1, 1, 0}).ints({5}).reals(
      {0, 1, 0});
  b.text("\n$EndNodes\n$Elements\n5\n").ints({15, 1, 2, 1, 9, 1, 10}).ints({1, 1, 2, 2, 7, 1, 10, 3});
  b.ints({2, 3, 2, 3, 8, 1, 10, 3, 12, 4, 8, 1, 10, 12, 5, 5, 11, 1, 10, 12, 5});
  return b.text("\n$EndElements\n").str();
}

std::string binary41() {
  Bytes b;
  b.text("$MeshFormat\n4.1 1 8\n").ints({1}).text("\n$EndMeshFormat\n" + names + "$Entities\n");
  b.sizes({1, 1, 1, 0}).ints({1}).reals({0, 0, 0}).sizes({1}).ints({9});
  b.ints({1}).reals({0, 0, 0, 1, 0, 0}).sizes({1}).ints({7}).sizes({2}).ints({1, -2});
  b.ints({1}).reals({0, 0, 0, 1, 1, 0}).sizes({1}).ints({8}).sizes({1}).ints({1});
  b.text("\n$EndEntities\n$Nodes\n").sizes({2, 4, 3, 12});
  b.ints({1, 1, 0}).sizes({2, 10, 3}).reals({0, 0, 0, 1, 0, 0});
  b.ints({2, 1, 0}).sizes({2, 12, 5}).reals({1, 1, 0, 0, 1, 0});
  b.text("\n$EndNodes\n$Elements\n").sizes({3, 4, 1, 4}).ints({0, 1, 15}).sizes({1, 1, 10});
  b.ints({1, 1, 1}).sizes({1, 2, 10, 3}).ints({2, 1, 2}).sizes({2, 3, 10, 3, 12, 4, 10, 12, 5});
  return b.text("\n$EndElements\n$Periodic\n").ints({1, 2}).text("\n$EndPeriodic\n").str();
}

TEST(Gmsh, ReadsBinaryFilesLikeTheirText) {
  const File text(version2);
  const auto square = read_gmsh(text.path());
  for (const auto& bytes : {binary2(), binary41()}) {
    const File file(bytes);
    const auto mesh = read_gmsh(file.path());
    ASSERT_EQ(mesh.n_vertices(), 4);
    ASSERT_EQ(mesh.n_triangles(), 2);
    for (int v = 0; v < 4; ++v) EXPECT_EQ(mesh.vertex(v), square.vertex(v));
    for (int t = 0; t < 2; ++t) EXPECT_EQ(mesh.triangle(t), square.triangle(t));
    EXPECT_EQ(mesh.part("base line").edges, square.part("base line").edges);
    EXPECT_EQ(mesh.part("pin").vertices, square.part("pin").vertices);
    EXPECT_EQ(mesh.part("soil").triangles.size(), 2U);
    for (std::size_t length = 1; length < bytes.find("$EndElements"); length += 7) {
      const std::string said = message(bytes.substr(0, length));
      EXPECT_NE(said, "(no error)") << length;
      EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    }
  }
}

TEST(Gmsh, ReadsFilesThatGmshItselfHasWritten) {
  // strip.geo, meshed and saved by Gmsh 4.8 in both formats, as text and in binary.
  const std::filesystem::path folder = std::filesystem::path(WISP_SOURCE_DIR) / "tests/grid/gmsh";
  const auto first = read_gmsh(folder / "strip-msh2-ascii.msh");
  EXPECT_NEAR(first.total_area(), 2.0, 1e-12);
  EXPECT_GT(first.n_triangles(), 10);
  for (const char* name :
       {"strip-msh2-ascii", "strip-msh2-binary", "strip-msh41-ascii", "strip-msh41-binary"}) {
    const auto mesh = read_gmsh(folder / (std::string(name) + ".msh"));
    ASSERT_EQ(mesh.n_vertices(), first.n_vertices()) << name;
    ASSERT_EQ(mesh.n_triangles(), first.n_triangles()) << name;
    EXPECT_NEAR(mesh.total_area(), 2.0, 1e-12) << name;
    const auto length = [&](const char* part) {
      double sum = 0.0;
      for (const int e : mesh.part(part).edges)
        sum += (mesh.vertex(mesh.edge(e).vertex[1]) - mesh.vertex(mesh.edge(e).vertex[0])).norm();
      return sum;
    };
    EXPECT_NEAR(length("base line"), 2.0, 1e-12) << name;
    EXPECT_NEAR(length("right"), 1.0, 1e-12) << name;
    EXPECT_NEAR(length("rest"), 3.0, 1e-12) << name;
    for (const int v : mesh.part("base line").vertices) EXPECT_EQ(mesh.vertex(v).y(), 0.0) << name;
    EXPECT_EQ(static_cast<int>(mesh.part("soil").triangles.size()), mesh.n_triangles()) << name;
    ASSERT_EQ(mesh.part("pin").vertices.size(), 1U) << name;
    EXPECT_EQ(mesh.vertex(mesh.part("pin").vertices[0]), Vec<2>(0, 0)) << name;
  }
}

/// Any triangulation, written in format 2.2 and 4.1.
std::string written(const Triangulation& mesh, bool four) {
  std::string text = four ? "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n"
                          : "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n";
  const int n = mesh.n_vertices(), m = mesh.n_triangles();
  text += four ? fmt::format("1 {} 1 {}\n2 1 0 {}\n", n, n, n) : fmt::format("{}\n", n);
  for (int v = 0; four && v < n; ++v) text += fmt::format("{}\n", v + 1);
  for (int v = 0; v < n; ++v)
    text += (four ? std::string() : fmt::format("{} ", v + 1)) +
            fmt::format("{} {} 0\n", mesh.vertex(v).x(), mesh.vertex(v).y());
  text += "$EndNodes\n$Elements\n";
  text += four ? fmt::format("1 {} 1 {}\n2 1 2 {}\n", m, m, m) : fmt::format("{}\n", m);
  for (int t = 0; t < m; ++t) {
    const auto& v = mesh.triangle(t);
    text += fmt::format("{} {}{} {} {}\n", t + 1, four ? "" : "2 0 ", v[0] + 1, v[1] + 1, v[2] + 1);
  }
  return text + "$EndElements\n";
}

RC_GTEST_PROP(Gmsh, WhatIsWrittenIsRead, (bool four)) {
  const auto mesh = random_square(*rc::gen::arbitrary<unsigned>(), 20);
  const File file(written(mesh, four));
  const auto copy = read_gmsh(file.path());
  RC_ASSERT(copy.n_triangles() == mesh.n_triangles());
  for (int v = 0; v < mesh.n_vertices(); ++v) RC_ASSERT(copy.vertex(v) == mesh.vertex(v));
  for (int t = 0; t < mesh.n_triangles(); ++t) RC_ASSERT(copy.triangle(t) == mesh.triangle(t));
}

RC_GTEST_PROP(Gmsh, FilesCutShortAreInputErrors, (bool four)) {
  const std::string text = written(random_square(3, 6), four);
  const auto length = *rc::gen::inRange<std::size_t>(0, text.size() - 2);
  const std::string said = message(text.substr(0, length));
  RC_ASSERT(said != "(no error)");
  RC_ASSERT(said.find('\n') == std::string::npos);
}

TEST(Gmsh, WrongFilesAreInputErrors) {
  const auto with = [](std::string text, const std::string& old, const std::string& replacement) {
    text.replace(text.find(old), old.size(), replacement);
    return message(text);
  };
  const auto says = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos && text.find('\n') == std::string::npos ? std::string("yes")
                                                                                        : text;
  };
  EXPECT_EQ(says(message("solid\n"), "does not start with $MeshFormat"), "yes");
  EXPECT_EQ(says(with(version2, "2.2 0 8", "3.0 0 8"), ":2: Gmsh format 3 is not known"), "yes");
  EXPECT_EQ(says(with(version2, "2.2 0 8", "2.2 1 8"), "other order of bytes"), "yes");
  EXPECT_EQ(says(with(version40, "4 0 8", "4 1 8"), "binary files of format 4.0 are not read"), "yes");
  EXPECT_EQ(says(with(version2, "3 1 0 0\n", "3 1 x 0\n"), ":13: expected y, found 'x'"), "yes");
  EXPECT_EQ(says(with(version2, "3 1 0 0\n", "10 1 0 0\n"), "node 10 is listed twice"), "yes");
  EXPECT_EQ(says(with(version2, "3 1 0 0\n", "3 nan 0 0\n"), "not finite"), "yes");
  EXPECT_EQ(says(with(version2, "3 1 0 0\n", "3 1 0 1\n"), "expected a plane"), "yes");
  EXPECT_EQ(says(with(version2, "10 3 12", "10 4 12"), "names node 4, which is not listed"), "yes");
  EXPECT_EQ(says(with(version2, "3 2 2 8 1 10 3 12", "3 9 2 8 1 10 3 12"), "Mesh.ElementOrder = 1"), "yes");
  EXPECT_EQ(says(with(version2, "3 2 2 8 1 10 3 12", "3 2 2 8 1 10 12 3"), "1 of 2 triangles are inverted"),
            "yes");
  EXPECT_EQ(says(with(version2, "4\n10 0 0 0", "5\n99 5 5 0\n10 0 0 0"), "the first is node 99 at (5, 5)"),
            "yes");
  EXPECT_EQ(
      says(with(version2, "2 1 2 7 1 10 3", "2 1 2 7 1 3 5"), "no edge of a triangle joins nodes 3 and 5"),
      "yes");
  EXPECT_EQ(says(with(version2, "$Nodes", "$Knots"), "the file ends before $EndKnots: it was cut short"),
            "yes");
  EXPECT_THROW(read_gmsh("/no/such/file.msh"), InputError);
}

}  // namespace
}  // namespace wisp
