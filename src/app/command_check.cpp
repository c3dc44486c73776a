// wisp check CASE.toml [--set key=value]...
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/program.h"
#include "grid/triangulate.h"

namespace wisp {

void add_check(CLI::App& app, int* status) {
  struct Options {
    std::string file;
    std::vector<std::string> overrides;
  };
  auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("check", "check a case without running it");
  command->add_option("case", o->file, "case file (TOML)")->required()->type_name("CASE.toml");
  command->add_option("--set", o->overrides, "another value for a key")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
  command->callback([o, status] {
    const Case c = read_case(o->file, o->overrides);
    std::string stages;
    for (const auto& stage : c.stages)
      std::visit(
          [&](const auto& s) {
            stages += fmt::format("{}{} {} s", stages.empty() ? "" : ", ", s.name, s.duration);
          },
          stage);
    fmt::print("{}: valid. {} dimensions, {} {}, {}\n", o->file, c.dimension, c.bodies.size(),
               c.bodies.size() == 1 ? "body" : "bodies", stages);
    if (const auto triangles = triangulation_of(c.grid)) {
      const Triangulation mesh = make_triangulation(*triangles, c.file.folder);
      fmt::print("{}\n", quality_line(mesh));
      if (const std::string warning = sliver_warning(mesh); !warning.empty()) fmt::print("{}\n", warning);
    }
    *status = 0;
  });
}

}  // namespace wisp
