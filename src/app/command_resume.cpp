// wisp resume DIR [--ranks N]
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
    int ranks = 0;
  };
  auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("resume", "go on with a run from its newest checkpoint");
  command->add_option("folder", o->folder, "folder with the results")->required()->type_name("DIR");
  command->add_option("--ranks", o->ranks, "number of ranks (default: as many as wrote the checkpoint)")
      ->check(CLI::Range(1, 1000000));
  command->callback([o, &engine, status] {
    if (!std::filesystem::is_directory(o->folder)) input_error("{}: there is no such folder", o->folder);
    const auto sets = checkpoint_sets(o->folder);
    if (sets.empty()) input_error("{}: holds no checkpoint", o->folder);
    const int ranks = o->ranks > 0 ? o->ranks : sets.front().ranks;
    if (ranks > 1 && (o->ranks > 0 || !launched_by_mpirun())) launch_ranks(ranks, {"resume", o->folder});
    *status = with_session([&] {
      engine.resume(o->folder);
      return 0;
    });
  });
}

}  // namespace wisp
