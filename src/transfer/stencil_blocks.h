// Dense matrices of points with the same functions are summed before they enter a sparse matrix, so that
// matrix entries are touched once per cell and set of functions, never per point.
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace wisp {

/// A few open dense blocks, each for one set of functions. Points come in cell order, so a set that has been
/// left for a while does not come back; when all slots are taken the oldest is handed over.
class StencilBlocks {
 public:
  /// `size` functions a set, `block` unknowns a function.
  StencilBlocks(int size, int block, int slots = 16)
      : size_(static_cast<std::size_t>(size)),
        rows_(size_ * static_cast<std::size_t>(block)),
        slots_(static_cast<std::size_t>(slots)) {
    for (auto& slot : slots_) slot.functions.resize(size_), slot.dense.assign(rows_ * rows_, 0.0);
  }

  /// The dense block of a set; `functions(int*)` fills in the set when it is new, `flush(functions, dense)`
  /// takes a block that has to make room.
  template <class Functions, class Flush>
  double* find(int key, Functions&& functions, Flush&& flush) {
    if (slots_[last_].used && slots_[last_].key == key) return slots_[last_].dense.data();
    for (std::size_t s = 0; s < slots_.size(); ++s)
      if (slots_[s].used && slots_[s].key == key) return last_ = s, slots_[s].dense.data();
    Slot& slot = slots_[next_];
    if (slot.used) empty(slot, flush);
    slot.key = key, slot.used = true;
    functions(slot.functions.data());
    last_ = next_;
    next_ = (next_ + 1) % slots_.size();
    return slot.dense.data();
  }

  template <class Flush>
  void finish(Flush&& flush) {
    for (auto& slot : slots_)
      if (slot.used) empty(slot, flush);
    next_ = last_ = 0;
  }

 private:
  struct Slot {
    int key = 0;
    bool used = false;
    std::vector<int> functions;
    std::vector<double> dense;
  };
  template <class Flush>
  void empty(Slot& slot, Flush&& flush) {
    flush(std::span<const int>(slot.functions), slot.dense.data());
    std::fill(slot.dense.begin(), slot.dense.end(), 0.0);
    slot.used = false;
  }

  std::size_t size_, rows_;
  std::vector<Slot> slots_;
  std::size_t last_ = 0, next_ = 0;
};

/// Adds m phi_i phi_j to the block of a stencil's functions.
template <class Stencil, class Flush>
void add_products(StencilBlocks& blocks, const Stencil& stencil, double m, Flush&& flush) {
  constexpr int n = Stencil::max_functions;
  double* const dense = blocks.find(
      stencil.key(),
      [&](int* functions) { stencil.for_each([&](int k, int i, double, const auto&) { functions[k] = i; }); },
      flush);
  double phi[n];
  stencil.for_each([&](int k, int, double value, const auto&) { phi[k] = value; });
  for (int i = 0; i < n; ++i) {
    const double row = m * phi[i];
    double* const out = dense + i * n;
    for (int j = 0; j < n; ++j) out[j] += row * phi[j];
  }
}

/// Sets of functions by the keys of their stencils, each handed on once.
class StencilSets {
 public:
  explicit StencilSets(int n_keys) : seen_(static_cast<std::size_t>(n_keys), 0) {}

  /// Calls f(functions) for a set that has not been met before.
  template <class Stencil, class F>
  void add(const Stencil& stencil, F&& f) {
    char& flag = seen_[static_cast<std::size_t>(stencil.key())];
    if (flag) return;
    flag = 1;
    functions_.resize(static_cast<std::size_t>(stencil.size()));
    stencil.for_each([&](int k, int i, double, const auto&) { functions_[static_cast<std::size_t>(k)] = i; });
    f(functions_);
  }

 private:
  std::vector<char> seen_;
  std::vector<int> functions_;
};

}  // namespace wisp
