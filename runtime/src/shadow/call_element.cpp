// SPDX-License-Identifier: MIT
//
// What the report says of single elements of a call: which one is worst or first, and what it was computed from.
#include "shadow/shadow_call.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "device/region.hpp"
#include "sk/scalar_bytes.hpp"
#include "support/scalar_types.hpp"

namespace sk {

using program::Role;
using shadow::ElementRecord;
using shadow::ExceptionRecord;
using Kind = shadow::ExceptionRecord::Kind;

namespace {

/// ".y", ".t", or nothing for the only component of an element.
std::string componentName(const program::Element& element, int component) {
  int number = 0;
  for (const program::Field& field : element.fields) {
    for (int c = 0; c < field.width; ++c, ++number) {
      if (number != component) continue;
      const std::string member = field.path.empty() ? "" : fmt::format(".{}", field.path);
      return field.width == 1 ? member : fmt::format("{}.{}", member, "xyzw"[c]);
    }
  }
  return {};
}

program::Scalar scalarOf(const program::Element& element, int component) {
  for (const program::Field& field : element.fields) {
    if (component < field.width) return field.scalar;
    component -= field.width;
  }
  return program::Scalar::Float;
}

/// The index, rows first, of a row-major number.
std::vector<std::int64_t> indexIn(const Shape& shape, std::int64_t number) {
  std::vector<std::int64_t> index(static_cast<std::size_t>(shape.rank()));
  for (int d = shape.rank() - 1; d >= 0; --d) {
    index[static_cast<std::size_t>(d)] = number % shape[d];
    number /= shape[d];
  }
  return index;
}

/// The element of an input that belongs to element `number` of `domain`; -1 if the shapes do not say.
std::int64_t numberIn(const Shape& input, const Shape& domain, std::int64_t number) {
  if (input == domain) return number;
  if (input.size() == 1) return 0;
  if (input.rank() != domain.rank()) return -1;
  const std::vector<std::int64_t> index = indexIn(domain, number);
  std::int64_t result = 0;
  for (int d = 0; d < input.rank(); ++d) {
    if (input[d] != domain[d] && input[d] != 1) return -1;
    result = result * input[d] + (input[d] == 1 ? 0 : index[static_cast<std::size_t>(d)]);
  }
  return result;
}

/// The number in the stream of an element of a region.
std::int64_t numberInStream(const AffineRegion& region, std::int64_t number) {
  std::int64_t result = region.first;
  for (std::size_t d = 0; d < region.extent.size(); ++d) {
    result += number % region.extent[d] * region.stride[d];
    number /= region.extent[d];
  }
  return result;
}

void addUniform(std::vector<shadow::Input>& inputs, const program::Parameter& parameter, const void* value) {
  int component = 0;
  for (const program::Field& field : parameter.element->fields) {
    for (std::uint32_t c = 0; c < field.width; ++c, ++component) {
      const auto* const at =
          static_cast<const std::byte*>(value) + field.offset + c * program::hostBytes(field.scalar);
      inputs.push_back({std::string(parameter.name) + componentName(*parameter.element, component),
                        numberAt(at, field.scalar), shadow::isReal(field.scalar)});
    }
  }
}

}  // namespace

/// `value` is what the reference computes there with the device's inputs.
ElementRecord CallFollower::elementOf(const Written& written, std::int64_t element, int component,
                                      double value) const {
  const program::Parameter& parameter = parameterOf(written);
  const program::Element& type = written.stream != nullptr ? *written.stream->element : *parameter.element;
  ElementRecord record;
  record.call = number_;
  record.output = std::string(parameter.name) + componentName(type, component);
  record.isReal = shadow::isReal(scalarOf(type, component));
  if (written.device == nullptr) {  // another number of elements was pushed
    const NativeStream* const own = ownOf(written);
    const bool isOwn = own != nullptr && own->shape.size() != written.stream->shape.size();
    record.output += " (number of elements)";
    record.isReal = false;
    record.device = static_cast<double>(written.stream->shape.size());
    record.reference = static_cast<double>((isOwn ? *own : *written.stream->held()).shape.size());
    return record;
  }
  const Shape& shape = written.device->shape;
  record.device = shadow::valueAt(*written.device, component, element);
  record.reference = value;
  if (written.stream != nullptr) {
    record.index = indexIn(shape, element);
    const StreamRegion region = regionOf(written);
    if (isBox(region)) {
      for (int d = 0; d < shape.rank(); ++d) record.index[static_cast<std::size_t>(d)] += region.begin[d];
    }
  }
  addInputs(written, element, record);
  return record;
}

/// Which elements an output's element was computed from, if the roles of the parameters do not say.
std::string CallFollower::sourceText(const Written& written) const {
  const bool isReduced = call_.kind == ShadowedCall::Kind::Reduce || call_.kind == ShadowedCall::Kind::Fold;
  std::string read;
  for (const Read& each : read_) {
    if (parameterOf(each).role == Role::Uniform || each.device.stream == nullptr) continue;
    fmt::format_to(std::back_inserter(read), "{}{} of {}", read.empty() ? "" : " and ",
                   each.device.shape.size(), parameterOf(each).name);
  }
  if (isReduced) return fmt::format("it was computed from several elements: of {}", read);
  if (parameterOf(written).role == Role::VariableOutput)
    return fmt::format("which elements pushed it is not known: the call read {}", read);
  if (parameterOf(written).role == Role::Scatter)
    return fmt::format("which elements were scattered to it is not known: the call read {}", read);
  if (call_.kind == ShadowedCall::Kind::Scan)
    return "it was computed from all elements up to this one, or up to the one before";
  const bool hasGather =
      std::ranges::any_of(read_, [&](const Read& each) { return parameterOf(each).role == Role::Gather; });
  return hasGather ? "of a gather, the element at the same index is shown; the kernel may have read others"
                   : "";
}

void CallFollower::addInputs(const Written& written, std::int64_t element, ElementRecord& record) const {
  const Role role = parameterOf(written).role;
  const bool isOneByOne = (call_.kind == ShadowedCall::Kind::Kernel && role == Role::Output) ||
                          call_.kind == ShadowedCall::Kind::Scan;
  record.source = sourceText(written);
  const Shape& shape = written.device->shape;
  for (std::size_t i = 0; i < call_.arguments.size() && i < call_.kernel.parameters.size(); ++i) {
    const program::Parameter& given = call_.kernel.parameters[i];
    const bool isValue = given.role == Role::Uniform || given.role == Role::Spec;
    if (isValue && call_.arguments[i].value != nullptr)
      addUniform(record.inputs, given, call_.arguments[i].value);
    const auto read = std::ranges::find(read_, i, &Read::argument);
    if (read == read_.end() || read->device.stream == nullptr) continue;
    const bool isInStream = given.role == Role::Uniform;
    if (!isOneByOne && !isInStream) continue;
    const std::int64_t number = isInStream ? 0 : numberIn(read->device.shape, shape, element);
    if (number < 0) continue;
    const std::vector<std::int64_t> at =
        given.role == Role::Gather ? indexIn(read->device.shape, number) : std::vector<std::int64_t>{};
    const NativeStream& elements = nativeStream(read->device);
    for (std::size_t c = 0; c < elements.components.types().size(); ++c) {
      const int of = static_cast<int>(c);
      record.inputs.push_back({std::string(given.name) + componentName(*read->stream->element, of),
                               shadow::valueAt(elements, of, numberInStream(affine(read->device), number)),
                               shadow::isReal(elements.components.types()[c].scalar), at});
    }
  }
}

/// Whether the output has mostly the other sign than an input of its shape, by some of their elements.
bool CallFollower::turns(const Written& written) const {
  constexpr std::int64_t most = 256;
  if (written.device == nullptr || written.stream == nullptr) return false;
  const std::span<const ComponentType> types = written.device->components.types();
  const auto real =
      std::ranges::find_if(types, [](const ComponentType& type) { return shadow::isReal(type.scalar); });
  if (real == types.end()) return false;
  const int component = static_cast<int>(real - types.begin());
  const std::int64_t count = written.device->shape.size(), step = std::max<std::int64_t>(1, count / most);
  return std::ranges::any_of(read_, [&](const Read& read) {
    const bool isAlike = read.device.stream != nullptr && read.device.shape == written.device->shape &&
                         read.stream->element == written.stream->element;
    if (!isAlike) return false;
    const auto& input = static_cast<const NativeStream&>(*read.device.stream);
    const AffineRegion region = affine(read.device);
    double product = 0;
    for (std::int64_t i = 0; i < count; i += step) {
      product += shadow::valueAt(*written.device, component, i) *
                 shadow::valueAt(input, component, numberInStream(region, i));
    }
    return product < 0;
  });
}

/// Whether the call has read such a value, which the host may have written.
bool CallFollower::areRead(ExceptionRecord::Kind kind) const {
  for (const Read& read : read_) {
    if (read.device.stream == nullptr || kind == Kind::Flush) continue;
    const NativeStream& elements = nativeStream(read.device);
    const AffineRegion region = affine(read.device);
    for (std::size_t c = 0; c < elements.components.types().size(); ++c) {
      for (std::int64_t i = 0; i < read.device.shape.size(); ++i) {
        const double value = shadow::valueAt(elements, static_cast<int>(c), numberInStream(region, i));
        if (kind == Kind::Nan ? std::isnan(value) : std::isinf(value)) return true;
      }
    }
  }
  return false;
}

}  // namespace sk
