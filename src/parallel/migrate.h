// Moving records (material points) to the ranks that own them now.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace wisp {

/// One exchange of items between ranks: who leaves, who stays, who arrives. Made from the destination of each
/// local item, then used for as many fields as the items have. Items arrive by source rank, and from one rank
/// in the order they had there, so a repeated run gives the same order. Every function that moves something
/// is collective.
class Migration {
 public:
  /// @param destination rank that each local item belongs to now
  /// @throws RunError on all ranks if a destination does not exist
  explicit Migration(std::span<const int> destination);

  /// Local items that stay, in their order.
  [[nodiscard]] const std::vector<int>& staying() const { return staying_; }
  /// Local items that go, by destination and in their order.
  [[nodiscard]] const std::vector<int>& leaving() const { return leaving_; }
  [[nodiscard]] int n_arriving() const { return n_arriving_; }
  /// Local items after the exchange.
  [[nodiscard]] int n_after() const { return static_cast<int>(staying_.size()) + n_arriving_; }
  /// Items that go between any ranks; the same number everywhere. None: nothing has to be moved.
  [[nodiscard]] std::int64_t n_moving() const { return n_moving_; }

  /// Sends one record per leaving item.
  /// @param record_bytes length of a record, the same for all items and ranks
  /// @param pack         called as pack(item, std::byte* record) for every leaving item
  /// @return the arriving records, n_arriving() * record_bytes
  template <class Pack>
  [[nodiscard]] std::vector<std::byte> exchange_records(std::size_t record_bytes, Pack&& pack) const {
    std::vector<std::byte> out(leaving_.size() * record_bytes);
    for (std::size_t i = 0; i < leaving_.size(); ++i) pack(leaving_[i], out.data() + i * record_bytes);
    std::vector<std::byte> in(static_cast<std::size_t>(n_arriving_) * record_bytes);
    exchange_bytes(out.data(), in.data(), record_bytes);
    return in;
  }

  /// Moves one field of the items in place, byte by byte (small tensors of Eigen count as plain bytes here):
  /// what stays closes ranks in its order, what arrives follows.
  /// @param field      n items * components values
  /// @param components values per item
  template <class T>
  requires std::is_trivially_destructible_v<T> && std::is_standard_layout_v<T>
  void move(std::vector<T>& field, int components = 1) const {
    if (n_moving_ == 0) return;
    const auto width = static_cast<std::size_t>(components);
    const std::vector<std::byte> arrived =
        exchange_records(sizeof(T) * width, [&](int item, std::byte* record) {
          std::memcpy(record, static_cast<const void*>(field.data() + static_cast<std::size_t>(item) * width),
                      sizeof(T) * width);
        });
    std::size_t place = 0;
    for (const int item : staying_) {
      const auto from = static_cast<std::size_t>(item) * width;
      for (std::size_t c = 0; c < width; ++c) field[place++] = field[from + c];
    }
    field.resize(static_cast<std::size_t>(n_after()) * width);
    if (!arrived.empty())
      std::memcpy(static_cast<void*>(field.data() + place), arrived.data(), arrived.size());
  }

 private:
  void exchange_bytes(const std::byte* out, std::byte* in, std::size_t record_bytes) const;

  std::vector<int> staying_, leaving_;
  std::vector<int> n_to_, n_from_;  // items per rank, none to or from this one
  int n_arriving_ = 0;
  std::int64_t n_moving_ = 0;
};

/// Greatest over mean number of items on a rank: 1 is perfect, size() the worst. 1 if there are no items.
/// Collective.
[[nodiscard]] double imbalance(std::int64_t n_local);

}  // namespace wisp
