// SPDX-License-Identifier: MIT
#include "shadow/shadow_device.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "call/check_written.hpp"
#include "call/resolved_call.hpp"
#include "device/loop_state.hpp"
#include "device/rows_state.hpp"
#include "native/entries.hpp"
#include "shadow/copies.hpp"
#include "shadow/results.hpp"
#include "shadow/shadow_call.hpp"
#include "shadow/shadow_staging.hpp"
#include "sk/error.hpp"
#include "sk/types.hpp"

namespace sk {

std::unique_ptr<NativeStream> TemporaryStreams::take(const program::Element& element, const Shape& shape) {
  // the one that was given back last is the likeliest to be in a cache
  const auto found = std::find_if(streams_.rbegin(), streams_.rend(), [&](const auto& stream) {
    return stream->element == &element && stream->shape == shape;
  });
  std::unique_ptr<NativeStream> stream;
  if (found == streams_.rend()) {
    stream = std::make_unique<NativeStream>(device_, element, shape, Storage::Single);
  } else {
    stream = std::move(*found);
    streams_.erase(std::next(found).base());
    free_ -= bytesOf(*stream);
  }
  countTaken(bytesOf(*stream));
  return stream;
}

void TemporaryStreams::countTaken(std::int64_t bytes) {
  taken_ += bytes;
  mostTaken_ = std::max(mostTaken_, taken_);
}

void TemporaryStreams::giveBack(std::unique_ptr<NativeStream> stream) {
  if (stream == nullptr) return;
  countTaken(-bytesOf(*stream));
  free_ += bytesOf(*stream);
  streams_.push_back(std::move(stream));
  trim();
}

void TemporaryStreams::trim() {
  constexpr std::size_t most = 64;  // a search among many takes long
  while (!streams_.empty() && (owner_.roomForTemporaries() < 0 || streams_.size() > most)) {
    free_ -= bytesOf(*streams_.front());
    streams_.erase(streams_.begin());
  }
}

void ShadowDevice::keep(std::int64_t bytes) {
  temporaries_.countTaken(-bytes);
  kept_ += bytes;
  temporaries_.trim();
}

void ShadowDevice::takeKept(std::int64_t bytes) {
  kept_ -= bytes;
  temporaries_.countTaken(bytes);
}

std::int64_t ShadowDevice::roomForTemporaries() const {
  std::int64_t room = mostKept() - kept_;
  room += temporaries_.mostTakenBytes() - temporaries_.freeBytes();
  if (quadTemporaries_) room += quadTemporaries_->mostTakenBytes() - quadTemporaries_->freeBytes();
  return room;
}

struct ShadowDevice::RowsCopy {
  RowsCopy(const RowsState& given, DeviceState& on)
      : original(&given),
        shared(&given),
        device(&on),
        copy(new RowsState(on, {given.pieces().starts().begin(), given.pieces().starts().end()})) {}
  ~RowsCopy() { copy->leave(); }
  RowsCopy(const RowsCopy&) = delete;
  RowsCopy& operator=(const RowsCopy&) = delete;

  const RowsState* original;
  SharedRows shared;  ///< so that no other rows get the address
  DeviceState* device;
  RowsState* copy;
};

ShadowDevice::ShadowDevice(std::unique_ptr<DeviceState> primary, shadow::Recorder& recorder)
    : primary_(std::move(primary)),
      recorder_(recorder),
      reference_(std::make_unique<NativeDevice>(RealType::Double)),
      temporaries_(*reference_, *this) {
  reference_->isSilent = true;  // the device prints
  interposed = this;
  limits = primary_->limits;
  memoryLimit = primary_->memoryLimit;
  configuration = primary_->configuration;
  runsCallByCall = true;
  primary_->runsCallByCall = true;
  memoryLimit_ = recorder_.options().memory;
  if (memoryLimit_ == 0) memoryLimit_ = reference_->availableMemory().value_or(INT64_MAX) / 2;
  if (std::exchange(primary_->results, nullptr) != nullptr)
    recorder_.note(
        "SK_RESULTS records nothing beside a shadow, whose own reads it would count; unset one of them");
  recorder_.deviceBegins(primary_->name());
}

ShadowDevice::~ShadowDevice() {
  while (firstStream() != nullptr) {
    auto& stream = static_cast<ShadowStream&>(*firstStream());
    stream.endWrite();
    stream.leave();
    stream.empty();
  }
  rows_.clear();
  recorder_.deviceEnds();
}

std::int64_t ShadowDevice::nextCall() {
  shadow::Recorder::Access report(recorder_);
  return report->calls + 1;
}

bool ShadowDevice::takeMemory(std::int64_t bytes) {
  if (memory_ + bytes > memoryLimit_) return false;
  memory_ += bytes;
  return true;
}

NativeDevice& ShadowDevice::ownReference(const program::Kernel& kernel) {
  const bool isQuad = shadow::matchesAny(recorder_.options().quad, kernel.name) && kernel.code != nullptr &&
                      hasCodeFor(*kernel.code, RealType::Quad);
  if (!isQuad) {
    if (shadow::matchesAny(recorder_.options().quad, kernel.name))
      recorder_.note(fmt::format("{} has no code in __float128 (skc --quad), and is compared with doubles",
                                 kernel.name));
    return *reference_;
  }
  if (!quad_) {
    quad_ = std::make_unique<NativeDevice>(RealType::Quad);
    quad_->isSilent = true;
    quadTemporaries_ = std::make_unique<TemporaryStreams>(*quad_, *this);
  }
  return *quad_;
}

TemporaryStreams& ShadowDevice::ownTemporaries(const program::Kernel& kernel) {
  return &ownReference(kernel) == reference_.get() ? temporaries_ : *quadTemporaries_;
}

const RowsState* ShadowDevice::rowsOn(DeviceState& device, const RowsState* rows) {
  if (rows == nullptr || rows->device() != this) return rows;  // calls refuse those of another device
  const auto known = std::ranges::find_if(rows_, [&](const std::unique_ptr<RowsCopy>& each) {
    return each->original == rows && each->device == &device;
  });
  if (known != rows_.end()) return (*known)->copy;
  constexpr std::size_t most = 64;
  if (rows_.size() == most) rows_.erase(rows_.begin());
  return rows_.emplace_back(std::make_unique<RowsCopy>(*rows, device))->copy;
}

bool ShadowDevice::isChosen(const program::Kernel& kernel) const {
  const std::vector<std::string>& chosen = recorder_.options().kernels;
  return chosen.empty() || shadow::matchesAny(chosen, kernel.name);
}

void ShadowDevice::giveUp(const program::Kernel& kernel, const std::string& why) {
  if (!givenUp_.emplace(&kernel, why).second) return;
  recorder_.note(fmt::format("{} is not followed: {}", kernel.name, why));
}

namespace {

/// A fault of the runtime: the functions of Distribution take all calls.
[[noreturn]] void failForStep(const program::Kernel& kernel) {
  throw Error(fmt::format("{}: a step of a call has reached a shadowed device", kernel.name));
}

void followOrRecord(ShadowDevice& device, const ShadowedCall& call) {
  if (device.recording != nullptr) return device.recording->add(recordShadowed(device, call));
  follow(device, call);
}

}  // namespace

void ShadowDevice::run(const program::Kernel& kernel, std::span<const Argument> arguments,
                       const CallOptions& options) {
  followOrRecord(*this, {ShadowedCall::Kind::Kernel, kernel, nullptr, arguments, {}, options});
}

void ShadowDevice::reduce(const program::Reduction& reduction, std::span<const Argument> arguments,
                          std::span<void* const> results, const CallOptions& options) {
  followOrRecord(*this,
                 {ShadowedCall::Kind::Reduce, reduction.fold, &reduction, arguments, results, options});
}

void ShadowDevice::fold(const program::Reduction& reduction, std::span<const Argument> arguments,
                        const CallOptions& options) {
  followOrRecord(*this, {ShadowedCall::Kind::Fold, reduction.fold, &reduction, arguments, {}, options});
}

void ShadowDevice::scan(const program::Reduction& reduction, std::span<const Argument> arguments,
                        const CallOptions& options) {
  followOrRecord(*this, {ShadowedCall::Kind::Scan, reduction.fold, &reduction, arguments, {}, options});
}

void ShadowDevice::noteLoopEnd(const StreamRegion& condition, std::int64_t iterations, bool isDone) {
  if (!isFollowing()) return;
  const std::string name = shadowStream(condition).describe();
  shadow::Recorder::Access report(recorder_);
  auto found = std::ranges::find(report->loops, name, &shadow::LoopRecord::condition);
  if (found == report->loops.end()) {
    report->loops.emplace_back().condition = name;
    found = report->loops.end() - 1;
  }
  ++found->runs;
  found->unfinished += isDone ? 0 : 1;
  found->longest = std::max(found->longest, iterations);
}

void ShadowDevice::run(const ResolvedCall& call) { failForStep(call.kernel); }

void ShadowDevice::reduce(const ResolvedReduction& call) { failForStep(call.reduction.fold); }

std::unique_ptr<StreamState> ShadowDevice::createStream(const program::Element& element, const Shape& shape,
                                                        Storage storage) {
  return std::make_unique<ShadowStream>(*this, primary_->createStream(element, shape, storage));
}

std::unique_ptr<RecordedCall> ShadowDevice::prepareScalars(ScalarPass pass) {
  return prepareShadowedScalars(*this, std::move(pass));
}

std::unique_ptr<Staging> ShadowDevice::makeStaging(Staging::Way way) {
  return std::make_unique<ShadowStaging>(*this, way);
}

std::unique_ptr<DeviceState> withShadow(std::unique_ptr<DeviceState> device) {
  const char* const option = std::getenv("SK_SHADOW");
  if (option == nullptr || *option == '\0') return device;
  shadow::Recorder* const recorder = shadow::Recorder::ofProcess(option);
  if (recorder == nullptr || !recorder->isInOwnProcess()) return device;
  if (device->isReference()) {
    recorder->deviceStaysAlone(device->name(),
                               "the reference device has no shadow: it computes what others are compared "
                               "with; choose another device");
    return device;
  }
  if (checksWritten()) {
    recorder->deviceStaysAlone(device->name(),
                               "nothing is followed: SK_CHECK=written runs calls several times; unset it");
    return device;
  }
  return std::make_unique<ShadowDevice>(std::move(device), *recorder);
}

}  // namespace sk
