// SPDX-License-Identifier: MIT
//
// Checks of one argument, which kernels and reductions share. Each throws sk::Error naming the kernel and
// the parameter.
#pragma once

#include <utility>

#include <fmt/format.h>

#include "sk/call.hpp"
#include "sk/error.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"

namespace sk {

class DeviceState;

template <class... Values>
[[noreturn]] void fail(Error::Kind kind, const program::Kernel& kernel, fmt::format_string<Values...> format,
                       Values&&... values) {
  throw Error(fmt::format("{}: {}", kernel.name, fmt::format(format, std::forward<Values>(values)...)), kind);
}
template <class... Values>
[[noreturn]] void fail(const program::Kernel& kernel, fmt::format_string<Values...> format,
                       Values&&... values) {
  fail(Error::Kind::Misuse, kernel, format, std::forward<Values>(values)...);
}

/// A stream that lives, of the type that the parameter declares.
StreamState& checkStream(const program::Kernel& kernel, const program::Parameter& parameter,
                         const StreamRegion& region);

void checkSameDevice(const program::Kernel& kernel, const program::Parameter& a, const StreamState& first,
                     const program::Parameter& b, const StreamState& second);

/// `first`: the parameter that the domain is told by: an output, or any other where the inputs make it.
void checkInputShape(const program::Kernel& kernel, const program::Parameter& input, const Argument& argument,
                     const program::Parameter& first, const Shape& domain);

void checkGatherShape(const program::Kernel& kernel, const program::Parameter& gather, const Shape& shape,
                      const Shape& domain);

/// Whether two regions have an element in common.
bool overlap(const StreamRegion& a, const StreamRegion& b);

/// Whether the parameter takes a value and no stream.
bool isValue(const program::Parameter& parameter);

/// Everything but streams: that there is a value, and that iterators go over the domain.
void checkValue(const program::Kernel& kernel, const program::Parameter& parameter, const Argument& argument,
                const Shape& domain);

/// That a stream which the kernel needs is not sk::none.
void checkGiven(const program::Kernel& kernel, const program::Parameter& parameter, const Argument& argument);

/// That the device can number the elements of a domain (sk/limits.hpp), which may have more of them than any stream.
void checkElements(const program::Kernel& kernel, const DeviceState& device, const Shape& domain);

/// That the device has room for the kernel's uniforms. A driver may need more than the components that are counted
/// here, and says so in its own words then.
void checkUniforms(const program::Kernel& kernel, const DeviceState& device);

}  // namespace sk
