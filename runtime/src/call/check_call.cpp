// SPDX-License-Identifier: MIT
//
// Implements the checks of calls, in the order in which their messages are most helpful.
#include "call/check_call.hpp"

#include <algorithm>

#include "assemble/append/append_passes.hpp"
#include "assemble/program/texture_units.hpp"
#include "call/check_argument.hpp"
#include "call/check_rows.hpp"
#include "call/placed.hpp"
#include "device/device_state.hpp"
#include "device/region.hpp"
#include "device/stream_state.hpp"

namespace sk {

namespace {

using assemble::isNeeded;
using program::Kernel;
using program::Parameter;
using program::Role;

void checkOutputShape(const Kernel& kernel, const Parameter& first, const Shape& domain,
                      const Parameter& output, const Shape& shape) {
  if (shape != domain) {
    fail(Error::Kind::Shape, kernel,
         "the outputs '{}' and '{}' have shapes {} and {}; give them the same shape", first.name, output.name,
         toString(domain), toString(shape));
  }
}

/// A variable output must be a whole stream; the call makes it one-dimensional.
void checkVariableOutput(const Kernel& kernel, const Parameter& output, const StreamState& stream) {
  if (stream.shape.rank() != 1) {
    fail(Error::Kind::Shape, kernel,
         "'{}' is a variable output, but its stream has shape {}; give it one of one dimension", output.name,
         toString(stream.shape));
  }
}

void checkScatter(const Kernel& kernel, const Parameter& output, const Shape& shape,
                  const DeviceState& device) {
  if (shape.rank() != output.rank) {
    fail(Error::Kind::Shape, kernel, "'{}' is declared with {} dimension(s), but its stream has shape {}",
         output.name, output.rank, toString(shape));
  }
  if (output.scatter != program::ScatterOp::Store && !device.combinesScattered()) {
    fail(Error::Kind::Device, kernel,
         "'{}' combines what is scattered to it, but '{}' cannot blend 32-bit floats (GL_EXT_float_blend); "
         "push indices and values to variable outputs, and combine them in a kernel",
         output.name, device.name());
  }
}

void checkDisjoint(const Kernel& kernel, std::span<const Argument> arguments,
                   const assemble::SpecValues& specs, std::size_t output) {
  for (std::size_t i = 0; i < output; ++i) {
    const Role role = kernel.parameters[i].role;
    if ((role != Role::Output && !assemble::isAppendOutput(kernel.parameters[i])) ||
        !isNeeded(kernel.parameters[i], specs)) {
      continue;
    }
    const bool isWhole =
        role == Role::VariableOutput || kernel.parameters[output].role == Role::VariableOutput;
    const bool isShared = isWhole ? arguments[i].region.stream == arguments[output].region.stream
                                  : overlap(arguments[i].region, arguments[output].region);
    if (isShared) {
      fail(kernel,
           "the outputs '{}' and '{}' overlap: both write elements of one stream; give them different "
           "streams, or regions that have no element in common",
           kernel.parameters[i].name, kernel.parameters[output].name);
    }
  }
}

void checkPlanes(const Kernel& kernel, const DeviceState& device, std::size_t written, std::size_t read) {
  if (written > static_cast<std::size_t>(device.limits.drawBuffers)) {
    fail(Error::Kind::Device, kernel,
         "the outputs have {} planes (one a scalar, vector, or member of a struct), but this device writes "
         "{} in one kernel; divide the kernel",
         written, device.limits.drawBuffers);
  }
  if (read > static_cast<std::size_t>(device.limits.textureUnits)) {
    fail(Error::Kind::Device, kernel,
         "the inputs have {} planes (one a scalar, vector, or member of a struct), but this device reads "
         "{} in one kernel; divide the kernel",
         read, device.limits.textureUnits);
  }
}

/// The values of a pass's Spec parameters.
assemble::SpecValues specsOf(const program::Pass& pass, const ResolvedCall& call) {
  assemble::SpecValues specs{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < pass.operands.size(); ++i) {
    const Parameter& parameter = pass.kernel.parameters[i];
    if (parameter.role != Role::Spec) continue;
    specs[count++] = specBits(parameter, call.arguments[pass.operands[i].index].value);
  }
  return specs;
}

/// Checks that the passes of a plan have room for streams that stand for uniforms: plans count on values.
void checkPlan(const ResolvedCall& call, const DeviceState& device) {
  for (const program::Pass& pass : call.plan->passes) {
    std::size_t uniforms = 0;
    for (std::size_t i = 0; i < pass.operands.size(); ++i) {
      const Parameter& parameter = pass.kernel.parameters[i];
      const bool isHeld = parameter.role == Role::Uniform && !pass.operands[i].isTemporary &&
                          call.arguments[pass.operands[i].index].value == nullptr;
      if (isHeld) uniforms += parameter.element->fields.size();
    }
    const std::size_t units =
        assemble::textureUnits(pass.kernel, specsOf(pass, call), {.uniforms = uniforms});
    if (units > static_cast<std::size_t>(device.limits.textureUnits)) {
      fail(Error::Kind::Device, call.kernel,
           "a pass reads {} planes, with those of streams that stand for uniforms, but this device reads {}; "
           "give values for uniforms",
           units, device.limits.textureUnits);
    }
  }
}

/// The planes that an append output adds to passes: those of its list and, if its elements are counted, one
/// of counts for the pass that writes the other outputs, and two of the histogram pyramid for the inputs of
/// the list's pass.
struct AppendPlanes {
  std::size_t counts = 0;
  std::size_t list = 0;
  std::size_t pyramid = 0;

  void add(const Parameter& appendOutput) {
    const bool isCounted = assemble::isCounted(appendOutput);
    counts += isCounted ? 1 : 0;
    if (isCounted) pyramid = assemble::pyramidUnits;
    const std::size_t texels = appendOutput.role == Role::Scatter ? 1 : 0;
    list = std::max(list, appendOutput.element->fields.size() + texels);
  }
};

/// The parameter whose stream determines the device: the first output that the spec parameters keep, else the
/// first append output, else the number of parameters.
std::size_t firstWritten(const Kernel& kernel, const assemble::SpecValues& specs) {
  const auto isOutput = [&](const Parameter& p) { return p.role == Role::Output && isNeeded(p, specs); };
  auto found = std::find_if(kernel.parameters.begin(), kernel.parameters.end(), isOutput);
  if (found == kernel.parameters.end()) {
    found = std::find_if(kernel.parameters.begin(), kernel.parameters.end(), assemble::isAppendOutput);
  }
  return static_cast<std::size_t>(found - kernel.parameters.begin());
}

}  // namespace

std::optional<CheckedCall> checkCall(const Kernel& kernel, std::span<const Argument> arguments) {
  const std::span<const Parameter> parameters = kernel.parameters;
  if (arguments.size() != parameters.size()) {
    fail(kernel, "{} arguments are given, but {} are declared", arguments.size(), parameters.size());
  }
  refuseRows(kernel, arguments);
  const assemble::SpecValues specs = specsOf(kernel, arguments);
  const std::size_t first = firstWritten(kernel, specs);
  if (first == parameters.size()) {
    return std::nullopt;
  }
  checkGiven(kernel, parameters[first], arguments[first]);
  const StreamState& firstStream = checkStream(kernel, parameters[first], arguments[first].region);
  DeviceState& device = *firstStream.device;
  const ResolvedCall call = resolveCall(kernel, arguments, device.limits);
  const Shape& domain = call.domain;
  if (domain.rank() == 0) {
    fail(Error::Kind::Shape, kernel,
         "no input of the domain's own shape and no iterator with one says how many elements there are; "
         "give one");
  }
  checkElements(kernel, device, domain, hasPlaced(arguments));
  std::size_t written = 0;
  AppendPlanes appendOutputs;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& parameter = parameters[i];
    const StreamRegion& region = arguments[i].region;
    if (isValue(parameter, arguments[i])) {
      checkValue(kernel, parameter, arguments[i], domain);
      continue;
    }
    if (!isNeeded(parameter, specs)) {
      continue;
    }
    checkGiven(kernel, parameter, arguments[i]);
    const StreamState& stream = checkStream(kernel, parameter, region);
    checkSameDevice(kernel, parameters[first], firstStream, parameter, stream);
    switch (parameter.role) {
      case Role::Output:
        written += heldBy(parameter).fields.size();
        checkOutputShape(kernel, parameters[first], domain, parameter, seenShape(region));
        checkDisjoint(kernel, arguments, specs, i);
        break;
      case Role::VariableOutput:
      case Role::Scatter:
        if (isPlaced(region)) refusePlaced(kernel, parameter);
        appendOutputs.add(parameter);
        if (parameter.role == Role::Scatter) {
          checkScatter(kernel, parameter, region.shape, device);
        } else {
          checkVariableOutput(kernel, parameter, stream);
        }
        checkDisjoint(kernel, arguments, specs, i);
        break;
      case Role::Gather: checkGatherShape(kernel, parameter, seenShape(region), domain); break;
      case Role::Input: checkInputShape(kernel, parameter, arguments[i], parameters[first], domain); break;
      case Role::Uniform:
        if (isPlaced(region)) refusePlaced(kernel, parameter);
        checkUniformShape(kernel, parameter, region.shape);
        break;
      case Role::Iterator:
      case Role::Spec:
      case Role::Accumulator: break;
    }
  }
  device.checkProgram(kernel);
  if (call.plan == nullptr) {
    checkUniforms(kernel, device);
    checkPlanes(
        kernel, device, std::max(written + appendOutputs.counts, appendOutputs.list),
        assemble::textureUnits(
            kernel, specs, {.uniforms = uniformPlanes(kernel, arguments), .pyramid = appendOutputs.pyramid}));
  } else if (uniformPlanes(kernel, arguments) > 0) {
    checkPlan(call, device);
  }
  const bool hasAppendOutputs = appendOutputs.list > 0;  // these are emptied if the domain is empty
  if (domain.size() == 0 && !hasAppendOutputs) return std::nullopt;
  return CheckedCall{device, call};
}

}  // namespace sk
