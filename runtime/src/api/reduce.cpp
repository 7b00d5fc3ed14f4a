// SPDX-License-Identifier: MIT
//
// sk::reduce and sk::scan: choose a variant of a reduction, and carry out compensated ones, which add a sum and its
// rounding error (api/exact_reduction.cpp has the exact ones). Must not depend on the kind of device.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

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
#include "device/rows_state.hpp"
#include "results/call_scope.hpp"
#include "sk/call.hpp"
#include "support/checked_size.hpp"

namespace sk {

using program::CompensatedReduction;
using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;

const CompensatedReduction* compensatedVariant(const ResolvedReduction& call) {
  const Reduction& reduction = call.reduction;
  const Accumulate requested = call.options.accumulate;
  const CompensatedReduction* second = reduction.compensated;
  if (requested == Accumulate::Exact && reduction.exact.empty()) {
    fail(reduction.fold,
         "it has no sum of floats to add exactly, or others beside it that cannot be; call it without "
         "Accumulate::Exact");
  }
  if (requested == Accumulate::Compensated && second == nullptr) {
    fail(reduction.fold,
         "it has no sum of floats to compensate, one that elements and partial results are added to and no "
         "more; call it without Accumulate::Compensated");
  }
  if (requested == Accumulate::Tree || second == nullptr || call.domain.size() == 0) {
    return nullptr;
  }
  if (!call.device.arithmetic().exactSums) {
    if (requested == Accumulate::Compensated) {
      fail(Error::Kind::Device, reduction.fold,
           "its sums cannot be compensated on '{}', whose compiler simplifies their rounding errors away; "
           "call it without Accumulate::Compensated, or on another device (SK_DEVICE=native)",
           call.device.name());
    }
    return nullptr;
  }
  const assemble::SpecValues specs = specsOf(reduction.fold, call.arguments);
  const std::size_t uniforms = uniformPlanes(reduction.fold, call.arguments);
  const auto unitsOf = [&](const Kernel& kernel) {
    return assemble::textureUnits(kernel, specs,
                                  otherUnits(kernel, uniforms, call.scan.has_value(), call.rows != nullptr));
  };
  const auto room = static_cast<std::size_t>(call.device.limits.textureUnits);
  const bool fits = unitsOf(second->reduction.fold) <= room && unitsOf(second->reduction.combine) <= room;
  return fits || requested == Accumulate::Compensated ? second : nullptr;
}

namespace {

/// Adds rounding errors to floats in host memory.
void addFloats(void* to, const void* from, std::size_t bytes) {
  for (std::size_t at = 0; at < bytes; at += sizeof(float)) {
    float a;
    float b;
    std::memcpy(&a, static_cast<std::byte*>(to) + at, sizeof a);
    std::memcpy(&b, static_cast<const std::byte*>(from) + at, sizeof b);
    // the error of a sum that is not finite is NaN; an error of 0 must not change -0
    a = b == 0 || !std::isfinite(b) ? a : a + b;
    std::memcpy(static_cast<std::byte*>(to) + at, &a, sizeof a);
  }
}

/// The accumulators of rounding errors, in the order of the sums.
std::span<const Parameter> errorAccumulators(const CompensatedReduction& second) {
  return second.reduction.fold.parameters.last(second.sums.size());
}

/// The index among the results of parameter `accumulator`.
std::size_t resultOf(const Kernel& fold, std::size_t accumulator) {
  return static_cast<std::size_t>(std::count_if(
      fold.parameters.begin(), fold.parameters.begin() + static_cast<std::ptrdiff_t>(accumulator),
      [](const Parameter& parameter) { return parameter.role == Role::Accumulator; }));
}

/// The arguments of accumulators that have sums, each once.
std::vector<Argument> resultsWithSums(const CompensatedReduction& second,
                                      std::span<const Argument> arguments) {
  std::vector<Argument> results;
  const program::CompensatedSum* before = nullptr;
  for (const program::CompensatedSum& sum : second.sums) {
    if (before == nullptr || before->accumulator != sum.accumulator) {
      results.push_back({.region = arguments[sum.accumulator].region});
    }
    before = &sum;
  }
  return results;
}

}  // namespace

bool isExact(const ResolvedReduction& call) {
  return call.options.accumulate == Accumulate::Exact && call.domain.size() != 0 &&
         call.device.sumsExactly(call);
}

bool foldsInDoubles(const ResolvedReduction& call) {
  return call.reduction.parts != nullptr && call.reduction.parts->inDoubles != nullptr &&
         call.options.accumulate != Accumulate::Exact && !call.device.usesPrecisionVariants() &&
         call.device.sumsInDoubles();
}

bool isInDoubles(const ResolvedReduction& call, const CompensatedReduction& second) {
  // without rows, gathers would have to be copied to doubles
  const bool readsInputs = !call.reduction.term.factors.empty() || call.rows != nullptr;
  return second.addsDoubles && readsInputs && call.device.sumsInDoubles() &&
         std::ranges::none_of(call.arguments, [](const Argument& argument) {
           return argument.region.stream != nullptr && argument.region.stream->storage >= Storage::Extended;
         });
}

CallOptions resolvedOptions(const ResolvedReduction& checked, const CallOptions& call) {
  const Reduction& reduction = checked.reduction;
  if (!checked.scan) refuseScanOptions(reduction.fold, call);
  CallOptions options = checked.device.configuration.resolve(reduction.fold, call);
  if (reduction.compensated == nullptr && reduction.exact.empty()) options.accumulate = call.accumulate;
  checkTables(reduction.fold, options);
  const bool isOfFloats =
      options.accumulate == Accumulate::Exact || options.accumulate == Accumulate::Compensated;
  if (isOfFloats && needsPrecisionVariant(options)) {
    fail(reduction.fold,
         "exact and compensated sums are of floats; call it in Precision::Single, or without Accumulate");
  }
  return options;
}

namespace {

/// Whether results have to be computed as floats, and stored afterwards as the halves or doubles that their streams hold. What is
/// folded in doubles is stored without that step, so that a stream of doubles gets all bits of them.
bool isStoredInOtherPrecision(const ResolvedReduction& call) {
  if (call.isToValues()) return false;
  if (isWide(call.options) && call.domain.size() != 0) return false;
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    if (call.reduction.fold.parameters[i].role == Role::Accumulator &&
        call.arguments[i].region.stream->storage != Storage::Single) {
      return true;
    }
  }
  return false;
}

}  // namespace

void reduceByTemporaries(const ResolvedReduction& call, const std::function<void()>& between) {
  TemporaryResults floats(call);
  WriteScope writes;
  addResults(writes, call);
  std::vector<Argument> all(call.arguments.begin(), call.arguments.end());
  std::vector<std::size_t> results;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Parameter& parameter = call.reduction.fold.parameters[i];
    if (parameter.role != Role::Accumulator) continue;
    all[i] = floats.add(*parameter.element);
    results.push_back(i);
  }
  reduceResolved(call.of(call.reduction, all, {}));
  between();
  if (storesBeside(call)) writes.begin();
  for (const std::size_t i : results) {
    StreamState& result = *call.arguments[i].region.stream;
    if (!result.copyFrom(all[i].region, call.arguments[i].region)) {
      std::vector<std::byte> elements(static_cast<std::size_t>(all[i].region.shape.size()) *
                                      call.reduction.fold.parameters[i].element->size);
      all[i].region.stream->read(all[i].region, elements.data());
      result.write(call.arguments[i].region, elements.data());
    }
    writes.begin();
  }
  writes.commit();
}

void addErrors(const Reduction& reduction, const CompensatedReduction& second, std::span<void* const> values,
               std::span<void* const> errors) {
  for (std::size_t k = 0; k < errors.size(); ++k) {
    const auto& [accumulator, offset] = second.sums[k];
    auto* const result = static_cast<std::byte*>(values[resultOf(reduction.fold, accumulator)]);
    addFloats(result + offset, errors[k], errorAccumulators(second)[k].element->size);
  }
}

namespace {

/// Computes the sums in the results and the rounding errors in temporaries, then adds both.
void reduceCompensated(const ResolvedReduction& call, const CompensatedReduction& second) {
  TemporaryResults errors(call);
  std::vector<Argument> all(call.arguments.begin(), call.arguments.end());
  for (const Parameter& parameter : errorAccumulators(second)) all.push_back(errors.add(*parameter.element));
  std::vector<void*> values(call.values.begin(), call.values.end());
  values.insert(values.end(), errors.values.begin(), errors.values.end());
  checkReduction(second.reduction, all, values, call.scan, call.placed, call.options.over);
  WriteScope writes;
  addResults(writes, call);
  call.device.reduce(call.of(second.reduction, all, values));
  if (call.isToValues()) addErrors(call.reduction, second, call.values, errors.values);
  if (call.isToValues()) return;
  writes.begin();
  const std::vector<Argument> results = resultsWithSums(second, call.arguments);
  std::vector<Argument> finished = results;
  finished.insert(finished.end(), errors.arguments.begin(), errors.arguments.end());
  finished.insert(finished.end(), results.begin(), results.end());
  run(second.finish, finished,
      {.precision = Precision::Single, .intrinsics = call.options.intrinsics, .tables = call.options.tables});
  writes.commit();
}

}  // namespace

void reduceResolved(const ResolvedReduction& call) {
  if (isStoredInOtherPrecision(call)) return reduceByTemporaries(call, [] {});
  if (needsPrecisionVariant(call.options)) return reduceInPrecision(call);
  const CompensatedReduction* second = compensatedVariant(call);
  if (second != nullptr && foldsInDoubles(call)) return reduceWide(call, *call.reduction.parts->inDoubles);
  if (isExact(call)) return reduceExactly(call);
  if (second == nullptr) return call.device.reduce(call);
  if (!isInDoubles(call, *second)) return reduceCompensated(call, *second);
  ResolvedReduction inDoubles = call;
  inDoubles.options.accumulate = Accumulate::Extended;
  reduceInPrecision(inDoubles);
}

namespace {

void runUnchecked(const ResolvedReduction& call) {
  const DenseArguments dense(call.reduction.fold, call.arguments);
  if (dense.areAsGiven()) return reduceResolved(call);
  reduceResolved(call.of(call.reduction, dense.get(), call.values));
  dense.finish();
}

void runResolved(const ResolvedReduction& call) {
  const results::CallScope measured(call.device, call.reduction.fold.name);
  const TraceScope traced(call.device.trace.get(), "call", call.reduction.fold.name);
  traced.add("domain", call.domain);
  if (!call.isToValues()) traced.add("blocks", call.blocks);
  if (call.blocks.size() == 0) return;
  if (!checksWritten()) return runUnchecked(call);
  const auto repeat = [&](std::span<const Argument> arguments, std::span<void* const> values) {
    runUnchecked(call.of(call.reduction, arguments, values));
  };
  runChecked({.device = call.device,
              .kernel = call.reduction.fold,
              .arguments = call.arguments,
              .values = call.values,
              .run = repeat},
             [&] { runUnchecked(call); });
}

class RecordedReduction final : public RecordedCall {
 public:
  explicit RecordedReduction(const ResolvedReduction& call)
      : arguments_(call.reduction.fold, call.arguments), rows_(call.rows), call_(call) {
    call_.arguments = arguments_.get();
    arguments_.noteUses(*call.device.recording);
  }

  void run() override { runResolved(call_); }
  std::string_view name() const override { return call_.reduction.fold.name; }
  bool addUses(std::vector<StreamUse>& uses) const override {
    arguments_.addUses(uses);
    return true;
  }

 private:
  const OwnedArguments arguments_;
  const SharedRows rows_;
  ResolvedReduction call_;
};

/// The values of all accumulators in the doubles of a reference device, which rounds them for the host: folds once more.
std::vector<std::vector<double>> valuesInDoubles(const ResolvedReduction& call) {
  const results::InternalWork folding(call.device);
  std::vector<Argument> all(call.arguments.begin(), call.arguments.end());
  std::vector<std::vector<double>> values;
  std::vector<detail::StreamOwner> streams;
  std::vector<StreamRegion> regions;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Parameter& parameter = call.reduction.fold.parameters[i];
    if (parameter.role != Role::Accumulator) continue;
    streams.emplace_back(call.device.createStream(*parameter.element, {1}, Storage::Single).release());
    all[i].region = regions.emplace_back(detail::wholeRegion(streams.back().get()));
  }
  ResolvedReduction toStreams =
      checkReduction(call.reduction, all, {}, call.scan, call.placed, call.options.over);
  toStreams.options = call.options;
  reduceResolved(toStreams);
  for (const StreamRegion& region : regions) {
    std::size_t components = 0;
    for (const program::Field& field : region.stream->element->fields) components += field.width;
    region.stream->readReals(region, values.emplace_back(components).data());
  }
  return values;
}

bool isOfFloats(const program::Element& element) {
  return std::ranges::all_of(
      element.fields, [](const program::Field& field) { return field.scalar == program::Scalar::Float; });
}

/// Gives the values that the host gets to the recorder of SK_RESULTS.
void recordValues(const ResolvedReduction& call) {
  results::Recorder& recorder = *results::recorderOf(call.device);
  std::vector<const Parameter*> accumulators;
  for (const Parameter& parameter : call.reduction.fold.parameters) {
    if (parameter.role == Role::Accumulator) accumulators.push_back(&parameter);
  }
  const bool areReals =
      call.device.isReference() && call.domain.size() != 0 &&
      std::ranges::all_of(accumulators, [](const Parameter* each) { return isOfFloats(*each->element); });
  std::vector<std::vector<double>> doubles;
  if (areReals) doubles = valuesInDoubles(call);
  for (std::size_t i = 0; i < accumulators.size(); ++i) {
    std::string name(call.reduction.fold.name);
    if (accumulators.size() > 1) name += fmt::format(".{}", accumulators[i]->name);
    areReals
        ? recorder.addValue(name, *accumulators[i]->element, doubles[i])
        : recorder.addValue(name, *accumulators[i]->element, static_cast<const std::byte*>(call.values[i]));
  }
}

/// A reduction of what is folded, and the arguments and the options that its caller gave.
struct GivenReduction {
  const Reduction& reduction;
  const BoxedArguments& folded;
  std::span<const Argument> arguments;
  const CallOptions& options;
};

void checkReducedRanges(DeviceState& device, const GivenReduction& given, std::span<void* const> values,
                        const std::optional<ScanOrder>& scan) {
  if (!checksRanges()) return;  // without allocating what repeats the call
  const auto repeat = [&reduction = given.reduction, options = given.options, isScan = scan.has_value()](
                          std::span<const Argument> others, std::span<void* const> results) {
    if (isScan) return sk::scan(reduction, others, options);
    if (results.empty()) return sk::reduce(reduction, others, options);
    sk::reduce(reduction, others, results, options);
  };
  checkRanges({.device = device,
               .kernel = given.reduction.fold,
               .arguments = given.arguments,
               .box = given.options.box,
               .values = values,
               .run = repeat});
}

void checkAndReduce(const GivenReduction& given, std::span<void* const> values, const CallOptions& options,
                    const std::optional<ScanOrder>& scan) {
  const Reduction& reduction = given.reduction;
  const std::span<const Argument> arguments = given.folded.arguments;
  ResolvedReduction call =
      checkReduction(reduction, arguments, values, scan, given.folded.placed, given.folded.over);
  call.options = resolvedOptions(call, options);
  checkFoldAssertions(call.device, reduction.fold, given.arguments, given.options.box, call.options);
  checkReducedRanges(call.device, given, values, scan);
  results::noteCall(call.device, reduction.fold, &reduction, options, call.options);
  if (call.device.recording == nullptr) {
    runResolved(call);
    if (results::recorderOf(call.device) != nullptr && call.isToValues()) recordValues(call);
    return;
  }
  if (call.isToValues()) {
    fail(reduction.fold,
         "its value is not known while the device records calls; give it a stream of one element for the "
         "result");
  }
  call.device.recording->add(std::make_unique<RecordedReduction>(call));
}

void checkAndReduce(const Reduction& reduction, std::span<const Argument> arguments,
                    std::span<void* const> values, const CallOptions& options,
                    const std::optional<ScanOrder>& scan = {}) {
  if (options.box.isWhole() && !hasPlaced(arguments))
    return checkAndReduce({reduction,
                           {.arguments = {arguments.begin(), arguments.end()}, .over = options.over},
                           arguments,
                           options},
                          values, options, scan);
  if (scan)
    fail(reduction.fold,
         "a scan takes no box and no placed streams; scan a view of its input, domain(begin, end)");
  CallOptions others = options;
  others.box = {};
  const BoxedArguments boxed = argumentsIn(reduction.fold, arguments, options.box, options.over);
  others.over = boxed.over;
  checkAndReduce({reduction, boxed, arguments, options}, values, others, scan);
}

}  // namespace

void reduce(const Reduction& reduction, std::span<const Argument> arguments, std::span<void* const> results,
            const CallOptions& options) {
  if (detail::Distribution* all = distributionOf(reduction.fold, arguments, options.over))
    return all->reduce(reduction, arguments, results, options);
  withHostMemory(reduction.fold.name, [&] { checkAndReduce(reduction, arguments, results, options); });
}

void reduce(const Reduction& reduction, std::span<const Argument> arguments, const CallOptions& options) {
  if (detail::Distribution* all = distributionOf(reduction.fold, arguments, options.over))
    return all->reduce(reduction, arguments, {}, options);
  withHostMemory(reduction.fold.name, [&] { checkAndReduce(reduction, arguments, {}, options); });
}

void scan(const Reduction& reduction, std::span<const Argument> arguments, const CallOptions& options) {
  if (detail::Distribution* all = distributionOf(reduction.fold, arguments, options.over))
    return all->scan(reduction, arguments, options);
  const ScanOrder order{options.along, options.scan == Scan::Exclusive};
  withHostMemory(reduction.fold.name, [&] { checkAndReduce(reduction, arguments, {}, options, order); });
}

}  // namespace sk
