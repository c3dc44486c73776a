// A case: everything that a case file says, read strictly and checked across its tables.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "analysis/options.h"
#include "basis/options.h"
#include "boundary/list.h"
#include "boundary/options.h"
#include "core/describe.h"
#include "grid/options.h"
#include "io/describe_text.h"
#include "linear/solver.h"
#include "particle/body_options.h"
#include "stabilise/ghost_options.h"

namespace wisp {

struct TomlFile;

/// Where a case came from: enough to read it again (checkpoints keep it).
struct CaseSource {
  std::string name;                    ///< of the file, as given
  std::filesystem::path folder;        ///< relative file names in the case start here
  std::string text;                    ///< the whole file
  std::vector<std::string> overrides;  ///< --set key=value, in their order
};

struct Case {
  std::string title;
  int dimension = 2;
  AnyGridOptions grid;
  AnyBasisOptions basis;
  std::vector<BodyOptions> bodies;
  std::vector<AnyBoundaryOptions> boundaries;
  std::vector<AnyLoadOptions> loads;
  std::optional<GravityOptions> gravity;
  std::optional<GhostOptions> stabilisation;
  std::vector<AnyStage> stages;
  OutputOptions output;
  SolverOptions solver;

  CaseSource file;  ///< not a key

  static constexpr std::string_view name = "case";
  static constexpr std::string_view summary = "A whole case file: the keys before any table, and the tables";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    return std::tuple{
        key("title", &Case::title, "", "one line for people").may_be_empty(),
        key("dimension", &Case::dimension, "-", "2 (plane strain) or 3").at_least(2).at_most(3).required(),
        key("grid", &Case::grid, "", "the background grid").required(),
        key("basis", &Case::basis, "", "the grid functions"),
        key("body", &Case::bodies, "", "bodies, each of one material").required(),
        key("boundary", &Case::boundaries, "", "conditions on the motion of the grid, and walls"),
        key("load", &Case::loads, "", "forces on chosen points and on marked surfaces"),
        key("gravity", &Case::gravity, "", "body force per mass"),
        key("stabilisation", &Case::stabilisation, "", "Ghost stabilisation of the edge of the bodies"),
        key("stage", &Case::stages, "", "analyses, one after the other").required(),
        key("output", &Case::output, "", "what is written, where and how often"),
        key("solver", &Case::solver, "", "how linear systems are solved")};
  }
};

/// Reads and checks a case file, with values of the command line in the place of the file's. Throws
/// InputError, one line with file, line and column. Starts no MPI and writes nothing.
Case read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The same from what a checkpoint kept, or from any text.
Case read_case(const CaseSource& source);

/// "results/<name of the case file>" unless the case names a folder; of a file case.toml the name of its
/// folder.
std::filesystem::path default_output_folder(const Case& c);

/// The names and types of everything that a case can hold.
const TypeText& case_description();

/// A commented case; `words` select alternatives by name ("quasi-static", "ball") and turn on optional tables
/// by their key
/// ("gravity"), "3" or "3d" gives three dimensions. InputError for unknown words. The text is a valid case.
std::string case_template(const std::vector<std::string>& words);

/// Checks across tables; `context` knows where values stand in the file.
void check_case(const Case& c, const class Context& context);

}  // namespace wisp
