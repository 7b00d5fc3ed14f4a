// SPDX-License-Identifier: MIT
//
// Sorting and its like on a shadowed device. An order is a decision: the device's is compared with the one that the reference's keys
// ask for, and the reference then takes its own or the device's, as the option `decisions=` says.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "call/host_order.hpp"
#include "device/region.hpp"
#include "shadow/copies.hpp"
#include "shadow/results.hpp"
#include "shadow/shadow_device.hpp"
#include "shadow/shadow_stream.hpp"
#include "sk/types.hpp"

namespace sk {

using shadow::Recorder;

namespace {

std::string_view nameOf(const Reordering& order) {
  switch (order.by) {
    case Reordering::By::Changes: return "sk::unique";
    case Reordering::By::Flags: return "sk::partition";
    case Reordering::By::Keys:
    case Reordering::By::DescendingKeys: break;
  }
  return order.places != nullptr ? "sk::order" : "sk::sort";
}

/// The order that the reference's keys ask for; nullopt if it has none.
std::optional<HostOrder> expectedOrder(const ShadowDevice& device, const Reordering& order) {
  NativeStream* const held = device.isFollowing() ? shadowStream(order.keys).reference() : nullptr;
  if (held == nullptr) return std::nullopt;
  StreamRegion there = order.keys;
  there.stream = held;
  return hostOrder(order.by, there);
}

/// Has the device's own elements reordered, and returns how.
HostOrder reorderPrimary(DeviceState& primary, const Reordering& order, bool isWanted) {
  std::unique_ptr<StreamState> own;
  StreamRegion places;
  Reordering asked = order;
  if (order.places == nullptr && isWanted) {
    own = primary.createStream(ElementTraits<std::int32_t>::element(), order.keys.shape, Storage::Single);
    places = detail::wholeRegion(own.get());
    asked.places = &places;
  }
  const std::optional<std::int64_t> first = primary.reorder(asked);
  if (!first) {
    HostOrder found = hostOrder(order.by, order.keys);
    bringInto(order, found);
    return found;
  }
  HostOrder found{.sources = {}, .first = *first};
  if (!isWanted) return found;
  found.sources.resize(static_cast<std::size_t>(order.keys.shape.size()));
  detail::read(*asked.places, found.sources.data(), found.sources.size());
  return found;
}

void recordOrders(ShadowStream& keys, const Reordering& order, const HostOrder& device,
                  const HostOrder& expected) {
  if (order.choosesFirst()) {
    recordCount(keys, fmt::format("{} of {} (number of elements)", nameOf(order), keys.describe()),
                device.first, expected.first);
  }
  std::int64_t count = 0, first = -1;
  for (std::size_t i = 0; i < device.sources.size(); ++i) {
    if (device.sources[i] != expected.sources[i] && count++ == 0) first = static_cast<std::int64_t>(i);
  }
  if (count == 0) return;
  const std::string output = fmt::format("order of {}", keys.describe());
  Recorder::Access report(static_cast<ShadowDevice&>(*keys.device).recorder());
  const int kernel = Recorder::kernel(*report, nameOf(order));
  report->kernels[static_cast<std::size_t>(kernel)].decisions += count;
  const bool isKnown =
      std::ranges::any_of(report->decisions, [&](const auto& each) { return each.kernel == kernel; });
  if (isKnown) return;
  shadow::ElementRecord element;
  element.call = report->calls;
  element.output = output;
  element.index = {first};
  element.device = device.sources[static_cast<std::size_t>(first)];
  element.reference = expected.sources[static_cast<std::size_t>(first)];
  element.isReal = false;
  report->decisions.push_back({kernel, count, true, element, keys.errors.relative});
}

/// The reference's elements follow an order.
void followOrder(ShadowDevice& device, const Reordering& order, const HostOrder& taken, bool isOfDevice) {
  const StreamErrors ofKeys = shadowStream(order.keys).errors;
  for (const StreamRegion& region : order.moved) {
    ShadowStream& stream = shadowStream(region);
    NativeStream* const held = stream.held();
    if (held == nullptr || stream.isStale()) continue;
    StreamRegion there = region;
    there.stream = held;
    held->permute(there, taken.sources);
    if (isOfDevice) continue;
    stream.errors.isEstimated = true;
    stream.errors.shares = ofKeys.shares;
    stream.errors.relative = 1;
    measureErrors(stream);
  }
  if (order.places == nullptr) return;
  ShadowStream& places = shadowStream(*order.places);
  NativeStream* const held = device.isFollowing() ? places.room() : nullptr;
  if (held == nullptr || isOfDevice) return places.goStale(false);
  held->write(detail::wholeRegion(held), reinterpret_cast<const std::byte*>(taken.sources.data()));
  places.becomeFresh();
  places.errors = {};
  places.errors.isEstimated = true;
  places.errors.shares = ofKeys.shares;
  places.errors.relative = 1;
  measureErrors(places);
}

}  // namespace

std::optional<std::int64_t> ShadowDevice::reorder(const Reordering& order) {
  ShadowStream& keys = shadowStream(order.keys);
  keys.noteRead(order.keys);
  std::vector<StreamRegion> moved;
  for (const StreamRegion& region : order.moved) {
    ShadowStream& stream = shadowStream(region);
    stream.noteRead(region);
    if (isFollowing()) stream.reference();  // takes over what it lacks before the elements move
    moved.push_back(stream.innerOf(region));
  }
  const std::optional<HostOrder> expected = expectedOrder(*this, order);
  StreamRegion places;
  if (order.places != nullptr) places = shadowStream(*order.places).innerOf(*order.places);
  const Reordering inner{.by = order.by,
                         .keys = keys.innerOf(order.keys),
                         .moved = moved,
                         .places = order.places != nullptr ? &places : nullptr};
  const auto forWritten = [&](auto&& use) {
    for (const StreamRegion& region : order.moved) use(shadowStream(region));
    if (order.places != nullptr) use(shadowStream(*order.places));
  };
  HostOrder found;
  try {
    found = reorderPrimary(*primary_, inner, isFollowing());
  } catch (...) {
    forWritten([](ShadowStream& stream) {
      stream.mirrorMarks();
      stream.goStale(false);
    });
    throw;
  }
  forWritten([](ShadowStream& stream) {
    stream.mirrorMarks();
    stream.refreshExposure();
  });
  if (!isFollowing()) return found.first;
  if (expected) recordOrders(keys, order, found, *expected);
  const bool isOfDevice =
      !expected || recorder_.options().followsDecisions || expected->sources == found.sources;
  followOrder(*this, order, isOfDevice ? found : *expected, isOfDevice);
  return found.first;
}

}  // namespace sk
