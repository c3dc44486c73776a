// Bad input, each with the message that it must give.
#include <gtest/gtest.h>

#include <limits>

#include "geometry/region.h"
#include "scratch.h"

namespace wisp {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

struct TextCase {
  const char* text;
  const char* message;
};

TEST(Malformed, PolygonFiles) {
  const TextCase cases[] = {
      {"", "bad.csv: the file is empty"},
      {" \n\n\t\r\n", "bad.csv: the file is empty"},
      {"x,y\n", "bad.csv: no vertices, expected rows x,y"},
      {"# only a comment\n", "bad.csv: no vertices, expected rows x,y"},
      {"0,0\n1,0\n", "the outer ring (line 1) has 2 different vertices, expected at least 3"},
      {"x,y\n0,0\n1,0\n0,0\n", "the outer ring (line 2) has 2 different vertices, expected at least 3"},
      {"3,3\n3,3\n3,3\n", "the outer ring (line 1) has 1 different vertex, expected at least 3"},
      {"0,0\n1\n1,1\n", "bad.csv:2: expected 2 cells x,y, found 1"},
      {"0,0\n1,0,0\n1,1\n", "bad.csv:2: expected 2 cells x,y, found 3"},
      {"0,0\n1,0\n1,one\n", "bad.csv:3:3: column 'y': expected a number, found 'one'"},
      {"0,0\n1,0\n,1\n", "bad.csv:3:1: column 'x' is empty, expected a number"},
      {"0,0\n1,0\n  nan,1\n", "bad.csv:3:3: column 'x': expected a finite number, found 'nan'"},
      {"0,0\n1,-inf\n1,1\n", "bad.csv:2:3: column 'y': expected a finite number, found '-inf'"},
      {"0,0\n1,1e999\n1,1\n", "bad.csv:2:3: column 'y': 1e999 is out of the range of double precision"},
      {"0,0\n1.0.0,1\n1,1\n", "bad.csv:2:1: column 'x': expected a number, found '1.0.0'"},
      {"0,0\n1,0 5\n1,1\n", "found '0 5' (cells are separated by commas)"},
      {"0;0\n1;0\n1;1\n", "bad.csv:1: expected 2 cells x,y, found 1"},
      {"0,0\nx,y\n1,1\n", "bad.csv:2:1: column 'x': expected a number, found 'x'"},
      {"0,0\n+-1,0\n1,1\n", "bad.csv:2:1: column 'x': expected a number, found '+-1'"},
      {"0,0\n0x10,0\n1,1\n", "bad.csv:2:1: column 'x': expected a number, found '0x10'"},
      {"0,0\n1,\x01\x02\n1,1\n", "bad.csv:2:3: column 'y': expected a number, found '\?\?'"},
      {"0,0\n1,1\n1,0\n0,1\n",
       "the outer ring (line 1) crosses or touches itself near (0.5, 0.5), where edge (0, 1)-(1, 0) of the "
       "outer ring (line 1) meets edge (1, 1)-(0, 0) of"},
      {"0,0\n1,0\n2,0\n", "the outer ring (line 1) has"},
      {"0,0\n2,0\n2,1\n2,3\n2,1\n0,1\n", "the outer ring (line 1) has a spike"},
      {"0,0\n1,0\n1,1\n0,1\n\n2,2\n3,2\n3,3\n", "the polygon has a hole outside the outer ring"},
      {"0,0\n4,0\n4,4\n0,4\n\n1,1\n3,1\n3,3\n1,3\n\n1.5,1.5\n2,1.5\n2,2\n",
       "the polygon has a hole inside another hole"},
      {"0,0\n4,0\n4,4\n0,4\n\n3,1\n5,1\n5,2\n3,2\n", "the polygon has edges that cross or touch near (4, "},
      {"0,0\n4,0\n4,4\n0,4\n\n1,1\n3,3\n3,1\n1,3\n",
       "the hole 1 (line 6) crosses or touches itself near (2, 2)"},
      {"0,0\n4,0\n4,4\n0,4\n\n1,1\n2,1\n", "the hole 1 (line 6) has 2 different vertices"},
  };
  const Scratch scratch;
  for (const auto& [text, message] : cases) {
    scratch.write("bad.csv", text);
    EXPECT_TRUE(
        says(message_of([&] { region<2>(AnyShape(Polygon{.file = "bad.csv"}), scratch.folder()); }), message))
        << "file: " << text;
  }
}

TEST(Malformed, PolygonKeys) {
  const struct {
    Polygon polygon;
    const char* message;
  } cases[] = {
      {{}, "polygon: expected either 'vertices' or 'file', found neither"},
      {{.vertices = {{0, 0}, {1, 0}, {1, 1}}, .file = "a.csv"},
       "expected either 'vertices' or 'file', found both"},
      {{.vertices = {{0, 0}, {1, 0}}},
       "polygon: the outer ring has 2 different vertices, expected at least 3"},
      {{.vertices = {{0, 0}, {1, 0, 0}, {1, 1}}}, "polygon: vertex 2 has 3 numbers, expected [x, y]"},
      {{.vertices = {{0, 0}, {1}, {1, 1}}}, "polygon: vertex 2 has 1 number, expected [x, y]"},
      {{.vertices = {{0, 0}, {nan, 0}, {1, 1}}},
       "polygon: vertex 2 of the outer ring is (nan, 0), expected finite numbers"},
      {{.vertices = {{0, 0}, {1, 0}, {1, 1}}, .scale = 0.0},
       "polygon: 'scale' is 0, expected a positive finite number"},
      {{.vertices = {{0, 0}, {1, 0}, {1, 1}}, .offset = {1, 2, 3}},
       "polygon: 'offset' has 3 values, expected 2"},
      {{.vertices = {{0, 0}, {1, 0}, {1, 1}}, .offset = {1, infinity}}, "polygon: 'offset' is not finite"},
      {{.vertices = {{0, 0}, {2, 0}, {0, 1}, {2, 1}}},
       "polygon: the outer ring crosses or touches itself near (1, 0.5)"},
      {{.file = "no-such-file.csv"}, "no-such-file.csv: no such file"},
      {{.file = "."}, "expected a CSV file, found a folder"},
  };
  const Scratch scratch;
  for (const auto& [polygon, message] : cases)
    EXPECT_TRUE(says(message_of([&] { region<2>(AnyShape(polygon), scratch.folder()); }), message));
  EXPECT_TRUE(says(message_of([&] {
                     region<3>(AnyShape(Polygon{.vertices = {{0, 0}, {1, 0}, {1, 1}}}));
                   }),
                   "polygon: a shape for 2D, but the case is 3D"));
}

TEST(Malformed, BoxesAndBalls) {
  const struct {
    AnyShape shape;
    const char* message;
  } cases[] = {
      {Box{{0, 0, 0}, {1, 1}}, "box: 'lower' has 3 values, expected 2 in 2D"},
      {Box{{0, 0}, {1}}, "box: 'upper' has 1 value, expected 2 in 2D"},
      {Box{{0, nan}, {1, 1}}, "box: 'lower' holds nan, expected finite numbers"},
      {Box{{0, 0}, {1, infinity}}, "box: 'upper' holds inf, expected finite numbers"},
      {Box{{0, 1}, {1, 1}}, "box: 'lower' is 1 and 'upper' is 1 in direction y, expected lower < upper"},
      {Box{{2, 0}, {1, 1}}, "box: 'lower' is 2 and 'upper' is 1 in direction x, expected lower < upper"},
      {Ball{{}, 1.0}, "ball: 'centre' has 0 values, expected 2 in 2D"},
      {Ball{{0, infinity}, 1.0}, "ball: 'centre' holds inf, expected finite numbers"},
      {Ball{{0, 0}, 0.0}, "ball: 'radius' is 0, expected a positive finite number"},
      {Ball{{0, 0}, nan}, "ball: 'radius' is nan, expected a positive finite number"},
      {PointFile{"a.csv"}, "points: a list of points has no inside"},
  };
  for (const auto& [shape, message] : cases)
    EXPECT_TRUE(says(message_of([&] { region<2>(shape); }), message));
}

TEST(Malformed, PointFiles) {
  const TextCase cases[] = {
      {"", "bad.csv: the file is empty"},
      {"# nothing\n", "bad.csv: no header, expected x, y, volume, vx, vy, lx, ly"},
      {"x,y,volume\n", "bad.csv: a header but no points"},
      {"x,y\n0,0\n", "bad.csv:1: the required column 'volume' is missing"},
      {"x,volume\n0,1\n", "bad.csv:1: the required column 'y' is missing"},
      {"x,y,volume,x\n0,0,1,0\n", "bad.csv:1:12: column 'x' appears twice"},
      {"x,y,volume,mass\n0,0,1,1\n",
       "bad.csv:1:12: unknown column 'mass', expected x, y, volume, vx, vy, lx, ly"},
      {"x,y,z,volume\n0,0,0,1\n", "bad.csv:1:5: column 'z' has no meaning in 2D"},
      {"X,y,volume\n0,0,1\n", "bad.csv:1:1: unknown column 'X'"},
      {"x,y,volume,\n0,0,1,\n", "bad.csv:1:12: the header has a column without a name"},
      {"x,y,volume,vy\n0,0,1,1\n", "bad.csv:1: column 'vx' is missing: give vx, vy or none of them"},
      {"x,y,lx,volume\n0,0,1,1\n", "bad.csv:1: column 'ly' is missing: give lx, ly or none of them"},
      {"0,0,1\n0,1,1\n", "bad.csv:1:1: unknown column '0'"},
      {"x,y,volume\n0,0,1\n0,1\n", "bad.csv:3: found 2 cells, but the header has 3 columns"},
      {"x,y,volume\n0,0,1,\n", "bad.csv:2: found 4 cells, but the header has 3 columns"},
      {"x,y,volume\n0,0,0\n", "bad.csv:2:5: column 'volume': 0 is not positive"},
      {"x,y,volume\n\n# note\n0,0,-1e-3\n", "bad.csv:4:5: column 'volume': -1e-3 is not positive"},
      {"x,y,volume\n0,zero,1\n", "bad.csv:2:3: column 'y': expected a number, found 'zero'"},
      {"x,y,volume\n0,0,nan\n", "bad.csv:2:5: column 'volume': expected a finite number, found 'nan'"},
      {"x,y,volume\n\"0\",0,1\n", "bad.csv:2:1: column 'x': expected a number, found '\"0\"'"},
      {"x,y,volume,lx,ly\n0,0,1,.5,-.5\n", "bad.csv:2:10: column 'ly': -.5 is negative"},
      {"x,y,volume\n0,0,1 m2\n", "bad.csv:2:5: column 'volume': expected a number, found '1 m2'"},
      {"x,y,volume\n0,0,aaaaaaaaaabbbbbbbbbbccccccccccddddddddddeeee\n",
       "found 'aaaaaaaaaabbbbbbbbbbccccccccccdddddddddd...'"},
  };
  const Scratch scratch;
  for (const auto& [text, message] : cases) {
    scratch.write("bad.csv", text);
    EXPECT_TRUE(says(message_of([&] { read_points<2>({"bad.csv"}, scratch.folder()); }), message))
        << "file: " << text;
  }
  scratch.write("bad.csv", "x,y,volume\n0,0,1\n");
  EXPECT_TRUE(says(message_of([&] { read_points<3>({"bad.csv"}, scratch.folder()); }),
                   "bad.csv:1: the required column 'z' is missing"));
  EXPECT_TRUE(
      says(message_of([&] { read_points<2>({"none.csv"}, scratch.folder()); }), "none.csv: no such file"));
  EXPECT_TRUE(says(message_of([&] { read_points<2>({}); }), "points: 'file' is empty"));
}

}  // namespace
}  // namespace wisp
