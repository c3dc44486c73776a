// The program: commands from src/app, published tables from the folders beside this file.
#include "app/bench.h"
#include "app/launch.h"
#include "app/program.h"
#include "io/run.h"
#include "verification/tables.h"

int main(int argc, char** argv) {
  wisp::use_one_blas_thread(argv);
  wisp::Engine engine;
  engine.run = [](const wisp::Case& c, const std::filesystem::path& folder) { wisp::run_case(c, folder); };
  engine.resume = [](const std::filesystem::path& folder, const std::vector<std::string>& changes) {
    wisp::resume_run(folder, changes);
  };
  engine.bench = wisp::bench;
  engine.tables = wisp::verification_tables();
  return wisp::program(argc, argv, engine);
}
