// SPDX-License-Identifier: MIT
//
// The checks, in the order in which their messages help most.
#include "check.hpp"

#include <algorithm>

#include "assemble/sinks.hpp"
#include "check_argument.hpp"
#include "device_state.hpp"
#include "plan_run.hpp"
#include "stream_state.hpp"
#include "variant.hpp"

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

/// The stream of a variable output is taken whole, and has one dimension afterwards.
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
    if ((role != Role::Output && !assemble::isSink(kernel.parameters[i])) ||
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

/// Planes of the passes that a sink adds: of its list, and, where it is counted, one of counts to the pass that
/// writes the other outputs, and two of the tree to what its list's pass reads.
struct SinkPlanes {
  std::size_t counts = 0;
  std::size_t list = 0;
  std::size_t tree = 0;

  void add(const Parameter& sink) {
    const bool isCounted = assemble::isCounted(sink);
    counts += isCounted ? 1 : 0;
    tree = isCounted ? 2 : tree;
    const std::size_t texels = sink.role == Role::Scatter ? 1 : 0;
    list = std::max(list, sink.element->fields.size() + texels);
  }
};

/// The parameter whose stream says what device a kernel runs on: the first output that the spec parameters leave,
/// or the first sink; where there is none, the number of parameters.
std::size_t firstWritten(const Kernel& kernel, const assemble::SpecValues& specs) {
  const auto isOutput = [&](const Parameter& p) { return p.role == Role::Output && isNeeded(p, specs); };
  auto found = std::find_if(kernel.parameters.begin(), kernel.parameters.end(), isOutput);
  if (found == kernel.parameters.end()) {
    found = std::find_if(kernel.parameters.begin(), kernel.parameters.end(), assemble::isSink);
  }
  return static_cast<std::size_t>(found - kernel.parameters.begin());
}

}  // namespace

assemble::SpecValues specsOf(const Kernel& kernel, std::span<const Argument> arguments) {
  assemble::SpecValues specs{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    if (kernel.parameters[i].role == Role::Spec) {
      specs[count++] = specBits(kernel.parameters[i], arguments[i].value);
    }
  }
  return specs;
}

DeviceState* checkCall(const Kernel& kernel, std::span<const Argument> arguments) {
  const std::span<const Parameter> parameters = kernel.parameters;
  if (arguments.size() != parameters.size()) {
    fail(kernel, "{} arguments are given, but {} are declared", arguments.size(), parameters.size());
  }
  const assemble::SpecValues specs = specsOf(kernel, arguments);
  const std::size_t first = firstWritten(kernel, specs);
  if (first == parameters.size()) {
    return nullptr;
  }
  checkGiven(kernel, parameters[first], arguments[first]);
  const StreamState& firstStream = checkStream(kernel, parameters[first], arguments[first].region);
  DeviceState& device = *firstStream.device;
  const Shape domain = domainOf(kernel, arguments, specs);
  if (domain.rank() == 0) {
    fail(Error::Kind::Shape, kernel,
         "no input of the domain's own shape and no iterator with one says how many elements there are; "
         "give one");
  }
  checkElements(kernel, device, domain);
  std::size_t written = 0;
  std::size_t read = 0;
  SinkPlanes sinks;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& parameter = parameters[i];
    const StreamRegion& region = arguments[i].region;
    if (isValue(parameter)) {
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
        written += parameter.element->fields.size();
        checkOutputShape(kernel, parameters[first], domain, parameter, region.shape);
        checkDisjoint(kernel, arguments, specs, i);
        break;
      case Role::VariableOutput:
      case Role::Scatter:
        sinks.add(parameter);
        if (parameter.role == Role::Scatter) {
          checkScatter(kernel, parameter, region.shape, device);
        } else {
          checkVariableOutput(kernel, parameter, stream);
        }
        checkDisjoint(kernel, arguments, specs, i);
        break;
      case Role::Gather:
        read += parameter.element->fields.size();
        checkGatherShape(kernel, parameter, region.shape, domain);
        break;
      case Role::Input:
        read += parameter.element->fields.size();
        checkInputShape(kernel, parameter, arguments[i], parameters[first], domain);
        break;
      case Role::Uniform:
      case Role::Iterator:
      case Role::Spec:
      case Role::Accumulator: break;
    }
  }
  device.checkProgram(kernel);
  if (planFor(kernel, device.limits) == nullptr) {
    checkUniforms(kernel, device);
    checkPlanes(kernel, device, std::max(written + sinks.counts, sinks.list), read + sinks.tree);
  }
  const bool hasSinks = sinks.list > 0;  // which are emptied where there is no element
  return domain.size() == 0 && !hasSinks ? nullptr : &device;
}

Shape domainOf(const Kernel& kernel, std::span<const Argument> arguments, const assemble::SpecValues& specs) {
  Shape domain;
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const Role role = kernel.parameters[i].role;
    const Shape& shape = arguments[i].region.shape;
    if (!isNeeded(kernel.parameters[i], specs)) {
      continue;
    }
    if (role == Role::Output) {
      return shape;
    }
    if ((role != Role::Input && role != Role::Iterator) || arguments[i].fit != program::Fit::Same) {
      continue;
    }
    if (domain.rank() == 0) {
      domain = shape;
    }
    for (int d = 0; shape.rank() == domain.rank() && d < shape.rank(); ++d) {
      if (domain[d] == 1) {
        domain = domain.with(d, shape[d]);
      }
    }
  }
  return domain;
}

}  // namespace sk
