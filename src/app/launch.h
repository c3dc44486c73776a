// Processes: ranks by mpirun, one BLAS thread a rank, other programs.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace wisp {

/// This program's file.
std::filesystem::path executable();

/// True in a process that mpirun started.
bool launched_by_mpirun();

/// Replaces this process by `words[0]` with its arguments; RunError if that cannot be started.
[[noreturn]] void replace_process(const std::vector<std::string>& words);

/// Arguments that start `ranks` copies of this program with `arguments`.
std::vector<std::string> mpirun_command(int ranks, const std::vector<std::string>& arguments, bool as_root);

/// Replaces this process by `ranks` ranks of the same program; its exit status becomes this one's. InputError
/// if mpirun started this process already, or is not installed.
[[noreturn]] void launch_ranks(int ranks, const std::vector<std::string>& arguments);

/// BLAS libraries read their number of threads when they are loaded, so this process is started anew with one
/// thread unless the environment says otherwise. One rank uses one core; results must not depend on the
/// number of cores.
void use_one_blas_thread(char** argv);

/// Calls `work` with MPI and PETSc running and turns exceptions into exit statuses, told by one rank.
int with_session(const std::function<int()>& work);

/// Prints `wisp: error: ...` as one line.
void tell_error(const std::string& message);

}  // namespace wisp
