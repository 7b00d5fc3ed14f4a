// SPDX-License-Identifier: MIT
#include "shadow/results.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
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
  StreamErrors known = stream.errors;
  known.measure(std::max(errors.relativeTotal(), errors.relativeIntegers()));
  if (isWorst) result.shares = known.shares;
  if (isWhole(region)) stream.errors = known;
  if (result.last > 0 && result.shares.all().empty()) result.shares.add(stream.last.kernel, 1);
  report->comparisonSeconds +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void measureErrors(ShadowStream& stream) {
  NativeStream* const reference = stream.reference();
  if (reference == nullptr) return;
  const OutputErrors errors = errorsIn(stream, detail::wholeRegion(&stream), *reference);
  double measured = std::max(errors.relativeTotal(), errors.relativeIntegers());
  if (errors.lost > 0) measured = std::max(measured, 1.0);
  stream.errors.measure(measured);
  stream.errors.hasNan = errors.nans.count > 0;
  stream.errors.hasInfinity = errors.infinities.count > 0;
}

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

void recordCount(ShadowStream& stream, const std::string& name, std::int64_t device, std::int64_t reference) {
  Recorder::Access report(deviceOf(stream).recorder());
  shadow::ResultRecord& result = report->results[Recorder::result(*report, name, true)];
  ++result.reads;
  result.elements = 1;
  const auto difference = static_cast<double>(std::abs(device - reference));
  result.last = std::min(1.0, difference / static_cast<double>(std::max<std::int64_t>(1, reference)));
  const bool isWorst = result.last >= result.largest;
  result.largest = std::max(result.largest, result.last);
  result.differs += device == reference ? 0 : 1;
  if (!isWorst) return;
  result.shares = stream.errors.shares;
  if (result.last > 0 && result.shares.all().empty()) result.shares.add(stream.last.kernel, 1);
}

}  // namespace sk
