// SPDX-License-Identifier: MIT
#include "support/radix_order.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "sk/host_vector.hpp"
#include "sk/native/parallel.hpp"

namespace sk {

namespace {

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

}  // namespace

std::vector<std::int32_t> radixOrder(std::vector<std::uint32_t>&& keys) {
  return RadixSort<std::uint32_t>(std::move(keys)).order();
}

std::vector<std::int32_t> radixOrder(std::vector<std::uint64_t>&& keys) {
  return RadixSort<std::uint64_t>(std::move(keys)).order();
}

}  // namespace sk
