// SPDX-License-Identifier: MIT
#include "accuracy/file/call.hpp"

#include <algorithm>
#include <cstring>

#include "native/native_stream.hpp"
#include "sk/native/quad_type.hpp"

namespace sk_tool {

namespace {

using sk::program::Parameter;
using sk::program::Scalar;

/// Loads `count` scalars with a stride of `stride` bytes.
std::vector<double> loadAll(Scalar scalar, const std::byte* from, std::size_t stride, std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = load(scalar, from + i * stride);
  return values;
}

std::vector<double> loadQuads(const std::byte* from, std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    sk::native::Quad value;
    std::memcpy(&value, from + i * sizeof value, sizeof value);
    values[i] = static_cast<double>(value);
  }
  return values;
}

}  // namespace

std::vector<ResultScalar> resultScalars(const Subject& subject) {
  std::vector<ResultScalar> scalars;
  for (const Parameter& parameter : subject.parameters()) {
    if (!isResult(parameter)) continue;
    for (const ScalarPlace& place : scalarsOf(*parameter.element)) {
      scalars.push_back({std::string(parameter.name) + place.member + place.component, place.scalar});
    }
  }
  return scalars;
}

Call::Call(sk::Device& device, const Subject& subject, const Inputs& inputs)
    : subject_(subject), inputs_(inputs) {
  for (std::size_t p = 0; p < inputs.parameters.size(); ++p) {
    const Parameter& parameter = subject.parameters()[p];
    const ParameterInput& input = inputs.parameters[p];
    sk::detail::StreamOwner& stream = streams_.emplace_back();
    if (isValue(parameter) || input.isAbsent) continue;
    stream = device.createStream(*parameter.element, input.shape);
    if (isResult(parameter)) continue;
    sk::detail::write(sk::detail::wholeRegion(stream.get()), input.bytes.data(),
                      static_cast<std::size_t>(input.shape.size()));
  }
}

void Call::run(const sk::CallOptions& options, int draw) {
  std::vector<sk::Argument> arguments;
  for (std::size_t p = 0; p < streams_.size(); ++p) {
    const Parameter& parameter = subject_.parameters()[p];
    if (inputs_.parameters[p].isAbsent) {
      arguments.push_back({.isNone = true});
      continue;
    }
    if (!isValue(parameter)) {
      arguments.push_back({.region = sk::detail::wholeRegion(streams_[p].get())});
      continue;
    }
    const bool isSame = parameter.role == sk::program::Role::Iterator;  // the same in all draws
    const std::size_t at = isSame ? 0 : static_cast<std::size_t>(draw);
    arguments.push_back({.value = inputs_.parameters[p].bytes.data() + at * parameter.element->size});
  }
  sk::CallOptions all = options;
  const bool hasInputs = std::ranges::any_of(subject_.parameters(), [](const Parameter& parameter) {
    return parameter.role == sk::program::Role::Input;
  });
  if (subject_.isReduce() && !hasInputs) all.over = sk::GivenDomain{.shape = inputs_.extent.domain};
  subject_.call(arguments, all);
}

Results Call::results() const {
  Results results;
  for (std::size_t p = 0; p < streams_.size(); ++p) {
    const Parameter& parameter = subject_.parameters()[p];
    if (!isResult(parameter)) continue;
    const auto count = static_cast<std::size_t>(inputs_.extent.results.size());
    const std::size_t size = parameter.element->size;
    std::vector<std::byte> elements(count * size);
    sk::detail::read(sk::detail::wholeRegion(streams_[p].get()), elements.data(), count);
    for (const ScalarPlace& place : scalarsOf(*parameter.element)) {
      results.push_back(loadAll(place.scalar, elements.data() + place.offset, size, count));
    }
  }
  return results;
}

Results Call::exactResults() const {
  Results results;
  for (std::size_t p = 0; p < streams_.size(); ++p) {
    const Parameter& parameter = subject_.parameters()[p];
    if (!isResult(parameter)) continue;
    const auto count = static_cast<std::size_t>(inputs_.extent.results.size());
    const std::vector<sk::ComponentType> types = sk::componentsOf(*parameter.element, sk::RealType::Quad);
    const std::vector<ScalarPlace> places = scalarsOf(*parameter.element);
    const auto arrays = sk::nativeStream(sk::detail::wholeRegion(streams_[p].get())).components.arrays();
    for (std::size_t c = 0; c < places.size(); ++c) {
      const auto* from = static_cast<const std::byte*>(arrays[c]);
      const bool isQuad = places[c].scalar == Scalar::Float || places[c].scalar == Scalar::Double;
      results.push_back(isQuad ? loadQuads(from, count)
                               : loadAll(places[c].scalar, from, types[c].storedBytes, count));
    }
  }
  return results;
}

}  // namespace sk_tool
