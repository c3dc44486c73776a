// The program `wisp`: its commands and their exit statuses. 0 all is well, 1 a run or a verification failed,
// 2 the input or the command line cannot be used.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/verification.h"
#include "io/case.h"

namespace CLI {
class App;
}

namespace wisp {

/// What computes. The program's main hands it in, because the verification tables lie above this room.
struct Engine {
  /// Runs a case with its results in a folder. Called on every rank, within a Session.
  std::function<void(const Case&, const std::filesystem::path& folder)> run;
  /// Goes on from the newest checkpoint in a folder. Called on every rank, within a Session.
  std::function<void(const std::filesystem::path& folder, const std::vector<std::string>& changes)> resume;
  /// Measures speed; `points` is the number of points of its largest case.
  std::function<void(int points, const std::string& only)> bench;
  std::vector<VerificationTable> tables;
};

/// The whole program; the result is the exit status. Never throws.
int program(int argc, char** argv, const Engine& engine);

/// Each command adds its options to the command line; `*status` is what its callback leaves.
void add_run(CLI::App& app, const Engine& engine, int* status);
void add_check(CLI::App& app, int* status);
void add_describe(CLI::App& app, int* status);
void add_template(CLI::App& app, int* status);
void add_resume(CLI::App& app, const Engine& engine, int* status);
void add_picture(CLI::App& app, int* status);
void add_verify(CLI::App& app, const Engine& engine, int* status);
void add_bench(CLI::App& app, const Engine& engine, int* status);

}  // namespace wisp
