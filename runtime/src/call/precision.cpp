// SPDX-License-Identifier: MIT
#include "call/precision.hpp"

#include <cstddef>
#include <vector>

#include "assemble/program/texture_units.hpp"
#include "call/check_call.hpp"
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
