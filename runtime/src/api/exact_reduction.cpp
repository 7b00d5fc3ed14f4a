// SPDX-License-Identifier: MIT
#include "api/resolved_reduce.hpp"

#include <cstddef>
#include <memory>
#include <vector>

#include "device/device_state.hpp"
#include "device/stream_state.hpp"

namespace sk {

namespace {

using program::ExactSum;
using program::Parameter;
using program::Reduction;
using program::Role;

/// One sum: either rounded by the device, or as digits, with one stream per accumulator of its fold.
struct Sum {
  std::unique_ptr<RoundedSums> rounded;
  std::unique_ptr<TemporaryResults> digits;
};

/// Folds to rounded floats or to digits, with one element for each element of the result.
Sum fold(const ExactSum& sum, const ResolvedReduction& call) {
  Sum folded;
  folded.rounded = call.device.sumExactly(call, sum);
  if (folded.rounded) return folded;
  folded.digits = std::make_unique<TemporaryResults>(call);
  std::vector<Argument> all;
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const Role role = call.reduction.fold.parameters[i].role;
    if (role != Role::Accumulator && role != Role::Output) all.push_back(call.arguments[i]);
  }
  for (const Parameter& parameter : sum.reduction.fold.parameters) {
    if (parameter.role == Role::Accumulator) all.push_back(folded.digits->add(*parameter.element));
  }
  call.device.reduce(call.of(sum.reduction, all, {}));
  return folded;
}

/// Stores a sum in its result.
void finish(const Sum& sum, const ExactSum& exact, std::span<const Argument> arguments) {
  const StreamRegion& result = arguments[exact.accumulator].region;
  if (sum.rounded) {
    sum.rounded->store(result, exact.offset);
    return;
  }
  std::vector<Argument> all = {{.region = result}};
  all.insert(all.end(), sum.digits->arguments.begin(), sum.digits->arguments.end());
  all.push_back({.region = result});
  run(exact.finish, all, {.precision = Precision::Single});
}

/// Whether every scalar of every accumulator is an exact sum, so that the plain fold is not needed.
bool sumsEverything(const Reduction& reduction) {
  std::size_t scalars = 0;
  for (const Parameter& parameter : reduction.fold.parameters) {
    if (parameter.role != Role::Accumulator) continue;
    for (const program::Field& field : parameter.element->fields) scalars += field.width;
  }
  return scalars == reduction.exact.size();
}

/// Gives elements to results that have lost theirs: sums are stored one scalar at a time, beside the others. Until `restored` is
/// committed, the results are lost if an exception comes.
void restoreLostResults(const ResolvedReduction& call, WriteScope& restored) {
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const Parameter& parameter = call.reduction.fold.parameters[i];
    const StreamRegion& region = call.arguments[i].region;
    if (parameter.role != Role::Accumulator || !region.stream->isLost()) continue;
    const std::vector<std::byte> zeros(parameter.element->size);
    restored.add(region.stream);
    restored.begin();
    region.stream->fill(region, zeros.data());
  }
}

void reduceToStreams(const ResolvedReduction& call) {
  const Reduction& reduction = call.reduction;
  std::vector<Sum> sums;  // compute all sums before storing any: a result may be an input
  for (const ExactSum& sum : reduction.exact) sums.push_back(fold(sum, call));
  WriteScope writes, restored;
  addResults(writes, call);
  if (sumsEverything(reduction)) {
    restoreLostResults(call, restored);
  } else {
    call.device.reduce(call);
    writes.begin();
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    finish(sums[k], reduction.exact[k], call.arguments);
    writes.begin();
  }
  restored.commit();
  writes.commit();
}

}  // namespace

void reduceExactly(const ResolvedReduction& call) {
  if (!call.isToValues()) return reduceToStreams(call);
  std::vector<Argument> all(call.arguments.begin(), call.arguments.end());
  std::vector<detail::StreamOwner> values;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Parameter& parameter = call.reduction.fold.parameters[i];
    if (parameter.role != Role::Accumulator) continue;
    detail::StreamOwner value(call.device.createStream(*parameter.element, {1}, Storage::Single).release());
    values.push_back(std::move(value));
    all[i] = {.region = detail::wholeRegion(values.back().get())};
  }
  reduceToStreams(call.of(call.reduction, all, {}));
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k].get()->read(detail::wholeRegion(values[k].get()), static_cast<std::byte*>(call.values[k]));
  }
}

}  // namespace sk
