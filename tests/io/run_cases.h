// Small cases for the tests of runs.
#pragma once
#include <string>
#include <string_view>

#include "io/case.h"
#include "io/temporary_folder.h"

namespace wisp::test {

/// What a test says about its case; the rest is a soft block that falls on the floor of a box.
struct CaseText {
  std::string basis = "linear";
  std::string material = "type = \"hencky\"\ndensity = 1000.0\nyoung_modulus = 1e5\npoisson_ratio = 0.3";
  std::string stages;
  std::string more = "";  ///< other tables
  std::string leaving = "stop";
  std::string output = "frames = 2\n";
  std::string velocity = "[0.3, -0.5]";

  std::string text() const {
    return "dimension = 2\n[grid]\nlower = [0.0, 0.0]\nupper = [2.0, 2.0]\ncells = [8, 8]\nleaving = \"" +
           leaving + "\"\n[basis]\ntype = \"" + basis +
           "\"\n[[body]]\nname = \"block\"\nshape = { type = \"box\", lower = [0.25, 0.25], upper = [1.25, "
           "1.0] }\n"
           "velocity = " +
           velocity + "\n[body.material]\n" + material +
           "\n[[boundary]]\nname = \"floor\"\nnormal = \"y\"\nat = 0.25\ndirections = [\"x\", \"y\"]\n"
           "[gravity]\nacceleration = [0.0, -10.0]\n" +
           more + stages + "[output]\n" + output;
  }
  Case read() const { return read_case(CaseSource{"test.toml", ".", text(), {}}); }
};

inline constexpr std::string_view ghost = "[stabilisation]\n";

}  // namespace wisp::test
