// SPDX-License-Identifier: MIT
#include "shadow/shadow_call.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include <fmt/format.h>

#include "device/loop_state.hpp"
#include "device/region.hpp"
#include "device/rows_state.hpp"
#include "shadow/call_record.hpp"
#include "shadow/copies.hpp"
#include "shadow/errors.hpp"
#include "shadow/given.hpp"
#include "shadow/recorder.hpp"
#include "shadow/results.hpp"

namespace sk {

using program::Role;
using shadow::Recorder;

namespace {

class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds) {}
  ~Stopwatch() {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& seconds_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The shadowed stream of an argument; null if there is none, or if it is of another device.
ShadowStream* shadowedOf(const ShadowDevice& device, const StreamRegion& region) {
  if (region.stream == nullptr || region.stream->device != &device) return nullptr;
  return static_cast<ShadowStream*>(region.stream);
}

/// The options on a device that belongs to the shadowed one; a domain that is given for another device stays so.
CallOptions on(const ShadowDevice& shadowed, DeviceState& device, CallOptions options) {
  if (options.over && options.over->device != nullptr)
    options.over->device = options.over->device == &shadowed ? &device : &options.over->device->underlying();
  return options;
}

std::vector<Argument> onPrimary(ShadowDevice& device, const ShadowedCall& call) {
  std::vector<Argument> arguments(call.arguments.begin(), call.arguments.end());
  for (Argument& argument : arguments) {
    if (ShadowStream* const stream = shadowedOf(device, argument.region))
      argument.region.stream = &stream->inner();
    argument.rows = device.rowsOn(device.primary(), argument.rows);
  }
  return arguments;
}

/// A region that is all of a temporary stream, in the place of a region of a program's stream.
StreamRegion inPlaceOf(const StreamRegion& region, NativeStream& stream) {
  StreamRegion other = detail::wholeRegion(&stream);
  other.placement = region.placement;
  return other;
}

bool isRead(Role role) { return role == Role::Input || role == Role::Gather || role == Role::Uniform; }

}  // namespace

void ShadowedCall::run(std::span<const Argument> others, std::span<void* const> values,
                       const CallOptions& with) const {
  switch (kind) {
    case Kind::Kernel: return sk::run(kernel, others, with);
    case Kind::Fold: return sk::fold(*reduction, others, with);
    case Kind::Scan: return sk::scan(*reduction, others, with);
    case Kind::Reduce: break;
  }
  if (values.empty()) return sk::reduce(*reduction, others, with);
  sk::reduce(*reduction, others, values, with);
}

namespace {

/// The choices of a reference: double or wider everywhere, and every function computed.
CallOptions referenceOptions(const ShadowDevice& shadowed, NativeDevice& device, const CallOptions& options) {
  CallOptions reference = on(shadowed, device, options);
  reference.accumulate = Accumulate::Default;
  reference.precision = Precision::Single;  // a reference computes in its own
  reference.intrinsics = Intrinsics::Accurate;
  reference.tables = Tables::Off;
  reference.target = Target::Native;
  reference.contraction = Contraction::Exact;
  return reference;
}

}  // namespace

CallFollower::CallFollower(ShadowDevice& device, const ShadowedCall& call)
    : device_(device), call_(call), ownReference_(device.ownReference(call.kernel)) {}

CallFollower::~CallFollower() { giveBack(); }

bool CallFollower::isWritten(std::size_t argument) const {
  const Role role = call_.kernel.parameters[argument].role;
  return role == Role::Output || role == Role::Accumulator || role == Role::VariableOutput ||
         role == Role::Scatter;
}

void CallFollower::run() {
  number_ = device_.nextCall();
  bool isFollowed = device_.isFollowing() && !device_.isGivenUp(call_.kernel);
  {
    Recorder::Access report(device_.recorder());
    kernel_ = Recorder::kernel(*report, call_.kernel.name);
    shadow::KernelRecord& record = report->kernels[static_cast<std::size_t>(kernel_)];
    isMeasured_ = isFollowed && device_.isChosen(call_.kernel) &&
                  record.calls % device_.recorder().options().every == 0;
    isKnown_ = record.followed > 0;
    ++record.calls;
    ++report->calls;
    if (record.calls == 1) record.choices = choicesText(device_.primary(), call_);
  }
  try {
    isFollowed = prepare() && isFollowed;
    if (isFollowed && isMeasured_) prepareOwn();
  } catch (const std::exception& error) {
    isFollowed = false;
    device_.giveUp(call_.kernel, error.what());
  }
  runOnDevice();
  if (isFollowed && isMeasured_ && !isRunOnce_)
    runOwn();  // before the reference replaces elements that it reads
  if (isFollowed && isMeasured_) examineInfluences();
  if (!isFollowed || !runOnReference()) {
    loseOutputs(true);
  } else if (isMeasured_) {
    hasOwn_ = hasOwn_ || isRunOnce_;
    if (!ownProblem_.empty()) device_.recorder().note(ownProblem_);
    compareAll();
  } else {
    estimateAll();
  }
  recordOrigins();
  recordTimes(device_.recorder(), kernel_, {seconds_, referenceSeconds_, comparisonSeconds_});
  for (const Written& written : written_) {
    if (written.stream == nullptr) continue;
    LastWrite& last = written.stream->last;
    last = {.kernel = kernel_,
            .output = std::string(parameterOf(written).name),
            .seconds = seconds_ / static_cast<double>(written_.size()),
            .elements = regionOf(written).shape.size(),
            .pushed = written.pushed};
  }
  device_.recorder().writeSometimes();
}

/// Notes whose outputs the call has read: errors grow where that leads back to its own.
void CallFollower::recordOrigins() {
  Recorder::Access report(device_.recorder());
  std::vector<int>& readFrom = report->kernels[static_cast<std::size_t>(kernel_)].readFrom;
  addNew(readFrom, origins_);
  for (const Written& written : written_) {
    if (written.stream == nullptr) continue;
    const bool isAll = !written.isPart && isWhole(regionOf(written));
    if (isAll) written.stream->origins.clear();
    addNew(written.stream->origins, {kernel_});
  }
}

/// Finds out what is read and written. Returns false if the reference lacks a stream.
bool CallFollower::prepare() {
  bool isComplete = true;
  for (std::size_t i = 0; i < call_.arguments.size() && i < call_.kernel.parameters.size(); ++i) {
    const Argument& argument = call_.arguments[i];
    ShadowStream* const stream = shadowedOf(device_, argument.region);
    if (stream == nullptr || argument.isNone || !isRead(call_.kernel.parameters[i].role)) continue;
    if (call_.kernel.parameters[i].role == Role::Uniform && argument.value != nullptr) continue;
    isComplete = stream->reference() != nullptr && isComplete;
    stream->noteRead(argument.region);
    read_.push_back({.argument = i, .stream = stream, .errors = stream->errors});
    addNew(origins_, stream->origins);
  }
  for (std::size_t i = 0; i < call_.arguments.size() && i < call_.kernel.parameters.size(); ++i) {
    const Argument& argument = call_.arguments[i];
    ShadowStream* const stream = shadowedOf(device_, argument.region);
    if (argument.isNone || !isWritten(i)) continue;
    if (stream == nullptr) {
      if (!call_.results.empty()) written_.push_back({.argument = i, .stream = nullptr, .isPart = false});
      continue;
    }
    const Role role = call_.kernel.parameters[i].role;
    const bool isPart = role == Role::Scatter || (role == Role::Output && !call_.options.box.isWhole());
    stream->settle();
    if (isPart) addNew(origins_, stream->origins);
    const bool isAll = role == Role::VariableOutput || (!isPart && isWhole(argument.region));
    isComplete = (isAll ? stream->room() : stream->reference()) != nullptr && isComplete;
    written_.push_back({.argument = i, .stream = stream, .isPart = isPart});
    stream->endWrite();
  }
  return isComplete;
}

StreamRegion CallFollower::regionOf(const Written& written) const {
  const StreamRegion& region = call_.arguments[written.argument].region;
  const bool isResized = parameterOf(written).role == Role::VariableOutput;
  return isResized ? detail::wholeRegion(written.stream) : region;
}

/// Makes sure of what the call reads, before it runs: it may overwrite that.
void CallFollower::prepareOwn() {
  const Stopwatch watch(comparisonSeconds_);
  isRunOnce_ = &ownReference_ == &device_.reference();
  for (Read& read : read_) {
    if (read.stream->errors.isEstimated) measureErrors(*read.stream);
    read.errors = read.stream->errors;
    prepareRead(read);
    isRunOnce_ = isRunOnce_ && read.stream->isSame();
  }
  for (const Written& written : written_)
    isRunOnce_ = isRunOnce_ && (!written.isPart || written.stream->isSame());
  for (Written& written : written_) prepareWritten(written);
}

void CallFollower::prepareRead(Read& read) {
  const StreamRegion& region = call_.arguments[read.argument].region;
  const bool isOverwritten = std::ranges::find(written_, read.stream, &Written::stream) != written_.end();
  const bool isQuad = &ownReference_ != &device_.reference();
  if (NativeStream* const all =
          isQuad ? nullptr : read.stream->deviceElements(isWhole(region), isOverwritten)) {
    read.device = region;
    read.device.stream = all;
    return;
  }
  read.copy = device_.ownTemporaries(call_.kernel).take(*read.stream->element, region.shape);
  copyElements(read.stream->innerOf(region), detail::wholeRegion(read.copy.get()));
  read.device = inPlaceOf(region, *read.copy);
}

void CallFollower::prepareWritten(Written& written) {
  const program::Element& element =
      written.stream != nullptr ? *written.stream->element : *parameterOf(written).element;
  const StreamRegion& region = call_.arguments[written.argument].region;
  if (!isRunOnce_ && parameterOf(written).role == Role::VariableOutput) {
    written.own = std::make_unique<NativeStream>(ownReference_, element, Shape{0}, Storage::Single);
  } else if (!isRunOnce_) {
    written.own = device_.ownTemporaries(call_.kernel)
                      .take(element, written.stream != nullptr ? region.shape : Shape{1});
    if (written.isPart) copyElements(written.stream->innerOf(region), detail::wholeRegion(written.own.get()));
  }
  if (written.stream != nullptr) written.before = written.stream->takeConverted();
}

void CallFollower::runOnDevice() {
  const std::vector<Argument> arguments = onPrimary(device_, call_);
  try {
    const Stopwatch watch(seconds_);
    call_.run(arguments, call_.results, on(device_, device_.primary(), call_.options));
    if (device_.primary().hasQueue()) device_.primary().finish();
  } catch (...) {
    loseOutputs(true);
    throw;
  }
  for (const Written& written : written_) {
    if (written.stream == nullptr) continue;
    written.stream->settle();
    written.stream->mirrorMarks();
    written.stream->refreshExposure();
  }
}

bool CallFollower::runOnReference() {
  try {
    const Stopwatch watch(referenceSeconds_);
    NativeDevice& reference = device_.reference();
    std::vector<Argument> arguments(call_.arguments.begin(), call_.arguments.end());
    for (Argument& argument : arguments) {
      if (ShadowStream* const stream = shadowedOf(device_, argument.region))
        argument.region.stream = stream->held();
      argument.rows = device_.rowsOn(reference, argument.rows);
    }
    for (Written& written : written_) {
      if (written.stream != nullptr) continue;
      written.total = device_.temporaries().take(*parameterOf(written).element, Shape{1});
      arguments[written.argument].region = detail::wholeRegion(written.total.get());
    }
    call_.run(arguments, {}, referenceOptions(device_, reference, call_.options));
  } catch (const std::exception& error) {
    device_.giveUp(call_.kernel, error.what());
    return false;
  }
  for (Written& written : written_) {
    if (written.stream == nullptr) continue;
    written.stream->becomeFresh();
    if (parameterOf(written).role == Role::VariableOutput)
      written.pushed = written.stream->held()->shape.size();
  }
  return true;
}

/// What the reference is given with the device's inputs.
std::vector<Argument> CallFollower::ownArguments() const {
  std::vector<Argument> arguments(call_.arguments.begin(), call_.arguments.end());
  for (Argument& argument : arguments) argument.rows = device_.rowsOn(ownReference_, argument.rows);
  for (const Read& read : read_) arguments[read.argument].region = read.device;
  for (const Written& written : written_) {
    const bool isResized = parameterOf(written).role == Role::VariableOutput;
    arguments[written.argument].region =
        isResized ? StreamRegion{written.own.get()}
                  : inPlaceOf(call_.arguments[written.argument].region, *written.own);
  }
  return arguments;
}

void CallFollower::examineInfluences() {
  const auto isWrong = [](const Read& read) { return read.errors.relative > 0; };
  const bool isWhole = std::ranges::all_of(written_, [&](const Written& written) {
    return !written.isPart && written.own != nullptr && parameterOf(written).role != Role::VariableOutput;
  });
  if (!hasOwn_ || !isWhole || &ownReference_ != &device_.reference() ||
      std::ranges::count_if(read_, isWrong) < 2 || !device_.influences().isDue(call_.kernel))
    return;
  try {
    const Stopwatch watch(comparisonSeconds_);
    for (const Read& read : read_) {
      if (isWrong(read)) examineInfluence(read);
    }
  } catch (const std::exception& error) {
    device_.recorder().note(
        fmt::format("whose errors count how much in {} is not known: {}", call_.kernel.name, error.what()));
  }
}

/// Makes the call with the reference's elements for one input, and compares with what all inputs of the device give.
void CallFollower::examineInfluence(const Read& read) {
  std::vector<Argument> arguments = ownArguments();
  arguments[read.argument].region = call_.arguments[read.argument].region;
  arguments[read.argument].region.stream = read.stream->held();
  std::vector<std::unique_ptr<NativeStream>> results;
  for (const Written& written : written_) {
    results.push_back(device_.temporaries().take(*written.own->element, written.own->shape));
    arguments[written.argument].region = inPlaceOf(call_.arguments[written.argument].region, *results.back());
  }
  call_.run(arguments, {}, referenceOptions(device_, ownReference_, call_.options));
  for (std::size_t i = 0; i < results.size(); ++i) {
    const shadow::OutputErrors change = shadow::compare(*results[i], nullptr, nullptr, *written_[i].own);
    device_.influences().set(
        call_.kernel, written_[i].argument, read.argument,
        std::max(change.relativeTotal(), change.relativeIntegers()) / read.errors.relative);
    device_.temporaries().giveBack(std::move(results[i]));
  }
}

void CallFollower::runOwn() {
  try {
    const Stopwatch watch(referenceSeconds_);
    const std::vector<Argument> arguments = ownArguments();
    call_.run(arguments, {}, referenceOptions(device_, ownReference_, call_.options));
    hasOwn_ = true;
  } catch (const std::exception& error) {
    ownProblem_ = fmt::format("the own error of {} is not known: {}", call_.kernel.name, error.what());
  }
}

/// The device has written elements that the reference has not.
void CallFollower::loseOutputs(bool isCounted) {
  for (const Written& written : written_) {
    if (written.stream == nullptr) continue;
    written.stream->settle();
    written.stream->mirrorMarks();
    written.stream->goStale(isCounted);
  }
}

void CallFollower::giveBack() {
  TemporaryStreams& temporaries = device_.ownTemporaries(call_.kernel);
  for (Read& read : read_) temporaries.giveBack(std::move(read.copy));
  for (Written& written : written_) {
    if (parameterOf(written).role != Role::VariableOutput) temporaries.giveBack(std::move(written.own));
    device_.temporaries().giveBack(std::move(written.before));
    device_.temporaries().giveBack(std::move(written.total));
    device_.temporaries().giveBack(std::move(written.device));
  }
}

void follow(ShadowDevice& device, const ShadowedCall& call) {
  const shadow::Options& options = device.recorder().options();
  if (!options.listsGiven && options.settings.empty()) return CallFollower(device, call).run();
  const GivenArguments given(device, call);
  CallFollower(device, given.call()).run();
}

namespace {

class RecordedShadowedCall final : public RecordedCall {
 public:
  RecordedShadowedCall(ShadowDevice& device, const ShadowedCall& call)
      : device_(device), arguments_(call.kernel, call.arguments), call_(call) {
    call_.arguments = arguments_.get();
    for (const Argument& argument : call_.arguments)
      rows_.push_back(std::make_unique<SharedRows>(argument.rows));
    arguments_.noteUses(*device.recording);
  }

  void run() override { follow(device_, call_); }

 private:
  ShadowDevice& device_;
  const OwnedArguments arguments_;
  std::vector<std::unique_ptr<SharedRows>> rows_;
  ShadowedCall call_;
};

}  // namespace

std::unique_ptr<RecordedCall> recordShadowed(ShadowDevice& device, const ShadowedCall& call) {
  // The device records the call and forgets it: so it checks what it checks of recorded calls.
  LoopState checks(device.primary());
  call.run(onPrimary(device, call), call.results, on(device, device.primary(), call.options));
  checks.finish();
  return std::make_unique<RecordedShadowedCall>(device, call);
}

}  // namespace sk
