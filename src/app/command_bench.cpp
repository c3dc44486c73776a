// wisp bench [--points N]
#include <CLI/CLI.hpp>
#include <memory>

#include "app/bench.h"
#include "app/launch.h"
#include "app/program.h"

namespace wisp {

void add_bench(CLI::App& app, const Engine& engine, int* status) {
  auto points = std::make_shared<int>(1000000);
  CLI::App* command = app.add_subcommand("bench", "measure the speed of the engine against bare kernels");
  command->add_option("--points", *points, "points of the largest case")
      ->check(CLI::Range(1000, 100000000))
      ->capture_default_str();
  auto only = std::make_shared<std::string>();
  command->add_option("--only", *only, "measure one part alone")
      ->check(CLI::IsMember(std::vector<std::string>(bench_parts.begin(), bench_parts.end())));
  command->callback([points, only, &engine, status] {
    *status = with_session([&] {
      engine.bench(*points, *only);
      return 0;
    });
  });
}

}  // namespace wisp
