// SPDX-License-Identifier: MIT
#include "call/precision.hpp"

#include <cstddef>
#include <deque>
#include <vector>

#include "call/check_argument.hpp"
#include "call/resolved_call.hpp"
#include "device/device_state.hpp"
#include "support/convert_elements.hpp"

namespace sk {

namespace {

using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;
using program::WideReduction;

[[noreturn]] void failWithoutForm(const Kernel& kernel, std::string_view form, std::string_view why) {
  fail(Error::Kind::Compile, kernel, "it has no form in {}: {}; call it in Precision::Single", form, why);
}

const WideReduction* wideForm(const Reduction& reduction) {
  if (reduction.wide == nullptr && !reduction.fold.whyNotWide.empty()) {
    failWithoutForm(reduction.fold, "doubles", reduction.fold.whyNotWide);
  }
  return reduction.wide;
}

void checkPlanes(const Reduction& plain, const Reduction& wide, const DeviceLimits& limits) {
  std::size_t planes = 0;
  for (const Parameter& parameter : wide.fold.parameters) {
    if (parameter.role == Role::Accumulator) planes += parameter.element->fields.size();
  }
  if (planes > static_cast<std::size_t>(limits.textureUnits)) {
    fail(Error::Kind::Device, plain.fold,
         "its accumulators take {} textures as doubles, but the device has units for {}; call it in "
         "Precision::Single",
         planes, limits.textureUnits);
  }
}

}  // namespace

const Reduction& halfForm(const Reduction& reduction) {
  if (reduction.half != nullptr) return *reduction.half;
  if (!reduction.fold.whyNotHalf.empty())
    failWithoutForm(reduction.fold, "half precision", reduction.fold.whyNotHalf);
  return reduction;
}

const Kernel& formOf(const Kernel& kernel, const CallOptions& options) {
  if (options.precision == Precision::Half) {
    if (kernel.half == nullptr && !kernel.whyNotHalf.empty()) {
      failWithoutForm(kernel, "half precision", kernel.whyNotHalf);
    }
    return kernel.half != nullptr ? *kernel.half : kernel;
  }
  if (!isWide(options)) return kernel;
  if (kernel.wide == nullptr && !kernel.whyNotWide.empty())
    failWithoutForm(kernel, "doubles", kernel.whyNotWide);
  return kernel.wide != nullptr ? *kernel.wide : kernel;
}

void checkTables(const Kernel& kernel, const CallOptions& options) {
  if (options.tables == Tables::On && takesForm(options)) {
    fail(kernel, "tables have the precision of floats; call it in Precision::Single, or without Tables::On");
  }
}

void reduceInForm(const CheckedReduction& checked, const Reduction& reduction,
                  std::span<const Argument> arguments, std::span<void* const> results,
                  const CallOptions& options) {
  DeviceState& device = checked.device;
  const bool isPlain = !device.takesForms() || checked.domain.size() == 0;
  const WideReduction* wide = isPlain || !isWide(options) ? nullptr : wideForm(reduction);
  if (wide == nullptr) {
    const Reduction& form = isPlain || isWide(options) ? reduction : halfForm(reduction);
    device.reduce(form, arguments, checked.domain, results, options);
    return;
  }
  checkPlanes(reduction, wide->reduction, device.limits);
  std::deque<std::vector<std::byte>> values;
  std::vector<void*> places;
  for (const Parameter& parameter : wide->reduction.fold.parameters) {
    if (parameter.role == Role::Accumulator) {
      places.push_back(values.emplace_back(parameter.element->size).data());
    }
  }
  device.reduce(wide->reduction, arguments, checked.domain, places, options);
  std::size_t next = 0;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const Parameter& plain = reduction.fold.parameters[i];
    if (plain.role != Role::Accumulator) continue;
    convertElements(*wide->reduction.fold.parameters[i].element, values[next].data(), *plain.element,
                    static_cast<std::byte*>(results[next]), 1);
    ++next;
  }
}

void reduceInForm(const CheckedReduction& checked, const Reduction& reduction,
                  std::span<const Argument> arguments, const CallOptions& options) {
  DeviceState& device = checked.device;
  const bool isPlain = !device.takesForms() || checked.domain.size() == 0;
  const WideReduction* wide = isPlain || !isWide(options) ? nullptr : wideForm(reduction);
  if (wide == nullptr) {
    const Reduction& form = isPlain || isWide(options) ? reduction : halfForm(reduction);
    device.reduce(form, arguments, checked.domain, checked.blocks, options);
    return;
  }
  checkPlanes(reduction, wide->reduction, device.limits);
  std::vector<Argument> folded(arguments.begin(), arguments.end());
  std::vector<Argument> finished;
  std::vector<detail::StreamOwner> doubles;
  for (std::size_t i = 0; i < folded.size(); ++i) {
    const Parameter& parameter = wide->reduction.fold.parameters[i];
    if (parameter.role != Role::Accumulator) continue;
    doubles.emplace_back(
        device.createStream(*parameter.element, arguments[i].region.shape, Storage::Single).release());
    folded[i] = {.region = detail::wholeRegion(doubles.back().get())};
    finished.push_back(folded[i]);
  }
  device.reduce(wide->reduction, folded, checked.domain, checked.blocks, options);
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (reduction.fold.parameters[i].role == Role::Accumulator) finished.push_back(arguments[i]);
  }
  device.run(resolveCall(wide->finish, finished, device.limits, options));
}

}  // namespace sk
