// SPDX-License-Identifier: MIT
//
// sk::reduce: which form of a reduction a call takes, and how the compensated one's two accumulators become one
// result (api/exact_reduction.hpp has the exact one). It knows no device.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <vector>

#include "api/exact_reduction.hpp"
#include "call/check_argument.hpp"
#include "call/check_reduction.hpp"
#include "call/precision.hpp"
#include "device/device_state.hpp"
#include "sk/call.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

using program::CompensatedReduction;
using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;

/// The compensated form, where the call takes it; else null. Of no element, the plain form's identity is the result.
const CompensatedReduction* compensated(const Reduction& reduction, std::span<const Argument> arguments,
                                        const CheckedReduction& checked, const CallOptions& options) {
  const CompensatedReduction* second = reduction.compensated;
  if (options.accumulate == Accumulate::Exact && reduction.exact.empty()) {
    fail(reduction.fold, "it has no sum of floats to add exactly; call it without Accumulate::Exact");
  }
  if (options.accumulate == Accumulate::Compensated && second == nullptr) {
    fail(reduction.fold,
         "it has no sum of floats to compensate, one that elements and partial results are added to and no "
         "more; call it without Accumulate::Compensated");
  }
  if (options.accumulate == Accumulate::Tree || second == nullptr || checked.domain.size() == 0) {
    return nullptr;
  }
  if (!checked.device.arithmetic().exactSums) {
    if (options.accumulate == Accumulate::Compensated) {
      fail(Error::Kind::Device, reduction.fold,
           "its sums cannot be compensated on '{}', whose compiler simplifies their rounding errors away; "
           "call it without Accumulate::Compensated, or on another device (SK_DEVICE=native)",
           checked.device.name());
    }
    return nullptr;
  }
  const auto room = static_cast<std::size_t>(checked.device.limits.textureUnits);
  const bool fits = planesRead(second->reduction.combine, specsOf(reduction.fold, arguments)) <= room;
  return fits || options.accumulate == Accumulate::Compensated ? second : nullptr;
}

/// Adds what floats have lost to them, in memory.
void addFloats(void* to, const void* from, std::size_t bytes) {
  for (std::size_t at = 0; at < bytes; at += sizeof(float)) {
    float a;
    float b;
    std::memcpy(&a, static_cast<std::byte*>(to) + at, sizeof a);
    std::memcpy(&b, static_cast<const std::byte*>(from) + at, sizeof b);
    // a sum that is not finite has lost NaN; and where nothing is lost, -0 stays
    a = b == 0 || !std::isfinite(b) ? a : a + b;
    std::memcpy(static_cast<std::byte*>(to) + at, &a, sizeof a);
  }
}

/// The accumulators for what sums have lost, in the order of the sums.
std::span<const Parameter> accumulatorsOfLosses(const CompensatedReduction& second) {
  return second.reduction.fold.parameters.last(second.sums.size());
}

/// Where the result of parameter `accumulator` stands among all results.
std::size_t resultOf(const Kernel& fold, std::size_t accumulator) {
  return static_cast<std::size_t>(std::count_if(
      fold.parameters.begin(), fold.parameters.begin() + static_cast<std::ptrdiff_t>(accumulator),
      [](const Parameter& parameter) { return parameter.role == Role::Accumulator; }));
}

/// The arguments that have sums, each once.
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

/// Whether the call takes the exact form. Of no element, the plain form's identity is the result.
bool isExact(const CheckedReduction& checked, const Reduction& reduction, const CallOptions& options) {
  return options.accumulate == Accumulate::Exact && checked.domain.size() != 0 &&
         checked.device.sumsExactly(reduction);
}

/// Whether the plain form in doubles serves for the compensated one: a kernel of floats sees no bits that a stream has beyond them.
bool isInDoubles(const CompensatedReduction& second, const CheckedReduction& checked,
                 std::span<const Argument> arguments) {
  return second.inDoubles && checked.device.sumsInDoubles() &&
         std::ranges::none_of(arguments, [](const Argument& argument) {
           return argument.region.stream != nullptr && argument.region.stream->storage >= Storage::Extended;
         });
}

CallOptions inDoubles(CallOptions options) {
  options.accumulate = Accumulate::Extended;
  return options;
}

/// With what a file or the declaration chooses; a file's choice for all reduces is one for those that sum floats.
CallOptions resolved(const CheckedReduction& checked, const Reduction& reduction, const CallOptions& call) {
  CallOptions options = checked.device.configuration.resolve(reduction.fold, call);
  if (reduction.compensated == nullptr && reduction.exact.empty()) options.accumulate = call.accumulate;
  checkTables(reduction.fold, options);
  const bool isOfFloats =
      options.accumulate == Accumulate::Exact || options.accumulate == Accumulate::Compensated;
  if (isOfFloats && takesForm(options)) {
    fail(reduction.fold,
         "exact and compensated sums are of floats; call it in Precision::Single, or without Accumulate");
  }
  return options;
}

/// Whether a result stream holds halves or doubles for floats.
bool isHeldOtherwise(const Reduction& reduction, std::span<const Argument> arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (reduction.fold.parameters[i].role == Role::Accumulator &&
        arguments[i].region.stream->storage != Storage::Single) {
      return true;
    }
  }
  return false;
}

/// Reduces to streams of floats, and copies these.
void reduceByFloats(const CheckedReduction& checked, const Reduction& reduction,
                    std::span<const Argument> arguments, const CallOptions& options) {
  std::vector<Argument> all(arguments.begin(), arguments.end());
  std::vector<detail::StreamOwner> floats;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Parameter& parameter = reduction.fold.parameters[i];
    if (parameter.role != Role::Accumulator) continue;
    floats.emplace_back(
        checked.device.createStream(*parameter.element, arguments[i].region.shape, Storage::Single)
            .release());
    all[i].region = detail::wholeRegion(floats.back().get());
  }
  reduce(reduction, all, options);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Parameter& parameter = reduction.fold.parameters[i];
    if (parameter.role != Role::Accumulator) continue;
    std::vector<std::byte> elements(static_cast<std::size_t>(all[i].region.shape.size()) *
                                    parameter.element->size);
    all[i].region.stream->read(all[i].region, elements.data());
    arguments[i].region.stream->write(arguments[i].region, elements.data());
  }
}

void reduceToValues(const Reduction& reduction, std::span<const Argument> arguments,
                    std::span<void* const> results, const CallOptions& call) {
  const CheckedReduction checked = checkReduction(reduction, arguments);
  const TraceScope traced(checked.device.trace.get(), "call", reduction.fold.name);
  traced.add("domain", checked.domain);
  const CallOptions options = resolved(checked, reduction, call);
  if (takesForm(options)) {
    reduceInForm(checked, reduction, arguments, results, options);
    return;
  }
  const CompensatedReduction* second = compensated(reduction, arguments, checked, options);
  if (isExact(checked, reduction, options)) {
    reduceExactly(reduction, arguments, checked, results, options);
    return;
  }
  if (second == nullptr) {
    checked.device.reduce(reduction, arguments, checked.domain, results, options);
    return;
  }
  if (isInDoubles(*second, checked, arguments)) {
    reduceInForm(checked, reduction, arguments, results, inDoubles(options));
    return;
  }
  std::vector<Argument> all(arguments.begin(), arguments.end());
  std::vector<void*> places(results.begin(), results.end());
  std::deque<std::vector<std::byte>> lost;
  for (const Parameter& parameter : accumulatorsOfLosses(*second)) {
    all.emplace_back();
    places.push_back(lost.emplace_back(parameter.element->size).data());
  }
  checkReduction(second->reduction, all);
  checked.device.reduce(second->reduction, all, checked.domain, places, options);
  for (std::size_t k = 0; k < lost.size(); ++k) {
    const auto& [accumulator, offset] = second->sums[k];
    auto* const result = static_cast<std::byte*>(results[resultOf(reduction.fold, accumulator)]);
    addFloats(result + offset, lost[k].data(), lost[k].size());
  }
}

void reduceToStreams(const Reduction& reduction, std::span<const Argument> arguments,
                     const CallOptions& call) {
  const CheckedReduction checked = checkReductionToStreams(reduction, arguments);
  const TraceScope traced(checked.device.trace.get(), "call", reduction.fold.name);
  traced.add("domain", checked.domain);
  traced.add("blocks", checked.blocks);
  const CallOptions options = resolved(checked, reduction, call);
  if (checked.blocks.size() == 0) {
    return;
  }
  if (isHeldOtherwise(reduction, arguments)) {
    reduceByFloats(checked, reduction, arguments, options);
    return;
  }
  if (takesForm(options)) {
    reduceInForm(checked, reduction, arguments, options);
    return;
  }
  const CompensatedReduction* second = compensated(reduction, arguments, checked, options);
  if (isExact(checked, reduction, options)) {
    reduceExactly(reduction, arguments, checked, options);
    return;
  }
  if (second == nullptr) {
    checked.device.reduce(reduction, arguments, checked.domain, checked.blocks, options);
    return;
  }
  if (isInDoubles(*second, checked, arguments)) {
    reduceInForm(checked, reduction, arguments, inDoubles(options));
    return;
  }
  // the sums go where the results will be, what they lose to streams beside them
  std::vector<Argument> all(arguments.begin(), arguments.end());
  std::vector<detail::StreamOwner> lost;
  const Shape& shape = arguments[second->sums.front().accumulator].region.shape;
  for (const Parameter& parameter : accumulatorsOfLosses(*second)) {
    lost.emplace_back(checked.device.createStream(*parameter.element, shape, Storage::Single).release());
    all.push_back({.region = detail::wholeRegion(lost.back().get())});
  }
  checkReductionToStreams(second->reduction, all);
  checked.device.reduce(second->reduction, all, checked.domain, checked.blocks, options);
  const std::vector<Argument> results = resultsWithSums(*second, arguments);
  std::vector<Argument> finished = results;
  finished.insert(finished.end(), all.begin() + static_cast<std::ptrdiff_t>(arguments.size()), all.end());
  finished.insert(finished.end(), results.begin(), results.end());
  run(second->finish, finished,
      {.precision = Precision::Single, .intrinsics = options.intrinsics, .tables = options.tables});
}

}  // namespace

void reduce(const Reduction& reduction, std::span<const Argument> arguments, std::span<void* const> results,
            const CallOptions& call) {
  withHostMemory(reduction.fold.name, [&] { reduceToValues(reduction, arguments, results, call); });
}

void reduce(const Reduction& reduction, std::span<const Argument> arguments, const CallOptions& call) {
  withHostMemory(reduction.fold.name, [&] { reduceToStreams(reduction, arguments, call); });
}

}  // namespace sk
