// SPDX-License-Identifier: MIT
#include "shadow/results.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include <fmt/format.h>

#include "device/region.hpp"
#include "shadow/copies.hpp"
#include "shadow/errors.hpp"
#include "shadow/shadow_device.hpp"
#include "shadow/shadow_stream.hpp"

namespace sk {

using shadow::OutputErrors;
using shadow::Recorder;

namespace {

ShadowDevice& deviceOf(const ShadowStream& stream) { return static_cast<ShadowDevice&>(*stream.device); }

OutputErrors errorsIn(ShadowStream& stream, const StreamRegion& region, NativeStream& reference) {
  NativeStream* const all = isWhole(region) ? stream.deviceElements(true, false) : nullptr;
  if (all != nullptr) return shadow::compare(*all, nullptr, nullptr, reference);
  TemporaryStreams& temporaries = deviceOf(stream).temporaries();
  std::unique_ptr<NativeStream> device = temporaries.take(*stream.element, region.shape), copied;
  copyElements(stream.innerOf(region), detail::wholeRegion(device.get()));
  StreamRegion there = region;
  there.stream = &reference;
  if (!isAllInOrder(there)) {
    copied = temporaries.take(*stream.element, region.shape);
    copyElements(there, detail::wholeRegion(copied.get()));
  }
  const OutputErrors errors = shadow::compare(*device, nullptr, nullptr, copied ? *copied : reference);
  temporaries.giveBack(std::move(device));
  temporaries.giveBack(std::move(copied));
  return errors;
}

void recordResult(ShadowStream& stream, const StreamRegion& region) {
  const auto start = std::chrono::steady_clock::now();
  NativeStream* const reference = stream.reference();
  if (reference == nullptr) return;
  const OutputErrors errors = errorsIn(stream, region, *reference);
  const std::string name = stream.describe();
  Recorder::Access report(deviceOf(stream).recorder());
  shadow::ResultRecord& result = report->results[Recorder::result(*report, name, false)];
  ++result.reads;
  result.elements = region.shape.size();
  result.numbers = result.elements * shadow::realComponents(*stream.element);
  result.last = std::max(errors.reportedTotal(), errors.relativeIntegers());
  result.exception = stream.errors.exception;
  const bool isWorst = result.last >= result.largest;
  result.largest = std::max(result.largest, result.last);
  result.differs += errors.decisions.count;
  result.notFinite = errors.newNans.count + errors.newInfinities.count;
  result.withoutValue = std::max(result.withoutValue, errors.nans.count + errors.infinities.count);
  if (isWorst) result.shares = stream.errors.shares;
  if (result.last > 0 && result.shares.all().empty()) result.shares.add(stream.last.kernel, 1);
  report->comparisonSeconds +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void recordRead(ShadowStream& stream, const StreamRegion& region) {
  stream.noteRead(region);
  ShadowDevice& device = deviceOf(stream);
  const bool isForProgram = device.internalWork == 0;  // not for the runtime, as the condition of a loop is
  if (!device.isFollowing() || region.shape.size() == 0 || !isForProgram) return;
  try {
    recordResult(stream, region);
  } catch (const std::exception& error) {
    device.recorder().note(
        fmt::format("what the program read of {} was not compared: {}", stream.describe(), error.what()));
  }
}

void recordLifetime(ShadowStream& stream) {
  const LastWrite& last = stream.last;
  double unread = last.isReadWhole ? 0 : static_cast<double>(last.elements);
  if (last.isRead && !last.isReadWhole) {
    double inside = 1;
    for (int d = 0; d < stream.shape.rank(); ++d)
      inside *= static_cast<double>(last.readEnd[d] - last.readBegin[d]);
    unread = std::max(0.0, static_cast<double>(last.elements) - inside);
  }
  try {
    const std::string name = stream.describe();
    Recorder::Access report(deviceOf(stream).recorder());
    if (last.kernel >= 0 && !last.isRead) {
      shadow::KernelRecord& kernel = report->kernels[static_cast<std::size_t>(last.kernel)];
      shadow::OutputRecord& output =
          kernel.outputs[Recorder::output(kernel, last.output, stream.element->name)];
      ++output.unreadCalls;
      output.unreadSeconds += last.seconds;
    }
    if (stream.name.empty() && stream.shape.size() == 1) return;
    auto found = std::ranges::find(report->streams, name, &shadow::StreamRecord::name);
    constexpr std::size_t most = 2000;
    if (found == report->streams.end()) {
      if (report->streams.size() >= most) return;
      shadow::StreamRecord record;
      record.name = name;
      record.type = stream.element->name;
      for (int d = 0; d < stream.shape.rank(); ++d) record.shape.push_back(stream.shape[d]);
      report->streams.push_back(record);
      found = report->streams.end() - 1;
    }
    found->resyncs += std::exchange(stream.resyncs, 0);
    found->points.add({report->calls, 0, 0, stream.errors.relative, 0});
    if (last.kernel < 0) return;
    found->written += static_cast<double>(last.elements);
    if (!last.isRead) return;
    found->unread += unread;
    found->unreadSeconds += last.seconds * unread / static_cast<double>(last.elements);
  } catch (const std::bad_alloc&) {
    return;  // the report lacks this stream
  }
}

void recordOrder(ShadowStream& stream, const StreamRegion& keys) {
  const auto& held = static_cast<const NativeStream&>(*keys.stream);
  if (!isAllInOrder(keys)) return;
  std::int64_t count = 0, first = -1;
  for (std::int64_t i = 1; i < keys.shape.size(); ++i) {
    if (!(shadow::valueAt(held, 0, i - 1) > shadow::valueAt(held, 0, i))) continue;
    if (count++ == 0) first = i;
  }
  deviceOf(stream).setSortedKeys(nullptr);
  if (count == 0) return;
  const std::string name = stream.describe();
  Recorder::Access report(deviceOf(stream).recorder());
  const int kernel = Recorder::kernel(*report, "sk::sort");
  report->kernels[static_cast<std::size_t>(kernel)].decisions += count;
  const bool isKnown =
      std::ranges::any_of(report->decisions, [&](const auto& each) { return each.kernel == kernel; });
  if (isKnown) return;
  shadow::ElementRecord element;
  element.call = report->calls;
  element.output = name;
  element.index = {first};
  element.device = shadow::valueAt(held, 0, first - 1);
  element.reference = shadow::valueAt(held, 0, first);
  report->decisions.push_back({kernel, count, true, element});
}

}  // namespace sk
