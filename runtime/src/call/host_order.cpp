// SPDX-License-Identifier: MIT
#include "call/host_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include "call/placed.hpp"
#include "device/stream_state.hpp"
#include "device/write_scope.hpp"
#include "sk/host_vector.hpp"
#include "sk/native/parallel.hpp"

namespace sk {

namespace {

// The stable order of unsigned keys: a radix sort from the least significant digit, on threads.

/// The numbers of the keys, in the order of the keys; equal keys keep their order. Consumes the keys. There are at
/// most 2^31 - 1. The result does not depend on the number of threads.
std::vector<std::int32_t> radixOrder(std::vector<std::uint32_t>&& keys);
std::vector<std::int32_t> radixOrder(std::vector<std::uint64_t>&& keys);

constexpr int radixBits = 8;
constexpr std::size_t buckets = std::size_t{1} << radixBits;
using Counts = std::array<std::int64_t, buckets>;

template <class Bits>
struct Item {
  Bits key;
  std::int32_t number;
};

template <class Bits>
std::size_t digitOf(Bits key, int shift) {
  return static_cast<std::size_t>(key >> shift) % buckets;
}

/// Sorts items by one digit at a time. Each part of the items has its own place in every bucket, so that threads
/// need no order among themselves.
template <class Bits>
class RadixSort {
 public:
  explicit RadixSort(std::vector<Bits>&& keys)
      : count_(static_cast<std::int64_t>(keys.size())),
        counts_(static_cast<std::size_t>(native::threadsFor(count_, 1))),
        items_(detail::hostVector<Item<Bits>>(keys.size())),
        sorted_(detail::hostVector<Item<Bits>>(keys.size())) {
    native::inParallel(count_, 1, native::Deal::Evenly, [&](native::Range range) {
      for (auto i = static_cast<std::size_t>(range.begin); i < static_cast<std::size_t>(range.end); ++i) {
        items_[i] = {keys[i], static_cast<std::int32_t>(i)};
      }
    });
  }

  std::vector<std::int32_t> order() {
    for (int shift = 0; shift < static_cast<int>(8 * sizeof(Bits)); shift += radixBits) sortBy(shift);
    auto numbers = detail::hostVector<std::int32_t>(items_.size());
    native::inParallel(count_, 1, native::Deal::Evenly, [&](native::Range range) {
      for (auto i = static_cast<std::size_t>(range.begin); i < static_cast<std::size_t>(range.end); ++i) {
        numbers[i] = items_[i].number;
      }
    });
    return numbers;
  }

 private:
  void sortBy(int shift) {
    forEachPart([&](std::size_t part, std::size_t begin, std::size_t end) {
      Counts counts{};
      for (std::size_t i = begin; i < end; ++i) ++counts[digitOf(items_[i].key, shift)];
      counts_[part] = counts;
    });
    if (!makeStarts()) return;
    forEachPart([&](std::size_t part, std::size_t begin, std::size_t end) {
      Counts next = counts_[part];
      for (std::size_t i = begin; i < end; ++i) {
        const Item<Bits> item = items_[i];
        sorted_[static_cast<std::size_t>(next[digitOf(item.key, shift)]++)] = item;
      }
    });
    std::swap(items_, sorted_);
  }

  /// Replaces counts by where each part begins in each bucket. Returns false if all keys have the same digit.
  bool makeStarts() {
    std::int64_t start = 0;
    for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
      const std::int64_t before = start;
      for (Counts& counts : counts_) start += std::exchange(counts[bucket], start);
      if (start - before == count_) return false;
    }
    return true;
  }

  template <class Visit>
  void forEachPart(Visit&& visit) {
    const auto parts = static_cast<std::int64_t>(counts_.size());
    native::inParallel(parts, count_, native::Deal::Evenly, [&](native::Range range) {
      for (std::int64_t part = range.begin; part < range.end; ++part) {
        visit(static_cast<std::size_t>(part), static_cast<std::size_t>(count_ * part / parts),
              static_cast<std::size_t>(count_ * (part + 1) / parts));
      }
    });
  }

  std::int64_t count_;
  std::vector<Counts> counts_;  ///< one per part
  std::vector<Item<Bits>> items_;
  std::vector<Item<Bits>> sorted_;
};

std::vector<std::int32_t> radixOrder(std::vector<std::uint32_t>&& keys) {
  return RadixSort<std::uint32_t>(std::move(keys)).order();
}

std::vector<std::int32_t> radixOrder(std::vector<std::uint64_t>&& keys) {
  return RadixSort<std::uint64_t>(std::move(keys)).order();
}

template <class T>
std::vector<T> readAs(const StreamRegion& region) {
  auto values = detail::hostVector<T>(static_cast<std::size_t>(region.shape.size()));
  const DenseRegion dense(region, /*isRead=*/true);
  if (!values.empty()) dense.get().stream->read(dense.get(), reinterpret_cast<std::byte*>(values.data()));
  return values;
}

/// Calls use(values) with the keys as they are stored: a reference device and wide storage hold floats as doubles.
template <class Use>
auto withKeys(const StreamRegion& keys, Use&& use) {
  const StreamState& stream = *keys.stream;
  const program::Scalar scalar = stream.element->fields[0].scalar;
  if (scalar == program::Scalar::Int) return use(readAs<std::int32_t>(keys));
  if (scalar == program::Scalar::Uint) return use(readAs<std::uint32_t>(keys));
  if (scalar == program::Scalar::Double) return use(readAs<double>(keys));
  if (scalar == program::Scalar::Long) return use(readAs<std::int64_t>(keys));
  if (scalar == program::Scalar::Ulong) return use(readAs<std::uint64_t>(keys));
  if (!stream.device->isReference() && stream.storage < Storage::Extended) return use(readAs<float>(keys));
  auto values = detail::hostVector<double>(static_cast<std::size_t>(keys.shape.size()));
  const DenseRegion dense(keys, /*isRead=*/true);
  if (!values.empty()) dense.get().stream->readReals(dense.get(), values.data());
  return use(values);
}

/// An unsigned number that compares as the key does. A NaN gets the largest, in both directions.
template <class T>
auto rankOf(T key, bool isDescending) {
  using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
  constexpr Bits sign = Bits{1} << (8 * sizeof(T) - 1);
  Bits bits = std::bit_cast<Bits>(key);
  if constexpr (std::is_floating_point_v<T>) {
    if (std::isnan(key)) return std::numeric_limits<Bits>::max();
    if (key == 0) bits = 0;
    bits = (bits & sign) != 0 ? ~bits : bits | sign;
  } else if constexpr (std::is_signed_v<T>) {
    bits ^= sign;
  }
  return isDescending ? static_cast<Bits>(~bits) : bits;
}

std::vector<std::int32_t> orderOf(const StreamRegion& keys, bool isDescending) {
  return withKeys(keys, [&](const auto& values) {
    auto ranks = detail::hostVector<decltype(rankOf(values[0], false))>(values.size());
    std::ranges::transform(values, ranks.begin(), [&](auto key) { return rankOf(key, isDescending); });
    return radixOrder(std::move(ranks));
  });
}

/// The numbers for which isFirst(number) is true, then the others.
template <class IsFirst>
HostOrder firstOf(std::size_t size, IsFirst&& isFirst) {
  HostOrder order{.sources = detail::hostVector<std::int32_t>(size)};
  auto next = order.sources.begin();
  auto rest = order.sources.end();  // grows to the front
  for (std::size_t i = 0; i < size; ++i) *(isFirst(i) ? next++ : --rest) = static_cast<std::int32_t>(i);
  order.first = next - order.sources.begin();
  std::reverse(rest, order.sources.end());
  return order;
}

HostOrder byFlags(const StreamRegion& flags) {
  const auto orderBy = [&](const auto& all) {
    return firstOf(all.size(), [&](std::size_t i) { return all[i] != 0; });
  };
  const bool isBool = flags.stream->element->fields[0].scalar == program::Scalar::Bool;
  return isBool ? orderBy(readAs<std::uint8_t>(flags)) : orderBy(readAs<std::uint32_t>(flags));
}

void permute(const StreamRegion& region, std::span<const std::int32_t> sources) {
  const DenseRegion dense(region, /*isRead=*/true);
  dense.get().stream->permute(dense.get(), sources);
  dense.finish();
}

}  // namespace

HostOrder hostOrder(Reordering::By by, const StreamRegion& keys) {
  switch (by) {
    case Reordering::By::Keys: return {.sources = orderOf(keys, false)};
    case Reordering::By::DescendingKeys: return {.sources = orderOf(keys, true)};
    case Reordering::By::Flags: return byFlags(keys);
    case Reordering::By::Changes: break;
  }
  return withKeys(keys, [&](const auto& all) {
    return firstOf(all.size(), [&](std::size_t i) { return i == 0 || !(all[i] == all[i - 1]); });
  });
}

void bringInto(const Reordering& order, const HostOrder& found) {
  if (order.places != nullptr)
    order.places->stream->write(*order.places, reinterpret_cast<const std::byte*>(found.sources.data()));
  WriteScope writes;  // if others cannot follow, those that have moved are lost
  for (const StreamRegion& region : order.moved) {
    permute(region, found.sources);
    writes.add(region.stream);
    writes.begin();
  }
  writes.commit();
}

}  // namespace sk
