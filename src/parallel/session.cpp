#include "parallel/session.h"

#include <petscsys.h>

#include <chrono>
#include <exception>
#include <thread>

#include "core/error.h"
#include "parallel/petsc_check.h"

namespace wisp {
namespace {

MPI_Op mpi_operation(int operation) {
  constexpr int sum = 0;
  constexpr int min = 1;
  if (operation == sum) return MPI_SUM;
  return operation == min ? MPI_MIN : MPI_MAX;
}

/// A run of `bytes` bytes as one MPI value, so that counts of records never overflow an int.
class ByteRecord {
 public:
  explicit ByteRecord(std::size_t bytes) {
    MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &type_);
    MPI_Type_commit(&type_);
  }
  ~ByteRecord() { MPI_Type_free(&type_); }
  ByteRecord(const ByteRecord&) = delete;
  ByteRecord& operator=(const ByteRecord&) = delete;
  [[nodiscard]] MPI_Datatype type() const { return type_; }

 private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

}  // namespace

Session::Session(const std::string& petsc_options) : exceptions_at_start_(std::uncaught_exceptions()) {
  PetscBool running = PETSC_FALSE;
  petsc(PetscInitialized(&running));
  if (running == PETSC_FALSE) {
    petsc(PetscInitializeNoArguments());
    started_ = true;
    // A crash or Ctrl-C belongs to the system and the debugger, not to PETSc's page of advice.
    petsc(PetscPopSignalHandler());
    keep_petsc_errors();
  }
  if (!petsc_options.empty()) petsc(PetscOptionsInsertString(nullptr, petsc_options.c_str()));
  if (size() > 1) MPI_Comm_dup(comm(), &failures_);
}

Session::~Session() {
  if (others_are_lost_) MPI_Abort(comm(), 1);
  // Ending is collective, and this rank may be the only one that gets here: leave; the launcher stops the
  // others.
  if (std::uncaught_exceptions() > exceptions_at_start_ && size() > 1) return;
  if (failures_ != MPI_COMM_NULL) MPI_Comm_free(&failures_);
  if (started_) PetscFinalize();
}

bool Session::failed_together() {
  if (size() == 1) return true;
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(failures_, &request);
  int everybody = 0;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  while (everybody == 0 && std::chrono::steady_clock::now() < deadline) {
    MPI_Test(&request, &everybody, MPI_STATUS_IGNORE);
    if (everybody == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  others_are_lost_ = everybody == 0;
  return !others_are_lost_;
}

bool Session::active() {
  int started = 0;
  int ended = 0;
  MPI_Initialized(&started);
  if (started == 0) return false;
  MPI_Finalized(&ended);
  return ended == 0;
}

int Session::rank() {
  int result = 0;
  if (active()) MPI_Comm_rank(MPI_COMM_WORLD, &result);
  return result;
}

int Session::size() {
  int result = 1;
  if (active()) MPI_Comm_size(MPI_COMM_WORLD, &result);
  return result;
}

MPI_Comm Session::comm() { return active() ? MPI_COMM_WORLD : MPI_COMM_SELF; }

void Session::barrier() {
  if (size() > 1) MPI_Barrier(comm());
}

void Session::reduce(double* values, int count, Operation operation) {
  if (size() == 1) return;
  MPI_Allreduce(MPI_IN_PLACE, values, count, MPI_DOUBLE, mpi_operation(static_cast<int>(operation)), comm());
}

void Session::reduce(int* values, int count, Operation operation) {
  if (size() == 1) return;
  MPI_Allreduce(MPI_IN_PLACE, values, count, MPI_INT, mpi_operation(static_cast<int>(operation)), comm());
}

void Session::reduce(std::int64_t* values, int count, Operation operation) {
  if (size() == 1) return;
  MPI_Allreduce(MPI_IN_PLACE, values, count, MPI_INT64_T, mpi_operation(static_cast<int>(operation)), comm());
}

std::int64_t Session::sum_below(std::int64_t value) {
  std::int64_t result = 0;
  if (size() > 1) MPI_Exscan(&value, &result, 1, MPI_INT64_T, MPI_SUM, comm());
  return rank() == 0 ? 0 : result;  // MPI leaves the value of rank 0 undefined
}

void Session::all_gather_bytes(const void* value, void* result, std::size_t bytes) {
  if (size() == 1) return;  // the caller filled the only entry
  const int count = static_cast<int>(bytes);
  MPI_Allgather(value, count, MPI_BYTE, result, count, MPI_BYTE, comm());
}

void Session::gather_bytes(const void* local, void* result, const std::vector<int>& counts,
                           std::size_t bytes) {
  const ByteRecord record(bytes);
  std::vector<int> starts(counts.size(), 0);
  for (std::size_t r = 1; r < counts.size(); ++r) starts[r] = starts[r - 1] + counts[r - 1];
  MPI_Gatherv(local, counts[static_cast<std::size_t>(rank())], record.type(), result, counts.data(),
              starts.data(), record.type(), 0, comm());
}

std::vector<std::string> Session::gather(const std::string& text) {
  if (size() == 1) return {text};
  const std::vector<int> lengths = all_gather(static_cast<int>(text.size()));
  const std::vector<char> letters = gather(std::vector<char>(text.begin(), text.end()));
  std::vector<std::string> result;
  if (rank() != 0) return result;
  std::size_t start = 0;
  for (const int length : lengths) {
    const auto count = static_cast<std::size_t>(length);
    result.emplace_back(letters.data() + start, count);
    start += count;
  }
  return result;
}

void Session::broadcast_bytes(void* value, std::size_t bytes, int root) {
  if (size() > 1) MPI_Bcast(value, static_cast<int>(bytes), MPI_BYTE, root, comm());
}

std::string Session::broadcast(const std::string& text, int root) {
  if (size() == 1) return text;
  const auto length = broadcast(static_cast<std::int64_t>(text.size()), root);
  std::string result = rank() == root ? text : std::string(static_cast<std::size_t>(length), '\0');
  broadcast_bytes(result.data(), static_cast<std::size_t>(length), root);
  return result;
}

void Session::raise_together(const std::string& error) {
  const int lowest = min(error.empty() ? size() : rank());
  if (lowest == size()) return;
  run_error("{}", broadcast(error, lowest));
}

}  // namespace wisp
