// SPDX-License-Identifier: MIT
#include "shadow/given.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "device/region.hpp"
#include "shadow/copies.hpp"
#include "shadow/errors.hpp"
#include "shadow/recorder.hpp"
#include "sk/host_vector.hpp"
#include "sk/scalar_bytes.hpp"
#include "support/checked_size.hpp"
#include "support/scalar_types.hpp"

namespace sk {

using program::Role;
using shadow::GivenRecord;
using shadow::Recorder;
using shadow::Setting;

namespace {

template <class T>
void stored(T value, std::byte* bytes) {
  std::memcpy(bytes, &value, sizeof value);
}

/// The nearest number of an integer type; 0 for NaN.
template <class T>
T integer(double value) {
  using Limits = std::numeric_limits<T>;
  if (std::isnan(value)) return 0;
  if (value <= static_cast<double>(Limits::lowest())) return Limits::lowest();
  if (value >= static_cast<double>(Limits::max())) return Limits::max();
  return static_cast<T>(value);
}

void setNumber(double value, std::byte* bytes, program::Scalar scalar) {
  withScalarType(scalar, [&]<class T>(T) {
    if constexpr (std::is_same_v<T, bool>) {
      stored(value != 0, bytes);
    } else if constexpr (std::is_integral_v<T>) {
      stored(integer<T>(value), bytes);
    } else if constexpr (std::is_floating_point_v<T>) {
      stored(static_cast<T>(value), bytes);
    } else {
      stored(T(static_cast<float>(value)), bytes);
    }
  });
}

bool hasReals(const program::Element& element) {
  return std::ranges::any_of(element.fields,
                             [](const program::Field& field) { return shadow::isReal(field.scalar); });
}

/// Calls use(scalar, offset) for the numbers of an element that count: the real ones, or all if there are none.
template <class Use>
void forNumbers(const program::Element& element, Use&& use) {
  const bool onlyReals = hasReals(element);
  for (const program::Field& field : element.fields) {
    if (onlyReals && !shadow::isReal(field.scalar)) continue;
    for (std::size_t c = 0; c < field.width; ++c)
      use(field.scalar, field.offset + c * program::hostBytes(field.scalar));
  }
}

/// `storage`: of the stream that holds them, or Single.
std::string typeName(program::Scalar scalar, Storage storage) {
  switch (scalar) {
    case program::Scalar::Float: return storage == Storage::Half ? "half" : "float";
    case program::Scalar::Double: return "double";
    case program::Scalar::Half: return "half";
    case program::Scalar::Unorm8: return "unorm8";
    case program::Scalar::Snorm8: return "snorm8";
    case program::Scalar::Unorm16: return "unorm16";
    case program::Scalar::Snorm16: return "snorm16";
    case program::Scalar::Bool: return "bool";
    case program::Scalar::Uint:
    case program::Scalar::Ulong:
    case program::Scalar::Uchar:
    case program::Scalar::Ushort: return "uint";
    case program::Scalar::Int:
    case program::Scalar::Long:
    case program::Scalar::Char:
    case program::Scalar::Short: break;
  }
  return "int";
}

void narrowRange(GivenRecord& record, const std::optional<program::ValueRange>& range) {
  if (!range) return;
  record.rangeLow = record.hasRange ? std::fmax(record.rangeLow, range->low) : range->low;
  record.rangeHigh = record.hasRange ? std::fmin(record.rangeHigh, range->high) : range->high;
  record.hasRange = true;
}

/// The number of the record of a parameter, which exists then.
std::size_t recordFor(shadow::Report& report, const program::Kernel& kernel,
                      const program::Parameter& parameter, const program::Element& element, Storage storage) {
  const int number = Recorder::kernel(report, kernel.name);
  std::vector<GivenRecord>& given = report.given;
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (given[i].kernel == number && given[i].parameter == parameter.name) return i;
  }
  GivenRecord& record = given.emplace_back();
  record.kernel = number;
  record.parameter = parameter.name;
  record.type = element.name;
  bool isFirst = true;
  forNumbers(element, [&](program::Scalar scalar, std::size_t) {
    if (std::exchange(isFirst, false)) record.scalar = typeName(scalar, storage);
  });
  narrowRange(record, parameter.range);
  return given.size() - 1;
}

void addElements(GivenRecord& record, const program::Element& element, const std::byte* bytes,
                 std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i, bytes += element.size) {
    forNumbers(element, [&](program::Scalar scalar, std::size_t offset) {
      const double value = numberAt(bytes + offset, scalar);
      record.low = std::fmin(record.low, value);
      record.high = std::fmax(record.high, value);
    });
  }
  record.elements = std::max(record.elements, count);
  ++record.times;
}

bool concerns(const Setting& setting, const program::Kernel& kernel, const program::Parameter& parameter) {
  return setting.parameter == parameter.name && shadow::matchesAny({setting.kernel}, kernel.name);
}

/// Sets the numbers of elements.
void apply(const Setting& setting, const program::Element& element, std::byte* bytes, std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i) {
    forNumbers(element, [&](program::Scalar scalar, std::size_t offset) {
      setNumber(setting.value, bytes + i * element.size + offset, scalar);
    });
  }
}

/// Whether host memory, which has floats, holds less than the stream does.
bool isWiderThanHost(const ShadowStream& stream) {
  return stream.storage >= Storage::Extended && holdsOnlyFloats(*stream.element);
}

/// Adds the elements of a stream that the host has written.
void addStream(GivenRecord& record, ShadowStream& stream) {
  const StreamRegion all = detail::wholeRegion(&stream.inner());
  const std::int64_t count = stream.shape.size();
  if (isWiderThanHost(stream)) {
    for (const double value : detail::readReals(all)) {
      record.low = std::fmin(record.low, value);
      record.high = std::fmax(record.high, value);
    }
    record.elements = std::max(record.elements, count);
    ++record.times;
    return;
  }
  auto bytes = detail::hostVector<std::byte>(bytesOf(count, stream.element->size));
  detail::read(all, bytes.data(), static_cast<std::size_t>(count));
  addElements(record, *stream.element, bytes.data(), count);
}

/// The element that a setting names, or all of them.
StreamRegion regionFor(const Setting& setting, ShadowStream& stream) {
  StreamRegion region = detail::wholeRegion(&stream);
  if (setting.element < 0) return region;
  std::int64_t number = setting.element;
  for (int d = region.shape.rank() - 1; d >= 0; --d) {
    region.begin[d] = number % region.shape[d];
    number /= region.shape[d];
    region.shape = region.shape.with(d, 1);
  }
  return region;
}

/// Sets elements of a stream. Writes no others: those of a wide stream would be rounded on their way through host memory.
void apply(const Setting& setting, ShadowStream& stream) {
  const StreamRegion region = regionFor(setting, stream);
  const program::Element& element = *stream.element;
  const std::int64_t count = region.shape.size();
  if (isWiderThanHost(stream)) {
    const std::int64_t numbers = count * shadow::realComponents(element);
    return stream.writeReals(region,
                             std::vector<double>(static_cast<std::size_t>(numbers), setting.value).data());
  }
  auto bytes = detail::hostVector<std::byte>(bytesOf(count, element.size));
  detail::read(stream.innerOf(region), bytes.data(), static_cast<std::size_t>(count));
  apply(setting, element, bytes.data(), count);
  stream.write(region, bytes.data());
}

}  // namespace

GivenArguments::GivenArguments(ShadowDevice& device, const ShadowedCall& call)
    : device_(device), arguments_(call.arguments.begin(), call.arguments.end()), call_(call) {
  call_.arguments = arguments_;
  if (!device.isFollowing()) return;
  for (std::size_t i = 0; i < arguments_.size() && i < call.kernel.parameters.size(); ++i) {
    const Argument& argument = arguments_[i];
    const Role role = call.kernel.parameters[i].role;
    if (argument.isNone) continue;
    if (argument.value != nullptr) {
      if (role == Role::Uniform || role == Role::Spec) examineValue(i);
      continue;
    }
    if (role != Role::Uniform && role != Role::Input && role != Role::Gather) continue;
    if (argument.region.stream == nullptr || argument.region.stream->device != &device) continue;
    auto& stream = shadowStream(argument.region);
    stream.settle();
    if (stream.last.isByHost && stream.shape.size() > 0) examineStream(i, stream);
  }
}

void GivenArguments::examineValue(std::size_t argument) {
  const program::Parameter& parameter = call_.kernel.parameters[argument];
  const program::Element& element = *parameter.element;
  const auto* const given = static_cast<const std::byte*>(arguments_[argument].value);
  const shadow::Options& options = device_.recorder().options();
  if (options.listsGiven) {
    Recorder::Access report(device_.recorder());
    addElements(report->given[recordFor(*report, call_.kernel, parameter, element, Storage::Single)], element,
                given, 1);
  }
  for (std::size_t i = 0; i < options.settings.size(); ++i) {
    const Setting& setting = options.settings[i];
    if (!concerns(setting, call_.kernel, parameter)) continue;
    if (setting.element > 0) continue;  // there is one
    values_.emplace_back(given, given + element.size);
    apply(setting, element, values_.back().data(), 1);
    arguments_[argument].value = values_.back().data();
    device_.recorder().noteApplied(i);
  }
}

void GivenArguments::examineStream(std::size_t argument, ShadowStream& stream) {
  const program::Parameter& parameter = call_.kernel.parameters[argument];
  const shadow::Options& options = device_.recorder().options();
  if (stream.last.given >= 0) {  // another parameter has been given these elements before
    if (!options.listsGiven) return;
    Recorder::Access report(device_.recorder());
    const auto number = static_cast<std::size_t>(stream.last.given);
    narrowRange(report->given[number], parameter.range);
    return;
  }
  int record = 0;
  if (options.listsGiven) {
    Recorder::Access report(device_.recorder());
    const std::size_t number = recordFor(*report, call_.kernel, parameter, *stream.element, stream.storage);
    report->given[number].isStream = true;
    report->given[number].stream = stream.name;
    addStream(report->given[number], stream);
    record = static_cast<int>(number);
  }
  for (std::size_t i = 0; i < options.settings.size(); ++i) {
    const Setting& setting = options.settings[i];
    if (!concerns(setting, call_.kernel, parameter) || setting.element >= stream.shape.size()) continue;
    apply(setting, stream);
    device_.recorder().noteApplied(i);
  }
  stream.last.given = record;
}

}  // namespace sk
