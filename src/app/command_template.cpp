// wisp template KIND...
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/program.h"

namespace wisp {

void add_template(CLI::App& app, int* status) {
  auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand(
      "template", "print a commented case to start from, such as: template quasi-static gimp 3d");
  command
      ->add_option("kind", *words,
                   "names of types (explicit, von-mises, ball), optional tables (traction), 2d or 3d")
      ->type_name("KIND")
      ->required();
  command->callback([words, status] {
    fmt::print("{}", case_template(*words));
    *status = 0;
  });
}

}  // namespace wisp
