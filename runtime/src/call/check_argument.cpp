// SPDX-License-Identifier: MIT
//
// Implements the checks of single arguments.
#include "call/check_argument.hpp"

#include <algorithm>

#include "call/check_written.hpp"
#include "call/iterator.hpp"
#include "device/device_state.hpp"
#include "device/region.hpp"
#include "device/stream_state.hpp"
#include "sk/limits.hpp"

namespace sk {

using program::Element;
using program::Field;
using program::Fit;
using program::Kernel;
using program::Parameter;
using program::Role;

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
  checkWritten(kernel, parameter, stream);
  return stream;
}

void checkSameDevice(const Kernel& kernel, const Parameter& a, const StreamState& first, const Parameter& b,
                     const StreamState& second) {
  if (first.device != second.device) {
    fail(Error::Kind::Device, kernel,
         "'{}' and '{}' are streams of two devices ('{}' and '{}'); copy one of them through host memory",
         a.name, b.name, first.device->name(), second.device->name());
  }
}

void checkInputShape(const Kernel& kernel, const Parameter& input, const Argument& argument,
                     const Parameter& first, const Shape& domain) {
  const Shape& shape = seenShape(argument.region);
  if (argument.fit != Fit::Same && isPlaced(argument.region)) refusePlaced(kernel, input);
  if (fitsDomain(shape, argument.fit, domain)) {
    return;
  }
  if (argument.fit != Fit::Same) {
    fail(Error::Kind::Shape, kernel, "'{}' has shape {}, and the domain {}; {}", input.name, toString(shape),
         toString(domain), requirementOf(argument.fit));
  }
  if (first.role != Role::Output) {
    fail(
        Error::Kind::Shape, kernel,
        "'{}' has shape {}, but the inputs together have {}; give them the same shape, or extent 1 where one "
        "repeats",
        input.name, toString(shape), toString(domain));
  }
  fail(Error::Kind::Shape, kernel,
       "'{}' has shape {}, but the output '{}' has {}; give them the same shape, or extent 1 where "
       "'{}' repeats",
       input.name, toString(shape), first.name, toString(domain), input.name);
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
    fail(kernel, "'{}' has no value", parameter.name);
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
      const bool isDouble = field.scalar == program::Scalar::Double;  // two components of 32 bits
      components += isDouble ? 2U * field.width : field.width;
    }
  }
  if (components > static_cast<std::size_t>(device.limits.uniformComponents)) {
    fail(Error::Kind::Device, kernel,
         "its uniforms have {} components, but this device has room for {}; read large arrays as gathers",
         components, device.limits.uniformComponents);
  }
}

}  // namespace sk
