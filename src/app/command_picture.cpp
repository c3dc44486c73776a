// wisp picture DIR [options of the drawing program]
#include <CLI/CLI.hpp>
#include <cstdlib>
#include <memory>

#include "app/launch.h"
#include "app/program.h"
#include "core/error.h"

namespace wisp {
namespace {

/// The folder that holds the Python package: beside an installed program, else in the source.
std::filesystem::path python_folder() {
  std::vector<std::filesystem::path> places;
  const auto bin = executable().parent_path();
  for (const char* place : {"../share/wisp/python", "../lib/wisp/python", "../python"})
    places.push_back(bin / place);
  places.emplace_back(WISP_PYTHON_FOLDER);
  for (const auto& place : places)
    if (std::filesystem::exists(place / "wisp" / "picture.py")) return place.lexically_normal();
  run_error("the Python package `wisp` with the module `picture` is not installed beside {}",
            executable().string());
}

}  // namespace

void add_picture(CLI::App& app, int* status) {
  auto folder = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("picture", "draw the results of a run (PNG)");
  command->add_option("folder", *folder, "folder with the results")->required()->type_name("DIR");
  command->allow_extras();
  command->footer("Other options are those of the drawing module; see `wisp picture DIR --options`.");
  command->callback([folder, command, status] {
    if (!std::filesystem::is_directory(*folder)) input_error("{}: there is no such folder", *folder);
    std::string path = python_folder().string();
    if (const char* given = std::getenv("PYTHONPATH"); given && *given) path += std::string(":") + given;
    setenv("PYTHONPATH", path.c_str(), 1);
    std::vector<std::string> words{WISP_PYTHON, "-m", "wisp.picture", *folder};
    for (const auto& extra : command->remaining()) words.push_back(extra == "--options" ? "--help" : extra);
    *status = 0;
    replace_process(words);
  });
}

}  // namespace wisp
