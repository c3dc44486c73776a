#include "app/launch.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include "core/error.h"
#include "parallel/session.h"

namespace wisp {

std::filesystem::path executable() {
  std::error_code error;
  auto path = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) run_error("cannot find this program's own file: {}", error.message());
  return path;
}

bool launched_by_mpirun() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMI_SIZE") != nullptr;
}

void replace_process(const std::vector<std::string>& words) {
  std::fflush(nullptr);
  std::vector<char*> arguments;
  for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  run_error("cannot start {}: {}", words[0], std::strerror(errno));
}

std::vector<std::string> mpirun_command(int ranks, const std::vector<std::string>& arguments, bool as_root) {
  std::vector<std::string> words{"mpirun", "--oversubscribe", "--quiet"};
  if (as_root) words.push_back("--allow-run-as-root");
  words.insert(words.end(), {"-n", std::to_string(ranks), executable().string()});
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

void launch_ranks(int ranks, const std::vector<std::string>& arguments) {
  if (launched_by_mpirun())
    input_error("--ranks: mpirun has started this program already, with its own number of ranks");
  setenv("OMP_NUM_THREADS", "1", 1);
  setenv("OPENBLAS_NUM_THREADS", "1", 1);
  unsetenv("WISP_TERMINAL");
  if (isatty(STDOUT_FILENO) != 0) {  // the ranks cannot see it: tell them that a person watches, and how wide
    winsize size{};
    const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    setenv("WISP_TERMINAL", std::to_string(known ? size.ws_col : 80).c_str(), 1);
  }
  replace_process(mpirun_command(ranks, arguments, geteuid() == 0));
}

void use_one_blas_thread(char** argv) {
  if (std::getenv("OPENBLAS_NUM_THREADS") != nullptr) return;
  setenv("OPENBLAS_NUM_THREADS", "1", 1);
  setenv("OMP_NUM_THREADS", "1", 0);
  std::fflush(nullptr);
  execv("/proc/self/exe", argv);  // if this fails, the run is right all the same
}

void tell_error(const std::string& message) {
  std::string line = message;
  for (char& c : line)
    if (c == '\n' || c == '\r') c = ' ';
  std::fflush(stdout);
  fmt::print(stderr, "wisp: error: {}\n", line);
}

namespace {

/// Tells an error once: if all ranks failed, by the lowest.
int failed(Session& session, const char* message, int status) {
  const bool together = session.failed_together();
  if (!together || Session::rank() == 0) tell_error(message);
  std::fflush(nullptr);
  return status;
}

}  // namespace

int with_session(const std::function<int()>& work) {
  Session session;
  try {
    return work();
  } catch (const InputError& error) {
    return failed(session, error.what(), 2);
  } catch (const std::bad_alloc&) {
    return failed(session, "out of memory: use fewer points or cells, or more ranks on more machines", 1);
  } catch (const std::exception& error) {
    return failed(session, error.what(), 1);
  }
}

}  // namespace wisp
