// wisp resume DIR [--set key=value]... [--ranks N]
#include <CLI/CLI.hpp>
#include <memory>

#include "app/launch.h"
#include "app/program.h"
#include "core/error.h"
#include "io/checkpoint.h"

namespace wisp {

void add_resume(CLI::App& app, const Engine& engine, int* status) {
  struct Options {
    std::string folder;
    std::vector<std::string> changes;
    int ranks = 0;
  };
  auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("resume", "go on with a run from its newest checkpoint");
  command->add_option("folder", o->folder, "folder with the results")->required()->type_name("DIR");
  command
      ->add_option(
          "--set", o->changes,
          "another value from here on for a key of stage, solver or stabilisation, or for grid.leaving")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
  command->add_option("--ranks", o->ranks, "number of ranks (default: as many as wrote the checkpoint)")
      ->check(CLI::Range(1, 1000000));
  command->callback([o, &engine, status] {
    if (!std::filesystem::is_directory(o->folder)) input_error("{}: there is no such folder", o->folder);
    const auto sets = checkpoint_sets(o->folder);
    if (sets.empty()) input_error("{}: holds no checkpoint", o->folder);
    const int ranks = o->ranks > 0 ? o->ranks : sets.front().ranks;
    if (ranks > 1 && (o->ranks > 0 || !launched_by_mpirun())) {
      std::vector<std::string> arguments{"resume", o->folder};
      for (const auto& change : o->changes) arguments.insert(arguments.end(), {"--set", change});
      launch_ranks(ranks, arguments);
    }
    *status = with_session([&] {
      engine.resume(o->folder, o->changes);
      return 0;
    });
  });
}

}  // namespace wisp
