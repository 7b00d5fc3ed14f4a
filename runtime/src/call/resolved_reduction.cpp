// SPDX-License-Identifier: MIT
#include "call/resolved_reduction.hpp"

#include <algorithm>
#include <utility>

#include "device/device_state.hpp"

namespace sk {

const Shape& ResolvedReduction::shapeOfResults() const {
  const auto& parameters = reduction.fold.parameters;
  const auto first = std::ranges::find(parameters, program::Role::Accumulator, &program::Parameter::role) -
                     parameters.begin();
  return arguments[static_cast<std::size_t>(first)].region.shape;
}

ResolvedReduction ResolvedReduction::of(const program::Reduction& other,
                                        std::span<const Argument> otherArguments,
                                        std::span<void* const> otherValues) const {
  return {device, other, otherArguments, domain, blocks, otherValues, options, scan, rows, placed};
}

Argument TemporaryResults::add(const program::Element& element) {
  Argument argument;
  if (call_.isToValues()) {
    values.push_back(bytes_.emplace_back(element.size).data());
  } else {
    detail::StreamOwner stream(
        call_.device.createStream(element, call_.shapeOfResults(), Storage::Single).release());
    streams_.push_back(std::move(stream));
    argument.region = detail::wholeRegion(streams_.back().get());
  }
  arguments.push_back(argument);
  return argument;
}

}  // namespace sk
