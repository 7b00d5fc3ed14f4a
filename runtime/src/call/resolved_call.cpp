// SPDX-License-Identifier: MIT
#include "call/resolved_call.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "assemble/program/texture_units.hpp"
#include "device/device_state.hpp"
#include "device/region.hpp"

namespace sk {

using assemble::isNeeded;
using program::Kernel;
using program::Parameter;
using program::Role;

std::uint32_t specBits(const Parameter& parameter, const void* value) {
  if (parameter.element->fields[0].scalar == program::Scalar::Bool) {
    return *static_cast<const bool*>(value) ? 1u : 0u;
  }
  std::uint32_t bits = 0;
  std::memcpy(&bits, value, sizeof bits);
  return bits;
}

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

const Kernel& unrolledVariant(const Kernel& kernel, const assemble::SpecValues& specs) {
  for (const program::UnrolledKernel& variant : kernel.unrolled) {
    if (specs[variant.spec] == variant.value) return *variant.kernel;
  }
  return kernel;
}

Shape domainOf(const Kernel& kernel, std::span<const Argument> arguments, const assemble::SpecValues& specs) {
  Shape domain;
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const Role role = kernel.parameters[i].role;
    const Shape& shape = seenShape(arguments[i].region);
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

const program::Plan* planFor(const Kernel& kernel, const assemble::SpecValues& specs,
                             const DeviceLimits& limits) {
  const assemble::PassLimits pass{limits.drawBuffers, limits.textureUnits};
  const bool isWhole = kernel.planCount == 0 || assemble::fitsOnePass(kernel, pass, specs);
  return isWhole ? nullptr : assemble::planWithin(kernel, pass);
}

ResolvedCall resolveCall(const Kernel& kernel, std::span<const Argument> arguments,
                         const DeviceLimits& limits, const CallOptions& options) {
  const assemble::SpecValues specs = specsOf(kernel, arguments);
  return {
      kernel, arguments, options, specs, domainOf(kernel, arguments, specs), planFor(kernel, specs, limits)};
}

ResolvedCall ResolvedCall::of(const Kernel& variant, const DeviceLimits& limits) const {
  const program::Plan* variantPlan = &variant == &kernel ? plan : planFor(variant, specs, limits);
  return {variant, arguments, options, specs, domain, variantPlan, place};
}

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
