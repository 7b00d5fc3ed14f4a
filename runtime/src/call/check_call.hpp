// SPDX-License-Identifier: MIT
//
// Finds all errors in the arguments of a call before any of it runs: checks of one argument, which kernels and reductions share, and of
// the call of a kernel. Each throws sk::Error, which names the kernel, the parameters and the shapes.
#pragma once

#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "call/resolved_call.hpp"
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

/// Returns the argument's stream after checking that it is live and has the parameter's element type.
StreamState& checkStream(const program::Kernel& kernel, const program::Parameter& parameter,
                         const StreamRegion& region);

void checkSameDevice(const program::Kernel& kernel, const program::Parameter& a, const StreamState& first,
                     const program::Parameter& b, const StreamState& second);

/// What says which domain a call has: an output, or else WithOptions::over(), or else the inputs together.
struct DomainSource {
  const program::Parameter* output = nullptr;
  const GivenDomain* given = nullptr;
};

/// The first output that the spec parameters keep; null if there is none.
const program::Parameter* firstOutput(const program::Kernel& kernel, const assemble::SpecValues& specs);

/// Checks that something says the domain, which domainOf() has found, and that what is given agrees with the outputs.
void checkDomain(const program::Kernel& kernel, const DomainSource& source, const Shape& domain);

/// Checks that a given domain is for this device, the streams', or for any.
void checkGivenDevice(const program::Kernel& kernel, const std::optional<GivenDomain>& given,
                      const DeviceState& device);

void checkInputShape(const program::Kernel& kernel, const program::Parameter& input, const Argument& argument,
                     const DomainSource& source, const Shape& domain);

void checkGatherShape(const program::Kernel& kernel, const program::Parameter& gather, const Shape& shape,
                      const Shape& domain);

/// Whether the argument is a value instead of a stream; streams of one element may stand for uniforms.
bool isValue(const program::Parameter& parameter, const Argument& argument);

/// Checks that a stream which stands for a uniform has one element.
void checkUniformShape(const program::Kernel& kernel, const program::Parameter& uniform, const Shape& shape);

/// The planes of streams that stand for uniforms.
std::size_t uniformPlanes(const program::Kernel& kernel, std::span<const Argument> arguments);

/// Checks arguments that are not streams: values must exist, and iterators must fit the domain.
void checkValue(const program::Kernel& kernel, const program::Parameter& parameter, const Argument& argument,
                const Shape& domain);

/// Checks that a stream which the kernel needs is not sk::none.
void checkGiven(const program::Kernel& kernel, const program::Parameter& parameter, const Argument& argument);

/// Throws sk::Error: a parameter that is not an element or a gather takes no placed stream (sk/placed.hpp).
[[noreturn]] void refusePlaced(const program::Kernel& kernel, const program::Parameter& parameter);

/// Checks that the device can number the elements of a domain (sk/limits.hpp), which may exceed any stream.
void checkElements(const program::Kernel& kernel, const DeviceState& device, const Shape& domain,
                   bool isPlaced = false);

/// Checks that the device has room for the kernel's uniforms. A driver may need more than the components
/// counted here; it then reports an error of its own.
void checkUniforms(const program::Kernel& kernel, const DeviceState& device);

class DeviceState;

struct CheckedCall {
  DeviceState& device;
  ResolvedCall call;
};

/// Checks the arguments of a kernel: number, streams, device, element types, ranks, shapes, planes,
/// overlapping outputs. Returns their device and the call, without options but `over`. Returns nullopt if there is
/// nothing to do: there is no variable or scatter output, and either spec parameters switch off all element
/// outputs or the domain is empty.
std::optional<CheckedCall> checkCall(const program::Kernel& kernel, std::span<const Argument> arguments,
                                     const std::optional<GivenDomain>& over = {});

}  // namespace sk
