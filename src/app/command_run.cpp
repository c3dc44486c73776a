// wisp run CASE.toml [--out DIR] [--set key=value]... [--ranks N]
#include <CLI/CLI.hpp>
#include <memory>

#include "app/launch.h"
#include "app/program.h"

namespace wisp {

void add_run(CLI::App& app, const Engine& engine, int* status) {
  struct Options {
    std::string file, out;
    std::vector<std::string> overrides;
    int ranks = 0;
  };
  auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("run", "run a case");
  command->add_option("case", o->file, "case file (TOML)")->required()->type_name("CASE.toml");
  command->add_option("--out", o->out, "folder for the results")->type_name("DIR");
  command->add_option("--set", o->overrides, "another value for a key, such as body[0].material.density=1000")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
  command->add_option("--ranks", o->ranks, "run on this many processor cores")->check(CLI::Range(1, 1000000));
  command->callback([o, &engine, status] {
    const Case c = read_case(o->file, o->overrides);  // before anything is started or written
    const std::filesystem::path folder =
        o->out.empty() ? default_output_folder(c) : std::filesystem::path(o->out);
    if (o->ranks > 1) {
      std::vector<std::string> arguments{"run", o->file, "--out", folder.string()};
      for (const auto& assignment : o->overrides) arguments.insert(arguments.end(), {"--set", assignment});
      launch_ranks(o->ranks, arguments);
    }
    *status = with_session([&] {
      engine.run(c, folder);
      return 0;
    });
  });
}

}  // namespace wisp
