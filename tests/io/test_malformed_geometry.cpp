// Malformed triangulations and walls, each with the one line that it must give before anything is written.
#include <gtest/gtest.h>

#include <fstream>

#include "grid/triangulate.h"
#include "io/malformed.h"
#include "io/temporary_folder.h"

namespace wisp {
namespace {

using test::Change;
using test::changed;

/// Writes the file that the case names and reads the case; the message without the folder's name.
std::string complaint(const std::string& text, const std::string& file_name, const std::string& file) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / file_name, std::ios::binary) << file;
  std::string message = test::complaint(text, folder.path());
  const std::string path = folder.path().string() + "/";
  for (auto at = message.find(path); at != std::string::npos; at = message.find(path))
    message.erase(at, path.size());
  return message;
}

// Two triangles of a unit square, with a name for the base and the soil.
const std::string mesh2 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 1 "base"
2 2 "soil"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
$EndNodes
$Elements
3
1 1 2 1 1 1 2
2 2 2 2 1 1 2 3
3 2 2 2 1 1 3 4
$EndElements
)";

const std::string mesh4 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
1 1 "base"
2 2 "soil"
$EndPhysicalNames
$Entities
0 1 1 0
1 0 0 0 1 0 0 1 1 0
1 0 0 0 1 1 0 1 2 1 1
$EndEntities
$Nodes
1 4 1 4
2 1 0 4
1
2
3
4
0 0 0
1 0 0
1 1 0
0 1 0
$EndNodes
$Elements
2 3 1 3
1 1 1 1
1 1 2
2 1 2 2
2 1 2 3
3 1 3 4
$EndElements
)";

const std::string on_triangles = R"(dimension = 2
[grid]
type = "gmsh"
file = "square.msh"
[[body]]
name = "soil"
[body.shape]
type = "box"
lower = [0.25, 0.0]
upper = [0.75, 0.5]
[body.material]
type = "linear-elastic"
density = 1000.0
young_modulus = 1e6
[[boundary]]
name = "floor"
part = "base"
directions = ["x", "y"]
[[stage]]
type = "explicit"
duration = 0.1
)";

const std::string between_walls = R"(dimension = 2
[grid]
lower = [0.0, 0.0]
upper = [4.0, 2.0]
cells = [16, 8]
[[body]]
name = "soil"
[body.shape]
type = "box"
lower = [1.0, 0.5]
upper = [2.0, 1.0]
[body.material]
type = "linear-elastic"
density = 1000.0
young_modulus = 1e6
[[boundary]]
type = "wall"
name = "slope"
kind = "roller"
[boundary.shape]
type = "polyline"
vertices = [[0.5, 0.4], [2.5, 0.4]]
solid = "left"
[[stage]]
type = "explicit"
duration = 0.1
)";

// A tetrahedron.
const std::string surface = R"(solid tetrahedron
facet normal 0 0 -1
outer loop
vertex 0 0 0
vertex 0 1 0
vertex 1 0 0
endloop
endfacet
facet normal 0 -1 0
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 0 1
endloop
endfacet
facet normal -1 0 0
outer loop
vertex 0 0 0
vertex 0 0 1
vertex 0 1 0
endloop
endfacet
facet normal 1 1 1
outer loop
vertex 1 0 0
vertex 0 1 0
vertex 0 0 1
endloop
endfacet
endsolid tetrahedron
)";

const std::string in_surface = R"(dimension = 3
[grid]
lower = [-0.25, -0.25, -0.25]
upper = [2.0, 1.25, 1.25]
cells = [9, 6, 6]
[[body]]
name = "soil"
[body.shape]
type = "box"
lower = [0.1, 0.1, 0.1]
upper = [0.2, 0.2, 0.2]
[body.material]
type = "linear-elastic"
density = 1000.0
young_modulus = 1e6
[[boundary]]
type = "wall"
name = "shell"
kind = "roller"
[boundary.shape]
type = "stl"
file = "shell.stl"
solid = "inside"
[[stage]]
type = "explicit"
duration = 0.1
)";

class MalformedMesh : public testing::TestWithParam<Change> {};
TEST_P(MalformedMesh, SaysWhatAndWhere) {
  EXPECT_EQ(complaint(on_triangles, "square.msh", changed(mesh2, GetParam())), GetParam().message);
}
const Change meshes[] = {
    // overlapping, inverted, flat
    {"3 2 2 2 1 1 3 4", "3 2 2 2 1 1 2 4",
     "case.toml:2:1: [grid] square.msh: triangles 0 and 1 overlap: both lie on the same side of the edge "
     "between vertices 0 and 1, (0, 0) to (1, 0)"},
    {"3 2 2 2 1 1 3 4", "3 2 2 2 1 1 4 3",
     "case.toml:2:1: [grid] square.msh: 1 of 2 triangles are inverted (run clockwise), the first is triangle "
     "1 (vertices 0, 3, 2) near (0.333333, 0.666667)"},
    {"4\n1 0 0 0", "5\n5 0.5 0 0\n1 0 0 0",
     "case.toml:2:1: [grid] square.msh: 1 of 5 nodes belong to no triangle, the first is node 5 at (0.5, 0); "
     "leave them out of the file"},
    {"4 0 1 0", "4 0.5 0.5 0",
     "case.toml:2:1: [grid] square.msh: triangle 1 (vertices 0, 2, 3) near (0.5, 0.5) has no area"},
    {"4 0 1 0", "4 2 0.5 0",
     "case.toml:2:1: [grid] square.msh: 1 of 2 triangles are inverted (run clockwise), the first is triangle "
     "1 (vertices 0, 2, 3) near (1, 0.5)"},
    {"4 0 1 0", "4 0 1 inf",
     "case.toml:2:1: [grid] square.msh:14: the coordinates of node 4 are not finite numbers"},
    // cut short, binary, other elements
    {"$Elements\n3", "$Elements\n4",
     "case.toml:2:1: [grid] square.msh:21: expected an element, found '$EndElements'"},
    {"2 2 2 2 1 1 2 3", "2 3 2 2 1 1 2 3 4",
     "case.toml:2:1: [grid] square.msh:19: elements of type 3 are not read; expected triangles with three "
     "nodes (in Gmsh: no recombination)"},
    {"2.2 0 8", "2.2 1 8\n\x01",
     "case.toml:2:1: [grid] square.msh:3: the numbers of this binary file have the other order of bytes"},
    {"2.2 0 8", "1 0 8",
     "case.toml:2:1: [grid] square.msh:2: Gmsh format 1 is not known; expected 2 or 4 (in Gmsh: "
     "Mesh.MshFileVersion = 4.1)"},
    {"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", "$NOD\n",
     "case.toml:2:1: [grid] square.msh: not a Gmsh file: it does not start with $MeshFormat"},
    // names
    {"1 1 \"base\"", "1 1 \"bsae\"",
     "case.toml:17:8: [boundary] part: the triangulation has no boundary 'base'; did you mean 'bsae'? "
     "(valid: bsae, soil)"},
    {"$PhysicalNames\n2\n1 1 \"base\"\n2 2 \"soil\"\n$EndPhysicalNames\n", "",
     "case.toml:17:8: [boundary] part: the triangulation has no boundary 'base'; valid: physical 1, physical "
     "2"},
    {"1 1 2 1 1 1 2", "1 15 2 1 1 1",
     "case.toml:17:8: [boundary] part: the triangulation has no boundary 'base'; valid: physical 1, soil"},
    {"1 1 2 1 1 1 2\n2", "1 1 2 1 1 2 4\n2",
     "case.toml:2:1: [grid] square.msh: boundary 'base': no edge of a triangle joins nodes 2 and 4"},
};
INSTANTIATE_TEST_SUITE_P(Case, MalformedMesh, testing::ValuesIn(meshes));

TEST(MalformedMesh, ThatIsCutShortIsSaidToBe) {
  for (const auto& whole : {mesh2, mesh4}) {
    ASSERT_EQ(complaint(on_triangles, "square.msh", whole), "(no error)");
    for (std::size_t length = 40; length + 2 < whole.size(); length += 7) {
      const std::string message = complaint(on_triangles, "square.msh", whole.substr(0, length));
      EXPECT_EQ(message.rfind("case.toml:2:1: [grid] square.msh", 0), 0u) << length << ": " << message;
      EXPECT_TRUE(message.find("cut short") != std::string::npos ||
                  message.find("no section") != std::string::npos)
          << length << ": " << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
}

class MalformedOnTriangles : public testing::TestWithParam<Change> {};
TEST_P(MalformedOnTriangles, SaysWhatAndWhere) {
  EXPECT_EQ(complaint(changed(on_triangles, GetParam()), "square.msh", mesh2), GetParam().message);
}
const Change cases_on_triangles[] = {
    {"square.msh", "sqare.msh", "case.toml:2:1: [grid] sqare.msh: no such file"},
    {"part = \"base\"", "part = \"bsae\"",
     "case.toml:17:8: [boundary] part: the triangulation has no boundary 'bsae'; did you mean 'base'? "
     "(valid: base, soil)"},
    {"part = \"base\"", "part = \"soil\"",
     "case.toml:17:8: [boundary] part: boundary 'floor': none of its edges lies between lower and upper"},
    {"part = \"base\"", "normal = \"y\"\nat = 0.3",
     "case.toml:15:1: [boundary] boundary 'floor': no edge of a triangle lies on y = 0.3"},
    {"upper = [0.75, 0.5]", "upper = [1.75, 0.5]",
     "case.toml:7:1: [body.shape] body \"soil\" reaches from (0.25, 0) to (1.75, 0.5) m, outside of the grid "
     "from (0, 0) to (1, 1) m"},
    {"type = \"box\"\nlower = [0.25, 0.0]\nupper = [0.75, 0.5]",
     "type = \"mesh\"\nfile = \"square.msh\"\nsurface = \"sand\"",
     "case.toml:7:1: [body.shape] the triangulation has no boundary 'sand'; valid: base, soil"},
    {"name = \"soil\"", "name = \"soil\"\nsampling = { method = \"random\", clip = true }",
     "case.toml:7:12: [body.sampling] points on triangles are cut with method \"cells\" or \"gauss\" only"},
    {"name = \"soil\"", "name = \"soil\"\nsampling = { clip = true, volumes = \"voronoi\" }",
     "case.toml:7:37: [body.sampling] volumes: cut points have what the cut leaves: give volumes = "
     "\"share\""},
};
INSTANTIATE_TEST_SUITE_P(Case, MalformedOnTriangles, testing::ValuesIn(cases_on_triangles));

const std::string one_triangle =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 1 \"base\"\n$EndPhysicalNames\n"
    "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 1 1 0\n$EndNodes\n"
    "$Elements\n2\n1 1 2 1 1 1 2\n2 2 2 2 1 1 2 3\n$EndElements\n";

TEST(MalformedOnTriangles, NoPartOfABodyIsLostBesideTheTriangles) {
  EXPECT_EQ(complaint(on_triangles, "square.msh", one_triangle),
            "case.toml:7:1: [body.shape] body \"soil\" reaches past the triangles of the grid, at (0.25625, "
            "0.26875) for one");
  const std::string points =
      changed(on_triangles, {"type = \"box\"\nlower = [0.25, 0.0]\nupper = [0.75, 0.5]",
                             "type = \"points\"\nfile = \"soil.csv\"", ""});
  const std::string from_grid = changed(
      points,
      {"type = \"gmsh\"\nfile = \"square.msh\"",
       "type = \"delaunay\"\noutline = { vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]] }\nspacing = 0.5",
       ""});
  EXPECT_EQ(
      complaint(changed(from_grid, {"base", "side 1", ""}), "soil.csv",
                "x,y,volume\n0.5,0.25,0.1\n0.25,0.5,0.1\n"),
      "case.toml:8:1: [body.shape] body \"soil\": 1 of its 2 points lies outside of the triangles, the first "
      "at (0.25, 0.5)");
}

TEST(MalformedOnTriangles, SliversAreWarnedOfWithTheSmallestAngle) {
  const test::TemporaryFolder folder;
  test::overwrite(folder / "thin.msh", changed(one_triangle, {"3 1 1 0", "3 1 0.05 0", ""}));
  EXPECT_EQ(sliver_warning(make_triangulation(GmshOptions{.file = "thin.msh"}, folder.path())),
            "warning: 1 triangle has an angle below 5 degrees (slivers), the smallest is 2.86 degrees near "
            "(0.666667, 0.0166667): time steps become short and solutions poor there");
  test::overwrite(folder / "thin.msh", one_triangle);
  EXPECT_EQ(sliver_warning(make_triangulation(GmshOptions{.file = "thin.msh"}, folder.path())), "");
}

class MalformedWall : public testing::TestWithParam<Change> {};
TEST_P(MalformedWall, SaysWhatAndWhere) {
  EXPECT_EQ(complaint(changed(between_walls, GetParam()), "square.msh", mesh2), GetParam().message);
}
const char* const line = "type = \"polyline\"\nvertices = [[0.5, 0.4], [2.5, 0.4]]\nsolid = \"left\"";
const Change walls[] = {
    {"solid = \"left\"", "solid = \"inside\"",
     "case.toml:20:1: [boundary.shape] polyline: solid = \"inside\" needs a closed line, but the last vertex "
     "(2.5, 0.4) is not the first (0.5, 0.4)"},
    {"solid = \"left\"", "solid = \"right\"",
     "case.toml:8:1: [body.shape] body \"soil\" lies wholly behind wall \"slope\": the body must be on its "
     "solid side"},
    {"solid = \"left\"", "solid = \"up\"",
     "case.toml:23:9: [boundary.shape] solid: expected one of \"left\", \"right\", \"inside\", \"outside\", "
     "found string \"up\""},
    {"[2.5, 0.4]]", "[2.5, 0.4], [2.0, 0.2], [2.0, 0.6]]",
     "case.toml:20:1: [boundary.shape] polyline: segments 1 and 3 cross or touch"},
    {"[2.5, 0.4]]", "[2.5, 0.4], [1.5, 0.4]]",
     "case.toml:20:1: [boundary.shape] polyline: segments 1 and 2 overlap"},
    {"[0.5, 0.4], [2.5, 0.4]", "[0.5, 0.4]",
     "case.toml:20:1: [boundary.shape] polyline: 1 vertices, expected at least 2"},
    {"[0.5, 0.4], [2.5, 0.4]", "[0.5, 0.4], [0.5, 0.4]",
     "case.toml:20:1: [boundary.shape] polyline: vertices 1 and 2 are both (0.5, 0.4): a segment without "
     "length"},
    {"[0.5, 0.4], [2.5, 0.4]", "[0.5, -0.4], [2.5, -0.4]",
     "case.toml:20:1: [boundary.shape] no part of wall \"slope\" lies in the grid, which reaches from (0, 0) "
     "to (4, 2) m"},
    {"kind = \"roller\"", "kind = \"slip\"",
     "case.toml:19:8: [boundary] kind: expected one of \"fixed\", \"roller\", \"tangential\", "
     "\"prescribed\", found string \"slip\""},
    {"kind = \"roller\"", "kind = \"fixed\"\nfriction = 0.3",
     "case.toml:20:12: [boundary] friction: only for kind = \"roller\""},
    {"type = \"polyline\"", "type = \"polylin\"",
     "case.toml:21:8: [boundary.shape] type: expected one of \"polyline\", \"circle\", \"arc\", \"polygon\", "
     "\"level-set\", \"plane\", \"stl\", found string \"polylin\"; did you mean \"polyline\"?"},
    {line, "type = \"plane\"\npoint = [0.0, 0.4]",
     "case.toml:20:1: [boundary.shape] missing key 'normal': normal that points into the body, of any "
     "length"},
    {line, "type = \"plane\"\npoint = [0.0, 0.4]\nnormal = [0.0, 0.0]",
     "case.toml:20:1: [boundary.shape] plane: 'normal' has no length"},
    {line, "type = \"plane\"\npoint = [0.0, 0.4]\nnormal = [0.0, -1.0]",
     "case.toml:8:1: [body.shape] body \"soil\" lies wholly behind wall \"slope\": the normal must point "
     "into the body"},
    {line, "type = \"plane\"\npoint = [0.0, -0.4]\nnormal = [0.0, 1.0]",
     "case.toml:20:1: [boundary.shape] no part of wall \"slope\" lies in the grid, which reaches from (0, 0) "
     "to (4, 2) m"},
    {line, "type = \"plane\"\npoint = [0.0, 9.0]\nnormal = [1.0, -1.0]",
     "case.toml:20:1: [boundary.shape] no part of wall \"slope\" lies in the grid, which reaches from (0, 0) "
     "to (4, 2) m"},
    {line, "type = \"circle\"\ncentre = [3.2, 0.7]\nradius = 0.5",
     "case.toml:8:1: [body.shape] body \"soil\" lies wholly outside of wall \"slope\", whose inside is "
     "solid"},
    {line, "type = \"circle\"\ncentre = [1.5, 0.75]\nradius = 0.6\nsolid = \"outside\"",
     "case.toml:8:1: [body.shape] body \"soil\" lies wholly within wall \"slope\", whose outside is its "
     "solid side"},
    {line, "type = \"circle\"\ncentre = [1.5, 0.75]\nradius = 20.0",
     "case.toml:20:1: [boundary.shape] no part of wall \"slope\" lies in the grid, which reaches from (0, 0) "
     "to (4, 2) m"},
    {line, "type = \"arc\"\ncentre = [1.5, 0.75]\nradius = 1.0\nfrom = 30.0\nto = 30.0",
     "case.toml:20:1: [boundary.shape] arc: 'from' is 30 and 'to' is 30 degrees, expected from < to <= from "
     "+ 360"},
    {line, "type = \"polygon\"\nvertices = [[0.0, 0.0], [4.0, 2.0], [4.0, 0.0], [0.0, 2.0]]",
     "case.toml:20:1: [boundary.shape] polygon: the outer ring crosses or touches itself near (2, 1), where "
     "edge (0, 2)-(4, 0) of the outer ring meets edge (4, 2)-(0, 0) of the outer ring"},
    {line, "type = \"stl\"\nfile = \"square.msh\"",
     "case.toml:20:1: [boundary.shape] stl: a wall for 3D, but the case is 2D; expected polyline, circle, "
     "arc, polygon, level-set or plane"},
};
INSTANTIATE_TEST_SUITE_P(Case, MalformedWall, testing::ValuesIn(walls));

class MalformedSurface : public testing::TestWithParam<Change> {};
TEST_P(MalformedSurface, SaysWhatAndWhere) {
  EXPECT_EQ(complaint(in_surface, "shell.stl", changed(surface, GetParam())), GetParam().message);
}
const Change surfaces[] = {
    {"facet normal 1 1 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n", "",
     "case.toml:20:1: [boundary.shape] shell.stl: the surface has a hole: only triangle 1 has the edge from "
     "(0, 1, 0) to (1, 0, 0)"},
    {"vertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\n", "vertex 0 1 0\nvertex 1 0 0\nvertex 0 0 1\n",
     "case.toml:20:1: [boundary.shape] shell.stl: triangles 1 and 4 are flipped against each other at the "
     "edge from (0, 1, 0) to (1, 0, 0)"},
    {"vertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid tetrahedron\n", "vertex 1 0 0\n",
     "case.toml:20:1: [boundary.shape] shell.stl:26: the file is cut short: expected \"vertex\""},
    {"vertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\n", "vertex 1 0 0\nvertex 1 0 0\nvertex 0 0 1\n",
     "case.toml:20:1: [boundary.shape] shell.stl: triangle 4 at (1, 0, 0) has no area"},
    {"vertex 1 0 0\n", "vertex 1 0\n",
     "case.toml:20:1: [boundary.shape] shell.stl:7: expected a finite number, found \"endloop\""},
    {"solid", "sold",
     "case.toml:20:1: [boundary.shape] shell.stl: 807416096 triangles take 40370804884 bytes, but the file "
     "has 385: cut short, or no STL file"},
};
INSTANTIATE_TEST_SUITE_P(Case, MalformedSurface, testing::ValuesIn(surfaces));

TEST(MalformedSurface, BodiesWhollyOutside) {
  ASSERT_EQ(complaint(in_surface, "shell.stl", surface), "(no error)");
  EXPECT_EQ(
      complaint(changed(in_surface, {"solid = \"inside\"", "solid = \"outside\"", ""}), "shell.stl", surface),
      "case.toml:8:1: [body.shape] body \"soil\" lies wholly within wall \"shell\", whose outside is its "
      "solid side");
  EXPECT_EQ(complaint(changed(in_surface, {"upper = [0.2, 0.2, 0.2]", "upper = [1.2, 1.2, 1.2]", ""}),
                      "shell.stl", surface),
            "(no error)");
  EXPECT_EQ(complaint(changed(in_surface, {"lower = [0.1, 0.1, 0.1]\nupper = [0.2, 0.2, 0.2]",
                                           "lower = [0.5, 0.5, 0.5]\nupper = [1.0, 1.0, 1.0]", ""}),
                      "shell.stl", surface),
            "case.toml:8:1: [body.shape] body \"soil\" lies wholly outside of wall \"shell\", whose inside "
            "is solid");
  EXPECT_EQ(complaint(changed(in_surface,
                              {"solid = \"inside\"", "solid = \"inside\"\noffset = [5.0, 0.0, 0.0]", ""}),
                      "shell.stl", surface),
            "case.toml:20:1: [boundary.shape] no part of wall \"shell\" lies in the grid, which reaches from "
            "(-0.25, -0.25, -0.25) to (2, 1.25, 1.25) m");
}

}  // namespace
}  // namespace wisp
