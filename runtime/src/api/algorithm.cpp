// SPDX-License-Identifier: MIT
//
// What sk/algorithm.hpp declares. A device may do it itself (DeviceState::reorder). Otherwise the order is computed on the
// host's cores, from keys that the device hands over; the streams then bring their elements into it
// (StreamState::permute).
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "call/placed.hpp"
#include "device/device_state.hpp"
#include "device/loop_state.hpp"
#include "device/stream_state.hpp"
#include "device/write_scope.hpp"
#include "results/recorder.hpp"
#include "sk/algorithm.hpp"
#include "sk/error.hpp"
#include "sk/host_vector.hpp"
#include "sk/limits.hpp"
#include "sk/native/parallel.hpp"
#include "support/checked_size.hpp"

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

using Permutation = std::vector<std::int32_t>;

StreamState& checked(const StreamRegion& region, std::string_view what) {
  StreamState& stream = liveStream(region, what);
  refuseInRecording(*stream.device, what);
  checkElementsOf(region, false, what);
  if (region.shape.size() > mostExtent) {
    throw Error(fmt::format("{}: a stream of shape {} has more than {} elements; divide it", what,
                            toString(region.shape), mostExtent),
                Error::Kind::Shape);
  }
  return stream;
}

/// Checks the streams of a call. `first` is the name of the first argument.
DeviceState& checkStreams(const StreamRegion& keys, const StreamRegion* values, std::string_view what,
                          std::string_view first) {
  StreamState& stream = checked(keys, what);
  if (values == nullptr) return *stream.device;
  const StreamState& others = checked(*values, what);
  if (others.device != stream.device) {
    throw Error(fmt::format("{}: {} and values are on different devices, '{}' and '{}'; copy one (copyTo)",
                            what, first, stream.device->name(), others.device->name()),
                Error::Kind::Device);
  }
  if (keys.shape != values->shape) {
    throw Error(fmt::format("{}: {} have shape {}, values {}; give them the same shape", what, first,
                            toString(keys.shape), toString(values->shape)),
                Error::Kind::Shape);
  }
  if (&others == &stream) {
    throw Error(fmt::format("{}: {} and values are the same stream of shape {}; give two streams", what,
                            first, toString(stream.shape)),
                Error::Kind::Misuse);
  }
  return *stream.device;
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

Permutation orderOf(const StreamRegion& keys, const SortOptions& options) {
  return withKeys(keys, [&](const auto& values) {
    auto ranks = detail::hostVector<decltype(rankOf(values[0], false))>(values.size());
    std::ranges::transform(values, ranks.begin(), [&](auto key) { return rankOf(key, options.descending); });
    return radixOrder(std::move(ranks));
  });
}

/// The numbers for which isFirst(number) is true, then the others. Sets `count` to how many come first.
template <class IsFirst>
Permutation firstOf(std::size_t size, std::int64_t& count, IsFirst&& isFirst) {
  auto order = detail::hostVector<std::int32_t>(size);
  auto next = order.begin();
  auto rest = order.end();  // grows to the front
  for (std::size_t i = 0; i < size; ++i) *(isFirst(i) ? next++ : --rest) = static_cast<std::int32_t>(i);
  count = next - order.begin();
  std::reverse(rest, order.end());
  return order;
}

/// Has the device reorder the keys, if they move, and the values.
std::optional<std::int64_t> reorder(DeviceState& device, Reordering::By by, const StreamRegion& keys,
                                    bool movesKeys, const StreamRegion* values,
                                    const StreamRegion* places = nullptr) {
  if (keys.shape.size() == 0) return std::nullopt;
  std::vector<StreamRegion> moved;
  if (movesKeys) moved.push_back(keys);
  if (values != nullptr) moved.push_back(*values);
  return device.reorder({.by = by, .keys = keys, .moved = moved, .places = places});
}

Reordering::By byKeys(const SortOptions& options) {
  return options.descending ? Reordering::By::DescendingKeys : Reordering::By::Keys;
}

void permute(const StreamRegion& region, const Permutation& order) {
  if (order.empty()) return;
  const DenseRegion dense(region, /*isRead=*/true);
  dense.get().stream->permute(dense.get(), order);
  dense.finish();
}

/// `values` may be null. If they cannot follow the keys, these are lost.
void permuteBoth(const StreamRegion& keys, const StreamRegion* values, const Permutation& order) {
  WriteScope writes;
  writes.add(keys.stream);
  permute(keys, order);
  writes.begin();
  if (values != nullptr) permute(*values, order);
  writes.commit();
}

}  // namespace

void StreamState::permute(const StreamRegion& region, std::span<const std::int32_t> sources) {
  const bool isOfFloats = std::ranges::all_of(
      element->fields, [](const program::Field& field) { return field.scalar == program::Scalar::Float; });
  const auto move = [&](auto& from, auto& to, std::size_t width) {
    for (std::size_t i = 0; i < sources.size(); ++i) {
      std::copy_n(&from[static_cast<std::size_t>(sources[i]) * width], width, &to[i * width]);
    }
  };
  if (isOfFloats && storage >= Storage::Extended) {
    std::size_t width = 0;
    for (const program::Field& field : element->fields) width += field.width;
    auto from = detail::hostVector<double>(sources.size() * width), to = from;
    readReals(region, from.data());
    move(from, to, width);
    writeReals(region, to.data());
    return;
  }
  auto from = detail::hostVector<std::byte>(bytesOf(region.shape.size(), element->size)), to = from;
  read(region, from.data());
  move(from, to, element->size);
  write(region, to.data());
}

void detail::sort(const StreamRegion& keys, const StreamRegion* values, const SortOptions& options) {
  withHostMemory("sk::sort", [&] {
    DeviceState& device = checkStreams(keys, values, "sk::sort", "keys");
    const TraceScope traced(device.trace.get(), "call", "sk::sort");
    if (reorder(device, byKeys(options), keys, true, values)) return;
    const Permutation order = orderOf(keys, options);
    permuteBoth(keys, values, order);
  });
}

detail::StreamOwner detail::order(const StreamRegion& keys, const SortOptions& options) {
  return withHostMemory("sk::order", [&] {
    DeviceState& device = checkStreams(keys, nullptr, "sk::order", "keys");
    const TraceScope traced(device.trace.get(), "call", "sk::order");
    std::unique_ptr<StreamState> stream =
        device.createStream(ElementTraits<std::int32_t>::element(), keys.shape, Storage::Single);
    if (device.results != nullptr) stream->resultNumber = device.results->addStream({}, std::nullopt, 0);
    const StreamRegion all{stream.get(), Index::origin(keys.shape.rank()), keys.shape};
    if (!reorder(device, byKeys(options), keys, false, nullptr, &all)) {
      const Permutation order = orderOf(keys, options);
      if (!order.empty()) stream->write(all, reinterpret_cast<const std::byte*>(order.data()));
    }
    return StreamOwner(stream.release());
  });
}

std::int64_t detail::unique(const StreamRegion& keys, const StreamRegion* values) {
  return withHostMemory("sk::unique", [&] {
    DeviceState& device = checkStreams(keys, values, "sk::unique", "keys");
    const TraceScope traced(device.trace.get(), "call", "sk::unique");
    if (const auto first = reorder(device, Reordering::By::Changes, keys, true, values)) return *first;
    std::int64_t count = 0;
    const Permutation order = withKeys(keys, [&](const auto& all) {
      return firstOf(all.size(), count, [&](std::size_t i) { return i == 0 || !(all[i] == all[i - 1]); });
    });
    permuteBoth(keys, values, order);
    return count;
  });
}

std::int64_t detail::partition(const StreamRegion& flags, const StreamRegion& values) {
  return withHostMemory("sk::partition", [&] {
    DeviceState& device = checkStreams(flags, &values, "sk::partition", "flags");
    const TraceScope traced(device.trace.get(), "call", "sk::partition");
    if (const auto first = reorder(device, Reordering::By::Flags, flags, false, &values)) return *first;
    std::int64_t count = 0;
    const auto orderBy = [&](const auto& all) {
      return firstOf(all.size(), count, [&](std::size_t i) { return all[i] != 0; });
    };
    const bool isBool = flags.stream->element->fields[0].scalar == program::Scalar::Bool;
    permute(values, isBool ? orderBy(readAs<std::uint8_t>(flags)) : orderBy(readAs<std::uint32_t>(flags)));
    return count;
  });
}

}  // namespace sk
