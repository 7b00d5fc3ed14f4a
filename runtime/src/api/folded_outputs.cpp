// SPDX-License-Identifier: MIT
//
// sk::fold: kernels with folded outputs. A device that can stores elements while it folds (DeviceState::
// foldsBesideOutputs). For all others, the call is a kernel and a reduction, in an order in which neither writes what
// the other reads. Must not depend on the kind of device.
#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "api/resolved_reduce.hpp"
#include "call/box.hpp"
#include "call/check_asserts.hpp"
#include "call/check_call.hpp"
#include "call/check_ranges.hpp"
#include "call/check_reduction.hpp"
#include "call/check_unwritten_reads.hpp"
#include "call/check_written.hpp"
#include "call/distribution.hpp"
#include "call/placed.hpp"
#include "call/resolved_call.hpp"
#include "device/device_state.hpp"
#include "device/loop_state.hpp"
#include "device/region.hpp"
#include "device/write_scope.hpp"
#include "results/call_scope.hpp"
#include "sk/call.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

using program::FoldParts;
using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;

std::vector<Argument> argumentsOf(std::span<const std::uint8_t> operands,
                                  std::span<const Argument> arguments) {
  std::vector<Argument> own;
  for (const std::uint8_t operand : operands) own.push_back(arguments[operand]);
  return own;
}

bool isStored(Role role) { return role == Role::Output || role == Role::Accumulator; }

/// Whether a kernel reads a stream that parameters of this role of the fold write.
bool readsWritten(const Kernel& reader, std::span<const Argument> own, const ResolvedReduction& call,
                  Role written) {
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (isStored(reader.parameters[i].role) || own[i].region.stream == nullptr) continue;
    for (std::size_t k = 0; k < call.arguments.size(); ++k) {
      if (call.reduction.fold.parameters[k].role == written &&
          call.arguments[k].region.stream == own[i].region.stream)
        return true;
    }
  }
  return false;
}

void checkDisjoint(const Kernel& fold, std::span<const Argument> arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    for (std::size_t k = 0; k < arguments.size(); ++k) {
      if (fold.parameters[i].role != Role::Output || fold.parameters[k].role != Role::Accumulator ||
          arguments[i].isNone || !overlap(arguments[i].region, arguments[k].region)) {
        continue;
      }
      fail(fold,
           "the outputs '{}' and '{}' overlap: both write elements of one stream; give them different "
           "streams, or "
           "regions that have no element in common",
           fold.parameters[i].name, fold.parameters[k].name);
    }
  }
}

/// Stores the outputs alone. The arguments are those of the kernel that computes them.
void runMap(const ResolvedReduction& call, std::span<const Argument> arguments) {
  const FoldedBox& placed = call.placed;
  CallOptions options = call.options;
  options.accumulate = Accumulate::Default;
  options.box = placed.box;
  ResolvedCall map = resolveCall(call.reduction.parts->map, arguments, call.device.limits, options);
  std::optional<LocalCall> part;
  if (placed.isPlaced() && call.device.placesDomains()) {
    part = partCall(map, placed.box);
    map.arguments = part->arguments;
    map.domain = part->domain;
    map.options.box = part->box;
    map.place = part->place;
  }
  call.device.run(map);
}

/// A call of a kernel with folded outputs, checked.
class FoldCall {
 public:
  /// `arguments` must outlive the object.
  FoldCall(const Reduction& reduction, std::span<const Argument> arguments, const CallOptions& options,
           const FoldedBox& placed)
      : parts_(*reduction.parts),
        mapArguments_(argumentsOf(parts_.mapOperands, arguments)),
        hasMap_(checkCall(parts_.map, mapArguments_).has_value()),
        call_(checkReduction(reduction, arguments, {}, {}, placed, options.over)) {
    checkDisjoint(reduction.fold, arguments);
    call_.options = resolvedOptions(call_, options);
  }

  DeviceState& device() const { return call_.device; }
  const ResolvedReduction& resolved() const { return call_; }

  void run() const {
    const results::CallScope measured(call_.device, call_.reduction.fold.name);
    const TraceScope traced(call_.device.trace.get(), "call", call_.reduction.fold.name);
    traced.add("domain", call_.domain);
    traced.add("blocks", call_.blocks);
    if (!checksWritten()) return runUnchecked();
    const auto repeat = [&](std::span<const Argument> arguments, std::span<void* const>) {
      FoldCall(*this, arguments).runUnchecked();
    };
    runChecked(
        {.device = call_.device, .kernel = call_.reduction.fold, .arguments = call_.arguments, .run = repeat},
        [&] { runUnchecked(); });
  }

 private:
  /// The same call with other arguments in the place of its own.
  FoldCall(const FoldCall& given, std::span<const Argument> arguments)
      : parts_(given.parts_),
        mapArguments_(argumentsOf(parts_.mapOperands, arguments)),
        hasMap_(given.hasMap_),
        call_(given.call_.of(given.call_.reduction, arguments, {})) {}

  void runUnchecked() const {
    const DenseArguments dense(call_.reduction.fold, call_.arguments);
    if (dense.areAsGiven()) return runParts();
    FoldCall(*this, dense.get()).runParts();
    dense.finish();
  }

  void runParts() const {
    if (call_.blocks.size() == 0) return map();
    if (isTogether()) return reduceResolved(call_);
    WriteScope writes;  // of what the first part writes
    if (readsOutputs()) {
      addArguments(writes, call_, Role::Output);
      map();
      writes.begin();
      foldAfter();
      return writes.commit();
    }
    std::vector<Argument> alone(call_.arguments.begin(), call_.arguments.end());
    for (std::size_t i = 0; i < alone.size(); ++i) {
      if (call_.reduction.fold.parameters[i].role == Role::Output) alone[i].region.stream = nullptr;
    }
    const ResolvedReduction fold = call_.of(call_.reduction, alone, {});
    if (!hasMap_ || !readsWritten(parts_.map, mapArguments_, call_, Role::Accumulator)) {
      addArguments(writes, call_, Role::Accumulator);
      reduceResolved(fold);
      writes.begin();
      map();
    } else if (!readsWritten(call_.reduction.fold, call_.arguments, call_, Role::Output)) {
      addArguments(writes, call_, Role::Output);
      map();
      writes.begin();
      reduceResolved(fold);
    } else {
      addArguments(writes, call_, Role::Output);
      reduceByTemporaries(fold, [&] {
        map();
        writes.begin();
      });
    }
    writes.commit();
  }

  bool isTogether() const {
    return hasMap_ && !needsPrecisionVariant(call_.options) &&
           call_.options.accumulate != Accumulate::Exact && call_.device.foldsBesideOutputs(call_);
  }

  /// Whether outputs that the kernel has written can be folded: they hold the floats that were computed, and
  /// nothing else that is read has been overwritten.
  bool readsOutputs() const {
    if (parts_.after == nullptr || !hasMap_ || needsPrecisionVariant(call_.options)) return false;
    for (std::size_t i = 0; i < call_.arguments.size(); ++i) {
      const StreamState* const stream = call_.arguments[i].region.stream;
      if (call_.reduction.fold.parameters[i].role == Role::Output &&
          (stream == nullptr || stream->storage == Storage::Half))
        return false;
    }
    if (!call_.device.usesPrecisionVariants()) return false;  // native devices have no code for it
    const Kernel& after = parts_.after->fold;
    for (std::size_t i = 0; i < after.parameters.size(); ++i) {
      const Argument& argument = call_.arguments[parts_.afterOperands[i]];
      const Parameter& whole = call_.reduction.fold.parameters[parts_.afterOperands[i]];
      if (isStored(whole.role) || argument.region.stream == nullptr) continue;
      for (std::size_t k = 0; k < call_.arguments.size(); ++k) {
        if (call_.reduction.fold.parameters[k].role == Role::Output &&
            call_.arguments[k].region.stream == argument.region.stream)
          return false;
      }
    }
    return true;
  }

  void foldAfter() const {
    const std::vector<Argument> arguments = argumentsOf(parts_.afterOperands, call_.arguments);
    reduceResolved(call_.of(*parts_.after, arguments, {}));
  }

  void map() const {
    if (hasMap_) runMap(call_, mapArguments_);
  }

  const FoldParts& parts_;
  std::vector<Argument> mapArguments_;
  bool hasMap_;  ///< there are elements, and outputs that the spec parameters keep
  ResolvedReduction call_;
};

class RecordedFold final : public RecordedCall {
 public:
  RecordedFold(const Reduction& reduction, std::span<const Argument> arguments, const CallOptions& options,
               const FoldedBox& placed)
      : arguments_(reduction.fold, arguments), call_(reduction, arguments_.get(), options, placed) {
    arguments_.noteUses(*call_.device().recording);
  }

  void run() override { call_.run(); }
  std::string_view name() const override { return call_.resolved().reduction.fold.name; }
  bool addUses(std::vector<StreamUse>& uses) const override {
    arguments_.addUses(uses);
    return true;
  }

 private:
  const OwnedArguments arguments_;
  const FoldCall call_;
};

void checkAndFold(const Reduction& reduction, std::span<const Argument> given, const CallOptions& options) {
  BoxedArguments folded{.arguments = {given.begin(), given.end()}, .over = options.over};
  if (!options.box.isWhole() || hasPlaced(given))
    folded = argumentsIn(reduction.fold, given, options.box, options.over);
  CallOptions others = options;
  others.box = {};
  others.over = folded.over;
  const FoldCall call(reduction, folded.arguments, others, folded.placed);
  checkFoldAssertions(call.device(), reduction.fold, given, options.box, call.resolved().options);
  if (checksRanges()) {
    checkRanges({.device = call.device(),
                 .kernel = reduction.fold,
                 .arguments = given,
                 .box = options.box,
                 .run = [&reduction, options](std::span<const Argument> own, std::span<void* const>) {
                   sk::fold(reduction, own, options);
                 }});
  }
  results::noteCall(call.device(), reduction.fold, &reduction, others, call.resolved().options);
  LoopState* const recording = call.device().recording;
  if (recording == nullptr) return call.run();
  recording->add(std::make_unique<RecordedFold>(reduction, folded.arguments, others, folded.placed));
}

}  // namespace

void storeOutputs(const ResolvedReduction& call) {
  const FoldParts& parts = *call.reduction.parts;
  const std::vector<Argument> arguments = argumentsOf(parts.mapOperands, call.arguments);
  if (checkCall(parts.map, arguments)) runMap(call, arguments);
}

void fold(const Reduction& reduction, std::span<const Argument> arguments, const CallOptions& options) {
  if (detail::Distribution* all = distributionOf(reduction.fold, arguments, options.over))
    return all->fold(reduction, arguments, options);
  withHostMemory(reduction.fold.name, [&] { checkAndFold(reduction, arguments, options); });
}

}  // namespace sk
