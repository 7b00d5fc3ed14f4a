// SPDX-License-Identifier: MIT
//
// sk::run: checks and resolves a call of a kernel and passes it to its device. Must not depend on the kind of
// device.
#include <memory>
#include <optional>
#include <utility>

#include "call/box.hpp"
#include "call/check_asserts.hpp"
#include "call/check_call.hpp"
#include "call/check_halos.hpp"
#include "call/check_ranges.hpp"
#include "call/check_unwritten_reads.hpp"
#include "call/check_written.hpp"
#include "call/distribution.hpp"
#include "call/placed.hpp"
#include "call/resolved_call.hpp"
#include "device/device_state.hpp"
#include "device/loop_state.hpp"
#include "results/call_scope.hpp"
#include "sk/call.hpp"
#include "support/checked_size.hpp"

namespace sk {

using program::Kernel;

namespace {

void runUnchecked(DeviceState& device, const ResolvedCall& call, RecordedCall* prepared) {
  if (prepared != nullptr) return prepared->run();
  const DenseArguments dense(call.kernel, call.arguments);
  if (dense.areAsGiven()) return device.run(call);
  ResolvedCall denseCall = call;
  denseCall.arguments = dense.get();
  device.run(denseCall);
  dense.finish();
}

/// Runs the call with SK_CHECK=written.
void runCheckingWritten(DeviceState& device, const ResolvedCall& call, RecordedCall* prepared) {
  const auto repeat = [&](std::span<const Argument> arguments, std::span<void* const>) {
    ResolvedCall other = call;
    other.arguments = arguments;
    runUnchecked(device, other, nullptr);
  };
  const bool isBoxOfWhole = call.place.whole.rank() == 0;
  runChecked({.device = device,
              .kernel = call.kernel,
              .arguments = call.arguments,
              .box = call.options.box,
              .isBoxOfWhole = isBoxOfWhole,
              .run = repeat},
             [&] { runUnchecked(device, call, prepared); });
}

/// Runs the call, as it was prepared unless `prepared` is null.
void runResolved(DeviceState& device, const ResolvedCall& call, RecordedCall* prepared = nullptr) {
  const results::CallScope measured(device, call.kernel.name);
  const TraceScope traced(device.trace.get(), "call", call.kernel.name);
  traced.add("domain", call.domain);
  checksWritten() ? runCheckingWritten(device, call, prepared) : runUnchecked(device, call, prepared);
}

class RecordedKernel final : public RecordedCall {
 public:
  RecordedKernel(DeviceState& device, const ResolvedCall& call)
      : device_(device), arguments_(call.kernel, call.arguments), call_(call) {
    call_.arguments = arguments_.get();
    arguments_.noteUses(*device.recording);
  }

  void run() override {
    prepare();
    runResolved(device_, call_, prepared_.get());
  }
  std::string_view name() const override { return call_.kernel.name; }
  RecordedCall* onDevice() override {
    prepare();
    return prepared_.get();
  }
  std::string_view whyNotOnDevice() const override {
    return "it reads or writes copies of its streams: of views with strides, of parts that overlap, or in "
           "another precision";
  }
  bool addUses(std::vector<StreamUse>& uses) const override {
    arguments_.addUses(uses);
    return true;
  }

 private:
  void prepare() {
    if (!std::exchange(isPrepared_, true) && !needsDenseArguments(call_.kernel, call_.arguments))
      prepared_ = device_.prepare(call_);
  }

  DeviceState& device_;
  const OwnedArguments arguments_;
  ResolvedCall call_;
  bool isPrepared_ = false;
  std::unique_ptr<RecordedCall> prepared_;
};

/// What is pushed decides the shapes of later calls, which are checked before.
void record(DeviceState& device, const ResolvedCall& call) {
  for (const program::Parameter& parameter : call.kernel.parameters) {
    if (parameter.role != program::Role::VariableOutput) continue;
    fail(call.kernel,
         "'{}' is a variable output, and how many elements are pushed to it is not known before it runs; "
         "call the "
         "kernel outside of Device::record",
         parameter.name);
  }
  device.recording->add(std::make_unique<RecordedKernel>(device, call));
}

/// Variants with unrolled loops compute in float.
const Kernel& chosenVariant(const DeviceState& device, const ResolvedCall& call) {
  const bool isInFloat = !device.isReference() && !needsPrecisionVariant(call.options);
  return isInFloat ? unrolledVariant(call.kernel, call.specs) : call.kernel;
}

/// Runs or records a call with placed streams, in terms of what they hold if that is the same.
void runInParts(DeviceState& device, const ResolvedCall& given) {
  ResolvedCall call = given;
  std::optional<LocalCall> local = localCall(given, given.options.box);
  if (!local && device.placesDomains()) local = partCall(given, given.options.box);
  if (local) {
    call.arguments = local->arguments;
    call.domain = local->domain;
    call.options.box = local->box;
    call.place = local->place;
  }
  const ResolvedCall chosen = call.of(chosenVariant(device, call), device.limits);
  device.recording != nullptr ? record(device, chosen) : runResolved(device, chosen);
}

/// `given`: the call as the application made it.
void checkRangesOf(DeviceState& device, const Kernel& kernel, std::span<const Argument> arguments,
                   const CallOptions& given) {
  if (!checksRanges()) return;  // without allocating what repeats the call
  const auto repeat = [&kernel, given](std::span<const Argument> others, std::span<void* const>) {
    sk::run(kernel, others, given);
  };
  checkRanges({.device = device, .kernel = kernel, .arguments = arguments, .box = given.box, .run = repeat});
}

void runPlaced(DeviceState& device, const ResolvedCall& checked, const CallOptions& given) {
  ResolvedCall call = checked;
  call.options.box = boxOrAll(given.box, call.domain);
  checkBoxedCall(call.kernel, call.arguments, call.options.box, call.domain);
  checkPlacedCall(call, call.options.box, device.limits.elements);
  checkAssertions(device, call.kernel, call.arguments, call.domain, call.options);
  checkRangesOf(device, call.kernel, call.arguments, given);
  if (checksHalos() && device.recording == nullptr)
    checkPlacedHalos(device, call, [&](const ResolvedCall& part) { runInParts(device, part); });
  runInParts(device, call);
}

void checkAndRun(const Kernel& kernel, std::span<const Argument> arguments, const CallOptions& options) {
  if (options.accumulate != Accumulate::Default) {
    fail(kernel, "it has no accumulator, since it is not a reduce; call it without Accumulate");
  }
  refuseScanOptions(kernel, options);
  std::optional<CheckedCall> checked = checkCall(kernel, arguments, options.over);
  if (!checked) return;
  DeviceState& device = checked->device;
  checked->call.options = device.configuration.resolve(kernel, options);
  results::noteCall(device, kernel, nullptr, options, checked->call.options);
  checkTables(kernel, checked->call.options);
  if (hasPlaced(arguments)) return runPlaced(device, checked->call, options);
  if (!options.box.isWhole()) {
    checkBoxedCall(kernel, arguments, options.box, checked->call.domain);
    if (isAll(options.box, checked->call.domain)) checked->call.options.box = {};
  }
  checkAssertions(device, kernel, arguments, checked->call.domain, checked->call.options);
  checkRangesOf(device, kernel, arguments, options);
  const ResolvedCall call = checked->call.of(chosenVariant(device, checked->call), device.limits);
  if (device.recording != nullptr) return record(device, call);
  if (checksHalos()) {
    checkHalos(device, checked->call, [&](const ResolvedCall& line) { runResolved(device, line); });
  }
  runResolved(device, call);
}

}  // namespace

void detail::refuseRank(const char* kernel, const char* gather, int rank, const char* ranks) {
  if (rank == 0)
    throw Error(
        fmt::format("{}: '{}' is not given, and its rank chooses the kernel; give a stream of rank {}",
                    kernel, gather, ranks));
  throw Error(
      fmt::format("{}: '{}' has rank {}, but there are kernels for rank {} alone; give such a stream, or "
                  "instantiate the template for rank {}",
                  kernel, gather, rank, ranks, rank),
      Error::Kind::Shape);
}

void run(const Kernel& kernel, std::span<const Argument> arguments, const CallOptions& options) {
  if (detail::Distribution* all = distributionOf(kernel, arguments, options.over))
    return all->run(kernel, arguments, options);
  withHostMemory(kernel.name, [&] { checkAndRun(kernel, arguments, options); });
}

}  // namespace sk
