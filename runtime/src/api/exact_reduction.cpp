// SPDX-License-Identifier: MIT
#include "api/exact_reduction.hpp"

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

/// One sum: rounded by the device, or its digits, a stream for each accumulator of its fold.
struct Sum {
  std::unique_ptr<RoundedSums> rounded;
  std::vector<detail::StreamOwner> streams;
  std::vector<Argument> arguments;
};

/// Folds to floats or to digits, one element for each of the results.
Sum fold(const ExactSum& sum, std::span<const Argument> plain, const Reduction& reduction,
         const CheckedReduction& checked, const CallOptions& options) {
  Sum made;
  made.rounded = checked.device.sumExactly(reduction, sum, plain, checked.domain, checked.blocks, options);
  if (made.rounded) return made;
  std::vector<Argument> all;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    if (reduction.fold.parameters[i].role != Role::Accumulator) all.push_back(plain[i]);
  }
  for (const Parameter& parameter : sum.reduction.fold.parameters) {
    if (parameter.role != Role::Accumulator) continue;
    const Shape& shape = plain[sum.accumulator].region.shape;
    made.streams.emplace_back(
        checked.device.createStream(*parameter.element, shape, Storage::Single).release());
    made.arguments.push_back({.region = detail::wholeRegion(made.streams.back().get())});
  }
  all.insert(all.end(), made.arguments.begin(), made.arguments.end());
  checked.device.reduce(sum.reduction, all, checked.domain, checked.blocks, options);
  return made;
}

/// Whether nothing is left for the plain form: every scalar of every accumulator is a sum.
bool sumsEverything(const Reduction& reduction) {
  std::size_t scalars = 0;
  for (const Parameter& parameter : reduction.fold.parameters) {
    if (parameter.role != Role::Accumulator) continue;
    for (const program::Field& field : parameter.element->fields) scalars += field.width;
  }
  return scalars == reduction.exact.size();
}

/// One block that is all of the domain.
Shape oneBlock(Shape domain) {
  for (int d = 0; d < domain.rank(); ++d) domain = domain.with(d, 1);
  return domain;
}

}  // namespace

void reduceExactly(const Reduction& reduction, std::span<const Argument> arguments,
                   const CheckedReduction& checked, const CallOptions& options) {
  std::vector<Sum> sums;   // all of them first: a result may be an input
  for (const ExactSum& sum : reduction.exact) {
    sums.push_back(fold(sum, arguments, reduction, checked, options));
  }
  if (!sumsEverything(reduction)) {
    checked.device.reduce(reduction, arguments, checked.domain, checked.blocks, options);
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    if (sums[k].rounded) {
      const ExactSum& sum = reduction.exact[k];
      sums[k].rounded->store(arguments[sum.accumulator].region, sum.offset);
      continue;
    }
    const Argument result = {.region = arguments[reduction.exact[k].accumulator].region};
    std::vector<Argument> all = {result};
    all.insert(all.end(), sums[k].arguments.begin(), sums[k].arguments.end());
    all.push_back(result);
    run(reduction.exact[k].finish, all, {.precision = Precision::Single});
  }
}

void reduceExactly(const Reduction& reduction, std::span<const Argument> arguments,
                   const CheckedReduction& checked, std::span<void* const> results,
                   const CallOptions& options) {
  std::vector<Argument> all(arguments.begin(), arguments.end());
  std::vector<detail::StreamOwner> values;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Parameter& parameter = reduction.fold.parameters[i];
    if (parameter.role != Role::Accumulator) continue;
    values.emplace_back(checked.device.createStream(*parameter.element, {1}, Storage::Single).release());
    all[i] = {.region = detail::wholeRegion(values.back().get())};
  }
  reduceExactly(reduction, all, {checked.device, checked.domain, oneBlock(checked.domain)}, options);
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k].get()->read(detail::wholeRegion(values[k].get()), static_cast<std::byte*>(results[k]));
  }
}

}  // namespace sk
