// SPDX-License-Identifier: MIT
//
// What sk/algorithm.hpp declares. A device may do it itself (DeviceState::reorder). Otherwise the order is computed on the
// host's cores, from keys that the device hands over; the streams then bring their elements into it
// (StreamState::permute).
#include "sk/algorithm.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "call/dense_regions.hpp"
#include "device/device_state.hpp"
#include "device/loop_state.hpp"
#include "device/stream_state.hpp"
#include "device/write_scope.hpp"
#include "sk/error.hpp"
#include "sk/host_vector.hpp"
#include "sk/limits.hpp"
#include "support/checked_size.hpp"
#include "support/radix_order.hpp"

namespace sk {

namespace {

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
  Permutation order, rest;
  order.reserve(size);
  for (std::size_t i = 0; i < size; ++i) (isFirst(i) ? order : rest).push_back(static_cast<std::int32_t>(i));
  count = static_cast<std::int64_t>(order.size());
  order.insert(order.end(), rest.begin(), rest.end());
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
