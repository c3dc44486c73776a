// The life of MPI and PETSc in this process, and the collective operations that need no more than a value.
#pragma once
#include <mpi.h>

#include <Eigen/Core>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace wisp {

/// Values that are reduced over ranks.
template <class T>
concept Reducible = std::same_as<T, double> || std::same_as<T, int> || std::same_as<T, std::int64_t>;

/// Starts MPI and PETSc, and ends them with its own life. The commands that compute make one at their start,
/// the others never do (starting MPI costs half a second).
///
/// The static functions may be called at any time: without a session, or on one rank, they return the local
/// value and communicate nothing. On several ranks each is collective: all ranks must call it, in the same
/// order.
class Session {
 public:
  /// Starts MPI and PETSc unless somebody has; the program's arguments are left alone. PETSc reads its
  /// options from `petsc_options` ("-ksp_type cg -ksp_monitor") and from the environment variable
  /// PETSC_OPTIONS.
  /// @throws RunError if PETSc does not start or cannot read the options.
  explicit Session(const std::string& petsc_options = "");
  /// Ends PETSc and MPI if this session started them. It does not when an exception is on its way on this
  /// rank or when `failed_together()` was false: the other ranks would never come to the end, and all would
  /// wait for ever.
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// To be called once by each rank that failed: true if every rank failed, within a second of each other
  /// (then the lowest rank tells the user); false if only some did (then this rank tells, and the destructor
  /// aborts the others with exit status 1).
  [[nodiscard]] bool failed_together();

  /// True between the start and the end of MPI, whoever started it.
  [[nodiscard]] static bool active();
  /// This process among `size()`; 0 without a session.
  [[nodiscard]] static int rank();
  /// Number of processes; 1 without a session.
  [[nodiscard]] static int size();
  /// All ranks; MPI_COMM_SELF without a session.
  [[nodiscard]] static MPI_Comm comm();
  static void barrier();

  template <Reducible T>
  [[nodiscard]] static T sum(T value) {
    reduce(&value, 1, Operation::sum);
    return value;
  }
  template <Reducible T>
  [[nodiscard]] static T min(T value) {
    reduce(&value, 1, Operation::min);
    return value;
  }
  template <Reducible T>
  [[nodiscard]] static T max(T value) {
    reduce(&value, 1, Operation::max);
    return value;
  }
  /// Component by component.
  template <Reducible T, int rows, int columns, int options, int max_rows, int max_columns>
  [[nodiscard]] static Eigen::Matrix<T, rows, columns, options, max_rows, max_columns> sum(
      Eigen::Matrix<T, rows, columns, options, max_rows, max_columns> value) {
    reduce(value.data(), static_cast<int>(value.size()), Operation::sum);
    return value;
  }
  template <Reducible T, int rows, int columns, int options, int max_rows, int max_columns>
  [[nodiscard]] static Eigen::Matrix<T, rows, columns, options, max_rows, max_columns> min(
      Eigen::Matrix<T, rows, columns, options, max_rows, max_columns> value) {
    reduce(value.data(), static_cast<int>(value.size()), Operation::min);
    return value;
  }
  template <Reducible T, int rows, int columns, int options, int max_rows, int max_columns>
  [[nodiscard]] static Eigen::Matrix<T, rows, columns, options, max_rows, max_columns> max(
      Eigen::Matrix<T, rows, columns, options, max_rows, max_columns> value) {
    reduce(value.data(), static_cast<int>(value.size()), Operation::max);
    return value;
  }
  /// In place over the ranks, entry by entry; `values` has the same length on all of them.
  template <Reducible T>
  static void sum_in_place(std::vector<T>& values) {
    reduce(values.data(), static_cast<int>(values.size()), Operation::sum);
  }
  [[nodiscard]] static bool all_of(bool value) { return min(value ? 1 : 0) == 1; }
  [[nodiscard]] static bool any_of(bool value) { return max(value ? 1 : 0) == 1; }
  /// Sum of the values of the lower ranks (0 on rank 0): where this rank's share starts in a global
  /// numbering.
  [[nodiscard]] static std::int64_t sum_below(std::int64_t value);

  /// One value per rank, on every rank.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  [[nodiscard]] static std::vector<T> all_gather(const T& value) {
    std::vector<T> result(static_cast<std::size_t>(size()), value);
    all_gather_bytes(&value, result.data(), sizeof(T));
    return result;
  }
  /// The lists of all ranks, one after the other by rank, on rank 0; the other ranks get an empty list.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  [[nodiscard]] static std::vector<T> gather(const std::vector<T>& local) {
    if (size() == 1) return local;
    const std::vector<int> counts = all_gather(static_cast<int>(local.size()));
    std::size_t total = 0;
    for (const int count : counts) total += static_cast<std::size_t>(count);
    std::vector<T> result(rank() == 0 ? total : 0);
    gather_bytes(local.data(), result.data(), counts, sizeof(T));
    return result;
  }
  /// One string per rank on rank 0; an empty list elsewhere.
  [[nodiscard]] static std::vector<std::string> gather(const std::string& text);
  /// The string of rank `root`, on every rank.
  [[nodiscard]] static std::string broadcast(const std::string& text, int root = 0);
  /// The value of rank `root`, on every rank.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  [[nodiscard]] static T broadcast(T value, int root = 0) {
    broadcast_bytes(&value, sizeof(T), root);
    return value;
  }
  /// Collective check before ranks part ways: every rank gives its error text, empty if all is well.
  /// @throws RunError on all ranks, with the text of the lowest rank that has one.
  static void raise_together(const std::string& error);

 private:
  enum class Operation { sum, min, max };
  static void reduce(double* values, int count, Operation operation);
  static void reduce(int* values, int count, Operation operation);
  static void reduce(std::int64_t* values, int count, Operation operation);
  static void all_gather_bytes(const void* value, void* result, std::size_t bytes);
  static void gather_bytes(const void* local, void* result, const std::vector<int>& counts,
                           std::size_t bytes);
  static void broadcast_bytes(void* value, std::size_t bytes, int root);

  bool started_ = false;          // this object started PETSc, so it ends it
  bool others_are_lost_ = false;  // some rank failed alone
  int exceptions_at_start_ = 0;   // to see in the destructor whether one is on its way
  MPI_Comm failures_ =
      MPI_COMM_NULL;  // a channel of its own, so that it never mixes with an interrupted exchange
};

}  // namespace wisp
