// SPDX-License-Identifier: MIT
//
// Implements the checks of calls, in the order in which their messages are most helpful.
// Implements the checks of single arguments.
#include "call/check_call.hpp"

#include <algorithm>

#include "assemble/append/append_passes.hpp"
#include "assemble/program/texture_units.hpp"
#include "call/check_reduction.hpp"
#include "call/iterator.hpp"
#include "call/placed.hpp"
#include "device/device_state.hpp"
#include "device/region.hpp"
#include "device/stream_state.hpp"
#include "sk/limits.hpp"
#include "sk/scalar_bytes.hpp"

namespace sk {

namespace {

using assemble::isNeeded;
using program::Element;
using program::Field;
using program::Fit;
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

std::optional<CheckedCall> checkCall(const Kernel& kernel, std::span<const Argument> arguments,
                                     const std::optional<GivenDomain>& over) {
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
  const ResolvedCall call = resolveCall(kernel, arguments, device.limits, {.over = over});
  const Shape& domain = call.domain;
  const DomainSource source{parameters[first].role == Role::Output ? &parameters[first] : nullptr,
                            over ? &*over : nullptr};
  checkDomain(kernel, source, domain);
  checkGivenDevice(kernel, over, device);
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
      case Role::Input: checkInputShape(kernel, parameter, arguments[i], source, domain); break;
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

namespace {

bool isSameField(const Field& a, const Field& b) {
  return a.scalar == b.scalar && a.width == b.width && a.offset == b.offset && a.part == b.part;
}

/// One type may have several descriptors: in the runtime's headers and in each .sk.cpp.
bool isSameElement(const Element& a, const Element& b) {
  return &a == &b || (a.size == b.size && a.fields.size() == b.fields.size() &&
                      std::equal(a.fields.begin(), a.fields.end(), b.fields.begin(), isSameField));
}

bool isMultiple(std::int64_t extent, std::int64_t of) { return extent > 0 && of > 0 && extent % of == 0; }

bool fitsDomain(const Shape& shape, Fit fit, const Shape& domain) {
  bool fits = shape.rank() == domain.rank();
  const bool isEmpty = domain.size() == 0;
  for (int d = 0; fits && d < shape.rank(); ++d) {
    switch (fit) {
      case Fit::Same: fits = shape[d] == domain[d] || shape[d] == 1; break;
      case Fit::Stretched: fits = isEmpty || isMultiple(domain[d], shape[d]); break;
      case Fit::Strided: fits = isEmpty || isMultiple(shape[d], domain[d]); break;
      case Fit::StretchedOrStrided:
        fits = isEmpty || isMultiple(domain[d], shape[d]) || isMultiple(shape[d], domain[d]);
        break;
    }
  }
  return fits;
}

std::string_view requirementOf(Fit fit) {
  switch (fit) {
    case Fit::Same: break;
    case Fit::Stretched: return "to stretch it, each of its extents must divide the domain's";
    case Fit::Strided: return "to stride through it, each of its extents must be a multiple of the domain's";
    case Fit::StretchedOrStrided:
      return "to stretch and stride it, each of its extents must divide the domain's or be a multiple of it";
  }
  return {};
}

}  // namespace

StreamState& checkStream(const Kernel& kernel, const Parameter& parameter, const StreamRegion& region) {
  if (region.stream == nullptr) {
    fail(
        Error::Kind::Lost, kernel,
        "'{}' holds no stream: it was default-constructed or moved from; make one by device.stream<T>(shape)",
        parameter.name);
  }
  if (region.stream->device == nullptr) {
    fail(Error::Kind::Lost, kernel,
         "'{}' is a stream whose device has been destroyed; keep the device for as long as its streams "
         "are used",
         parameter.name);
  }
  if (!isSameElement(*region.stream->element, *parameter.element)) {
    fail(Error::Kind::Type, kernel, "'{}' is declared as {}, but its stream holds {}", parameter.name,
         parameter.element->name, region.stream->element->name);
  }
  StreamState& stream = *region.stream;
  if (parameter.role == Role::VariableOutput) {
    return stream;  // the call will resize it
  }
  stream.settle();
  if (!isInside(region)) {
    fail(Error::Kind::Shape, kernel,
         "'{}' is a view of shape {} that is no longer inside its stream, to which a kernel has pushed {} "
         "element(s); make the view after that call",
         parameter.name, toString(region.shape), stream.shape.size());
  }
  const bool isWritten = parameter.role == Role::Output || parameter.role == Role::Accumulator;
  if (stream.isLost() && !(isWritten && isWhole(region))) {
    fail(Error::Kind::Lost, kernel,
         "the elements of '{}' are lost, since what wrote them has failed; write all of the stream first",
         parameter.name);
  }
  return stream;
}

void checkSameDevice(const Kernel& kernel, const Parameter& a, const StreamState& first, const Parameter& b,
                     const StreamState& second) {
  if (first.device == second.device) return;
  if (first.device->name() == second.device->name()) {
    fail(Error::Kind::Device, kernel,
         "'{}' and '{}' are streams of two devices, two sk::Device of '{}'; create both by one of them, or "
         "copy one stream "
         "through host memory",
         a.name, b.name, first.device->name());
  } else {
    fail(Error::Kind::Device, kernel,
         "'{}' and '{}' are streams of two devices ('{}' and '{}'); copy one of them through host memory",
         a.name, b.name, first.device->name(), second.device->name());
  }
}

const Parameter* firstOutput(const Kernel& kernel, const assemble::SpecValues& specs) {
  const auto found = std::ranges::find_if(kernel.parameters, [&](const Parameter& parameter) {
    return parameter.role == Role::Output && isNeeded(parameter, specs);
  });
  return found == kernel.parameters.end() ? nullptr : &*found;
}

void checkDomain(const Kernel& kernel, const DomainSource& source, const Shape& domain) {
  if (source.given != nullptr && source.given->shape.rank() == 0) {
    fail(Error::Kind::Shape, kernel, "over() is given a shape without dimensions; give it 1 to 4 extents");
  }
  if (domain.rank() == 0) {
    fail(Error::Kind::Shape, kernel,
         "no input of the domain's own shape and no iterator with one says how many elements there are; give "
         "one, or call it over a shape, {}.over({{...}})(...)",
         kernel.name);
  }
  if (source.given != nullptr && source.given->shape != domain) {
    fail(Error::Kind::Shape, kernel,
         "over() gives the domain the shape {}, but the output '{}' has {}; give both the same, or call it "
         "without over()",
         toString(source.given->shape), source.output->name, toString(domain));
  }
}

void checkGivenDevice(const Kernel& kernel, const std::optional<GivenDomain>& given,
                      const DeviceState& device) {
  if (!given || given->device == nullptr || given->device == &device) return;
  fail(Error::Kind::Device, kernel,
       "over() gives the call to '{}', but its streams are on '{}'; give both one device",
       given->device->name(), device.name());
}

void checkInputShape(const Kernel& kernel, const Parameter& input, const Argument& argument,
                     const DomainSource& source, const Shape& domain) {
  const Shape& shape = seenShape(argument.region);
  if (argument.fit != Fit::Same && isPlaced(argument.region)) refusePlaced(kernel, input);
  if (fitsDomain(shape, argument.fit, domain)) {
    return;
  }
  if (argument.fit != Fit::Same) {
    fail(Error::Kind::Shape, kernel, "'{}' has shape {}, and the domain {}; {}", input.name, toString(shape),
         toString(domain), requirementOf(argument.fit));
  }
  if (source.output == nullptr && source.given != nullptr) {
    fail(Error::Kind::Shape, kernel,
         "'{}' has shape {}, but over() gives the domain the shape {}; give them the same shape, or extent 1 "
         "where '{}' repeats",
         input.name, toString(shape), toString(domain), input.name);
  }
  if (source.output == nullptr) {
    fail(
        Error::Kind::Shape, kernel,
        "'{}' has shape {}, but the inputs together have {}; give them the same shape, or extent 1 where one "
        "repeats",
        input.name, toString(shape), toString(domain));
  }
  fail(Error::Kind::Shape, kernel,
       "'{}' has shape {}, but the output '{}' has {}; give them the same shape, or extent 1 where "
       "'{}' repeats",
       input.name, toString(shape), source.output->name, toString(domain), input.name);
}

void checkGatherShape(const Kernel& kernel, const Parameter& gather, const Shape& shape,
                      const Shape& domain) {
  if (shape.rank() != gather.rank) {
    fail(Error::Kind::Shape, kernel, "'{}' is declared with {} dimension(s), but its stream has shape {}",
         gather.name, gather.rank, toString(shape));
  }
  if (shape.size() == 0 && domain.size() != 0) {
    fail(Error::Kind::Shape, kernel, "'{}' has shape {}: there is no element to read", gather.name,
         toString(shape));
  }
}

bool isValue(const Parameter& parameter, const Argument& argument) {
  const bool isStream = parameter.role == Role::Uniform && argument.value == nullptr;
  return !isStream && (parameter.role == Role::Uniform || parameter.role == Role::Iterator ||
                       parameter.role == Role::Spec);
}

void checkUniformShape(const Kernel& kernel, const Parameter& uniform, const Shape& shape) {
  if (shape.size() == 1) return;
  fail(Error::Kind::Shape, kernel,
       "'{}' is one value for all elements, but its stream has shape {}; give a value, or a stream or view "
       "of one "
       "element",
       uniform.name, toString(shape));
}

std::size_t uniformPlanes(const Kernel& kernel, std::span<const Argument> arguments) {
  std::size_t planes = 0;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const Parameter& parameter = kernel.parameters[i];
    if (parameter.role == Role::Uniform && arguments[i].value == nullptr) {
      planes += parameter.element->fields.size();
    }
  }
  return planes;
}

void checkValue(const Kernel& kernel, const Parameter& parameter, const Argument& argument,
                const Shape& domain) {
  if (argument.value == nullptr) {
    fail(kernel, "'{}' has no value; give it one", parameter.name);
  }
  if (parameter.role != Role::Iterator) {
    return;
  }
  const Shape& shape = argument.region.shape;
  if (shape.rank() != 0 && shape != domain) {
    fail(Error::Kind::Shape, kernel,
         "the iterator '{}' has shape {}, but the domain is {}; make it with the same shape, or with none",
         parameter.name, toString(shape), toString(domain));
  }
  if (domain.size() != 0) {
    checkIterator(kernel, parameter, argument.value, domain);
  }
}

void checkGiven(const Kernel& kernel, const Parameter& parameter, const Argument& argument) {
  if (argument.isNone && parameter.neededIf.text.empty())
    fail(kernel, "the kernel reads '{}', which is not given; give this member of the bundle {}",
         parameter.name, parameter.role == Role::Gather ? "a stream" : "a value");
  if (argument.isNone) {
    fail(kernel, "'{}' is sk::none, but the kernel needs it here, where {} holds; give a stream",
         parameter.name, parameter.neededIf.text);
  }
}

void refusePlaced(const Kernel& kernel, const Parameter& parameter) {
  fail(kernel,
       "'{}' is a placed stream, but only element inputs that are neither stretched nor strided, element "
       "outputs and "
       "gathers of a kernel may be parts of a whole; give the stream itself",
       parameter.name);
}

void checkElements(const Kernel& kernel, const DeviceState& device, const Shape& domain, bool isPlaced) {
  for (int d = 0; d < domain.rank() && domain.size() > 0; ++d) {
    if (domain[d] > mostExtent) {
      fail(Error::Kind::Shape, kernel,
           "the domain of shape {} has an extent above {}, where indices end; divide it", toString(domain),
           mostExtent);
    }
  }
  if (!isPlaced && domain.size() > device.limits.elements) {
    fail(Error::Kind::Shape, kernel, "the domain of shape {} has {} elements, but '{}' numbers {}; divide it",
         toString(domain), domain.size(), device.name(), device.limits.elements);
  }
}

void checkUniforms(const Kernel& kernel, const DeviceState& device) {
  std::size_t components = 0;
  for (const Parameter& parameter : kernel.parameters) {
    if (parameter.role != Role::Uniform) continue;
    for (const program::Field& field : parameter.element->fields) {
      components += program::is64Bit(field.scalar) ? 2U * field.width : field.width;
    }
  }
  if (components > static_cast<std::size_t>(device.limits.uniformComponents)) {
    fail(Error::Kind::Device, kernel,
         "its uniforms have {} components, but this device has room for {}; read large arrays as gathers",
         components, device.limits.uniformComponents);
  }
}

}  // namespace sk
