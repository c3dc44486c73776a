#include "parallel/migrate.h"

#include <string>

#include "core/error.h"
#include "parallel/session.h"

namespace wisp {

Migration::Migration(std::span<const int> destination) {
  const auto ranks = static_cast<std::size_t>(Session::size());
  const int here = Session::rank();
  n_to_.assign(ranks, 0);
  n_from_.assign(ranks, 0);
  std::string error;
  for (const int rank : destination) {
    if (rank < 0 || static_cast<std::size_t>(rank) >= ranks)
      error = fmt::format("migration: an item is sent to rank {}, but there are {}", rank, ranks);
    else if (rank != here)
      ++n_to_[static_cast<std::size_t>(rank)];
  }
  Session::raise_together(error);

  std::vector<std::size_t> next(ranks, 0);
  for (std::size_t r = 1; r < ranks; ++r) next[r] = next[r - 1] + static_cast<std::size_t>(n_to_[r - 1]);
  std::size_t n_leaving = next.back() + static_cast<std::size_t>(n_to_.back());
  leaving_.resize(n_leaving);
  staying_.reserve(destination.size() - n_leaving);
  for (std::size_t i = 0; i < destination.size(); ++i) {
    const auto to = static_cast<std::size_t>(destination[i]);
    if (destination[i] == here)
      staying_.push_back(static_cast<int>(i));
    else
      leaving_[next[to]++] = static_cast<int>(i);
  }
  if (ranks == 1) return;
  MPI_Alltoall(n_to_.data(), 1, MPI_INT, n_from_.data(), 1, MPI_INT, Session::comm());
  for (const int count : n_from_) n_arriving_ += count;
  n_moving_ = Session::sum(static_cast<std::int64_t>(n_leaving));
}

void Migration::exchange_bytes(const std::byte* out, std::byte* in, std::size_t record_bytes) const {
  if (n_moving_ == 0 || record_bytes == 0) return;
  // A type of the record's length keeps the counts within an int.
  MPI_Datatype record = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(static_cast<int>(record_bytes), MPI_BYTE, &record);
  MPI_Type_commit(&record);
  std::vector<MPI_Request> requests;
  constexpr int tag = 0;
  for (std::size_t r = 0; r < n_from_.size(); ++r) {
    if (n_from_[r] == 0) continue;
    requests.emplace_back();
    MPI_Irecv(in, n_from_[r], record, static_cast<int>(r), tag, Session::comm(), &requests.back());
    in += static_cast<std::size_t>(n_from_[r]) * record_bytes;
  }
  for (std::size_t r = 0; r < n_to_.size(); ++r) {
    if (n_to_[r] == 0) continue;
    requests.emplace_back();
    MPI_Isend(out, n_to_[r], record, static_cast<int>(r), tag, Session::comm(), &requests.back());
    out += static_cast<std::size_t>(n_to_[r]) * record_bytes;
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  MPI_Type_free(&record);
}

double imbalance(std::int64_t n_local) {
  const std::int64_t total = Session::sum(n_local);
  if (total == 0) return 1.0;
  return static_cast<double>(Session::max(n_local)) * Session::size() / static_cast<double>(total);
}

}  // namespace wisp
