// SPDX-License-Identifier: MIT
#include "call/resolved_call.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>
#include <vector>

#include "assemble/program/texture_units.hpp"
#include "call/check_call.hpp"
#include "device/device_state.hpp"
#include "device/region.hpp"
#include "support/convert_elements.hpp"

namespace sk {

using assemble::isNeeded;
using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;
using program::WideReduction;

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
      if (arguments[i].value == nullptr)
        fail(kernel, "'{}' has no value; give it one", kernel.parameters[i].name);
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

Shape domainOf(const Kernel& kernel, std::span<const Argument> arguments, const assemble::SpecValues& specs,
               const std::optional<GivenDomain>& given) {
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
    if (given) continue;  // for an output
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
  return given ? given->shape : domain;
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
  const Shape domain = domainOf(kernel, arguments, specs, options.over);
  return {kernel, arguments, options, specs, domain, planFor(kernel, specs, limits)};
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

namespace {

[[noreturn]] void failWithoutVariant(const Kernel& kernel, std::string_view precision, std::string_view why) {
  fail(Error::Kind::Compile, kernel, "it has no form in {}: {}; call it in Precision::Single", precision,
       why);
}

const WideReduction* wideVariant(const Reduction& reduction) {
  if (reduction.wide == nullptr && !reduction.fold.whyNotWide.empty()) {
    failWithoutVariant(reduction.fold, "doubles", reduction.fold.whyNotWide);
  }
  return reduction.wide;
}

void checkPlanes(const Reduction& plain, const Reduction& wide, const DeviceLimits& limits) {
  const std::size_t planes = assemble::accumulatorPlanes(wide.fold);
  if (planes > static_cast<std::size_t>(limits.textureUnits)) {
    fail(Error::Kind::Device, plain.fold,
         "its accumulators take {} textures as doubles, but the device has units for {}; call it in "
         "Precision::Single",
         planes, limits.textureUnits);
  }
}

}  // namespace

void refuseScanOptions(const Kernel& kernel, const CallOptions& options) {
  if (options.scan != Scan::Default)
    fail(kernel, "it is not a scan; call it without Scan, or declare it 'scan void'");
  if (options.along) fail(kernel, "it is not a scan, so it goes along no dimension; call it without along");
}

const Reduction& halfVariant(const Reduction& reduction) {
  if (reduction.half != nullptr) return *reduction.half;
  if (!reduction.fold.whyNotHalf.empty())
    failWithoutVariant(reduction.fold, "half precision", reduction.fold.whyNotHalf);
  return reduction;
}

const Kernel& precisionVariant(const Kernel& kernel, const CallOptions& options) {
  if (options.precision == Precision::Half) {
    if (kernel.half == nullptr && !kernel.whyNotHalf.empty()) {
      failWithoutVariant(kernel, "half precision", kernel.whyNotHalf);
    }
    return kernel.half != nullptr ? *kernel.half : kernel;
  }
  if (!isWide(options)) return kernel;
  if (kernel.wide == nullptr && !kernel.whyNotWide.empty())
    failWithoutVariant(kernel, "doubles", kernel.whyNotWide);
  return kernel.wide != nullptr ? *kernel.wide : kernel;
}

void checkTables(const Kernel& kernel, const CallOptions& options) {
  if (options.tables == Tables::On && needsPrecisionVariant(options)) {
    fail(kernel, "tables have the precision of floats; call it in Precision::Single, or without Tables::On");
  }
}

void reduceInPrecision(const ResolvedReduction& call) {
  const Reduction& reduction = call.reduction;
  const bool isPlain = !call.device.usesPrecisionVariants() || call.domain.size() == 0;
  const WideReduction* wide = isPlain || !isWide(call.options) ? nullptr : wideVariant(reduction);
  if (wide == nullptr) {
    const Reduction& variant = isPlain || isWide(call.options) ? reduction : halfVariant(reduction);
    call.device.reduce(call.of(variant, call.arguments, call.values));
    return;
  }
  checkPlanes(reduction, wide->reduction, call.device.limits);
  reduceWide(call, *wide);
}

void reduceWide(const ResolvedReduction& call, const WideReduction& wide) {
  const Reduction& reduction = call.reduction;
  TemporaryResults doubles(call);
  std::vector<Argument> folded(call.arguments.begin(), call.arguments.end());
  std::vector<std::size_t> results;
  for (std::size_t i = 0; i < folded.size(); ++i) {
    const Parameter& parameter = wide.reduction.fold.parameters[i];
    if (parameter.role != Role::Accumulator) continue;
    folded[i] = doubles.add(*parameter.element);
    results.push_back(i);
  }
  std::vector<Argument> finished = doubles.arguments;
  for (const std::size_t i : results) finished.push_back(call.arguments[i]);
  WriteScope writes;
  addResults(writes, call);
  call.device.reduce(call.of(wide.reduction, folded, doubles.values));
  if (call.isToValues()) {
    for (std::size_t k = 0; k < results.size(); ++k) {
      convertElements(*wide.reduction.fold.parameters[results[k]].element,
                      static_cast<const std::byte*>(doubles.values[k]),
                      *reduction.fold.parameters[results[k]].element, static_cast<std::byte*>(call.values[k]),
                      1);
    }
    return;
  }
  if (storesBeside(call)) writes.begin();
  call.device.run(resolveCall(wide.finish, finished, call.device.limits, call.options));
  writes.commit();
}

}  // namespace sk
