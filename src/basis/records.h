// Records: the numbers that belong to one grid function side by side, as one register of the machine.
#pragma once
#include <cstddef>
#include <cstring>
#include <new>
#include <utility>
#include <vector>

namespace wisp {

/// `n` numbers (a power of two) that belong to one grid function, as one register however wide the machine's
/// are. Make one by naming all of its numbers, Record<4>{a, b, c, d}: setting them one by one goes through
/// memory, and the machine waits when it reads in one piece what it has just written in several.
template <int n>
struct RecordTypes {
  using Value __attribute__((vector_size(n * sizeof(double)))) = double;
};
template <int n>
using Record = typename RecordTypes<n>::Value;

template <int n>
inline __attribute__((always_inline)) void load_record(const double* from, Record<n>& r) {
  std::memcpy(&r, from, sizeof r);
}
template <int n>
inline __attribute__((always_inline)) void store_record(const Record<n>& r, double* to) {
  std::memcpy(to, &r, sizeof r);
}

/// A record and one for each direction.
template <int dim, int n>
struct RecordAndGradient {
  Record<n> value{};
  Record<n> gradient[dim]{};
};

/// Memory that starts with a line of the cache, so that no record lies in two.
template <class T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::align_val_t line{64};
  LineAllocator() = default;
  template <class U>
  LineAllocator(const LineAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), line)); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, line); }
  bool operator==(const LineAllocator&) const { return true; }
};

/// An array of records. Kernels also take records in other arrays of doubles; they are slower there.
using RecordArray = std::vector<double, LineAllocator<double>>;

/// Calls f(k) for k = 0 ... n-1. Short loops are written out, with k a constant once f is inlined: what f
/// indexes by k can stay in registers.
template <int n, class F>
inline __attribute__((always_inline)) void for_short(F&& f) {
  if constexpr (n <= 3) {
    [&]<int... k>(std::integer_sequence<int, k...>) __attribute__((always_inline)) { (f(k), ...); }
    (std::make_integer_sequence<int, n>{});
  } else {
    for (int k = 0; k < n; ++k) f(k);
  }
}

}  // namespace wisp
