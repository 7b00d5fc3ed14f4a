// SPDX-License-Identifier: MIT
//
// What sk/algorithm.hpp declares. A device may do it itself (DeviceState::reorder). Otherwise the order is computed on the
// host's cores, from keys that the device hands over; the streams then bring their elements into it
// (StreamState::permute).
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "call/host_order.hpp"
#include "device/device_state.hpp"
#include "device/loop_state.hpp"
#include "device/stream_state.hpp"
#include "results/recorder.hpp"
#include "sk/algorithm.hpp"
#include "sk/error.hpp"
#include "sk/host_vector.hpp"
#include "sk/limits.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

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

/// Has the keys, if they move, and the values reordered. Returns how many elements come first, if the order chooses them.
std::int64_t reorder(DeviceState& device, Reordering::By by, const StreamRegion& keys, bool movesKeys,
                     const StreamRegion* values, const StreamRegion* places = nullptr) {
  if (keys.shape.size() == 0) return 0;
  std::vector<StreamRegion> moved;
  if (movesKeys) moved.push_back(keys);
  if (values != nullptr) moved.push_back(*values);
  const Reordering order{.by = by, .keys = keys, .moved = moved, .places = places};
  if (const auto first = device.reorder(order)) return *first;
  const HostOrder found = hostOrder(by, keys);
  bringInto(order, found);
  return found.first;
}

Reordering::By byKeys(const SortOptions& options) {
  return options.descending ? Reordering::By::DescendingKeys : Reordering::By::Keys;
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
    reorder(device, byKeys(options), keys, true, values);
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
    reorder(device, byKeys(options), keys, false, nullptr, &all);
    return StreamOwner(stream.release());
  });
}

std::int64_t detail::unique(const StreamRegion& keys, const StreamRegion* values) {
  return withHostMemory("sk::unique", [&] {
    DeviceState& device = checkStreams(keys, values, "sk::unique", "keys");
    const TraceScope traced(device.trace.get(), "call", "sk::unique");
    return reorder(device, Reordering::By::Changes, keys, true, values);
  });
}

std::int64_t detail::partition(const StreamRegion& flags, const StreamRegion& values) {
  return withHostMemory("sk::partition", [&] {
    DeviceState& device = checkStreams(flags, &values, "sk::partition", "flags");
    const TraceScope traced(device.trace.get(), "call", "sk::partition");
    return reorder(device, Reordering::By::Flags, flags, false, &values);
  });
}

}  // namespace sk
