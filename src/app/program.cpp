#include "app/program.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdlib>

#include "app/launch.h"
#include "core/error.h"
#include "core/nearest.h"
#include "core/version.h"

namespace wisp {
namespace {

/// True on all ranks but the first, before MPI starts: an error is told once.
bool is_other_rank() {
  for (const char* variable : {"OMPI_COMM_WORLD_RANK", "PMI_RANK"})
    if (const char* rank = std::getenv(variable)) return std::string(rank) != "0";
  return false;
}

/// CLI11 only says that a command is required; name the nearest.
void check_command(int argc, char** argv, const CLI::App& app) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> names;
  for (const auto* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), argv[1]) == names.end())
    input_error("unknown command '{}'{}", argv[1], suggestion(argv[1], names));
}

}  // namespace

int program(int argc, char** argv, const Engine& engine) {
  const auto complain = [](const std::string& message, int status) {
    if (!is_other_rank()) tell_error(message);
    return status;
  };
  try {
    CLI::App app("Wisp, a material point method engine", "wisp");
    app.set_version_flag("--version", std::string("wisp ") + std::string(version()));
    app.require_subcommand(1);
    int status = 0;
    if (engine.run) add_run(app, engine, &status);
    add_check(app, &status);
    add_describe(app, &status);
    add_template(app, &status);
    if (engine.resume) add_resume(app, engine, &status);
    add_picture(app, &status);
    add_verify(app, engine, &status);
    if (engine.bench) add_bench(app, engine, &status);
    check_command(argc, argv, app);
    try {
      app.parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help, --version
      return app.exit(success);
    } catch (const CLI::ParseError& error) {
      return complain(std::string(error.what()) + " (see wisp --help)", 2);
    }
    return status;
  } catch (const InputError& error) {
    return complain(error.what(), 2);
  } catch (const std::bad_alloc&) {
    return complain("out of memory", 1);
  } catch (const std::exception& error) {
    return complain(error.what(), 1);
  }
}

}  // namespace wisp
