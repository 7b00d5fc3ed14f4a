// SPDX-License-Identifier: MIT
//
// GlDevice::reduce: reduces to values in host memory or to streams. reduce_passes.hpp runs the passes.
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "call/check_argument.hpp"
#include "call/check_setting.hpp"
#include "call/resolved_call.hpp"
#include "device/rows_state.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/memory/element_packing.hpp"
#include "gl_device/pass/fold_kernel.hpp"
#include "gl_device/pass/output_targets.hpp"
#include "gl_device/pass/reduce_passes.hpp"
#include "gl_device/transfer/buffered_transfer.hpp"
#include "gl_device/transfer/transfer.hpp"

namespace sk {

namespace {

using assemble::RegionLayout;
using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;

/// Throws sk::Error if SK_CHECK asks for tests of folds, which only native devices run, lest the fold seem
/// tested.
void refuseFoldCheck(const Reduction& reduction) {
  if (!checksFolds() || reduction.commutative) return;
  fail(reduction.fold, "SK_CHECK=folds tries reduces natively; set SK_DEVICE=native, too");
}

/// Calls fn(element, itsPlanes) for each accumulator. `planes` are the planes of all of them, in order.
template <class Plane, class Fn>
void forEachAccumulator(const Kernel& fold, std::span<Plane> planes, Fn&& fn) {
  for (const Parameter& parameter : fold.parameters) {
    if (parameter.role == Role::Accumulator) {
      const std::size_t count = parameter.element->fields.size();
      fn(*parameter.element, planes.first(count));
      planes = planes.subspan(count);
    }
  }
}

/// Reads values from their textures to `results`. On a GPU, all planes are read through one buffer, which
/// waits for the device once. A software renderer has finished when the first plane is read, and a buffer
/// would only take some microseconds more.
void readValues(GlDevice& device, const Kernel& fold, std::span<RenderTarget> values,
                const RegionLayout& regionLayout, std::span<void* const> results) {
  auto result = results.begin();
  if (values.size() == 1 || !device.traits.readsValuesTogether) {
    forEachAccumulator(fold, values, [&](const program::Element& element, std::span<RenderTarget> planes) {
      download(device, element, planes, regionLayout, static_cast<std::byte*>(*result++));
    });
    return;
  }
  BufferedRead read(device);
  forEachAccumulator(fold, values, [&](const program::Element& element, std::span<RenderTarget> planes) {
    read.add(element, planes, regionLayout);
  });
  read.begin();
  for (std::size_t part = 0; part < results.size(); ++part) {
    read.take(part, static_cast<std::byte*>(results[part]));
  }
  device.throwPendingError();
}

/// Reads values from the device's value buffer, in which each plane takes valuePlaneBytes, to
/// `results`.
void takeValues(GlDevice& device, const Kernel& fold, std::span<void* const> results) {
  std::array<std::byte, valueBytes> texels;
  device.passes().read(PassBuffer::Values,
                       std::span(texels).first(assemble::accumulatorPlanes(fold) * valuePlaneBytes));
  device.throwPendingError();
  const std::byte* texel = texels.data();
  auto result = results.begin();
  for (const Parameter& parameter : fold.parameters) {
    if (parameter.role != Role::Accumulator) continue;
    auto* const value = static_cast<std::byte*>(*result++);
    for (const program::Field& field : parameter.element->fields) {
      unpackTexels(*parameter.element, field, texel, 1, value);
      texel += valuePlaneBytes;
    }
  }
}

void reduceToValues(GlDevice& device, const ResolvedReduction& call) {
  const Kernel& fold = call.reduction.fold;
  const RegionLayout layout = assemble::valueLayout();
  if (gathersInGroups(device, call)) {
    PlanesLease value(device.memory());
    takeAccumulators(fold, {1, 1}, "the result of a reduction", value);
    foldInGroups(device, call, value.planes);
    const TraceScope traced(device.trace.get(), "transfer", "read value");
    return readValues(device, fold, value.planes, layout, call.values);
  }
  ReducePasses passes(device, call);
  if (call.domain.size() > 0 && passes.mayEndInBuffer()) {
    passes.run(layout, {}, [] {});
    const TraceScope traced(device.trace.get(), "transfer", "read value");
    return takeValues(device, fold, call.values);
  }
  PlanesLease value(device.memory());
  takeAccumulators(fold, {1, 1}, "the result of a reduction", value);
  passes.run(layout, pointersTo(value.planes), [] {});
  const TraceScope traced(device.trace.get(), "transfer", "read value");
  readValues(device, fold, value.planes, layout, call.values);
}

void reduceToStreams(GlDevice& device, const ResolvedReduction& call) {
  const Kernel& fold = call.reduction.fold;
  const auto isResult = [](const Parameter& parameter) { return parameter.role == Role::Accumulator; };
  const auto unpackResults = [&] {
    for (std::size_t i = 0; i < call.arguments.size(); ++i) {
      if (isResult(fold.parameters[i])) glStream(call.arguments[i].region).unpack();
    }
  };
  if (!call.scan) unpackResults();
  std::optional<ReducePasses> passes(std::in_place, device, call);
  if (call.scan && !passes->scansByTexel()) {
    unpackResults();
    passes.emplace(device, call);
  }
  const auto first =
      static_cast<std::size_t>(std::ranges::find_if(fold.parameters, isResult) - fold.parameters.begin());
  const RegionLayout& layout = passes->operands()[first].regionLayout;
  const assemble::SpecValues specs = specsOf(fold, call.arguments);
  OutputTargets targets(device, fold, call.arguments, specs, passes->operands(), layout,
                        glStream(call.arguments[first].region).layout);
  std::vector<RenderTarget*> drawn;
  for (const std::span<RenderTarget> planes : targets.planesOfOutputs()) {
    for (RenderTarget& plane : planes) {
      drawn.push_back(&plane);
    }
  }
  const auto begin = [&] { targets.begin(); };
  if (call.rows != nullptr && call.scan) {
    passes->scanRows(*call.rows, layout, drawn, call.scan->isExclusive, begin);
  } else if (call.rows != nullptr) {
    passes->foldRows(*call.rows, layout, drawn, begin);
  } else if (call.scan) {
    passes->scan(layout, drawn, call.scan->isExclusive, begin);
  } else {
    passes->run(layout, drawn, begin);
  }
  targets.putInPlace();
}

}  // namespace

void GlDevice::reduce(const ResolvedReduction& call) {
  const Kernel& fold = call.reduction.fold;
  programs_.checkOptions(fold, call.options);
  refuseFoldCheck(call.reduction);
  checkStorages(fold, call.arguments, specsOf(fold, call.arguments));
  const assemble::Stage stage = programs_.stageOf(fold, KernelClass::Reduces, call.options);
  if (call.rows != nullptr) call.rows->makeTables(call.scan.has_value());
  const DeviceScope scope(*this);
  const gl::LabelGroup group(context().labels(), fold.name);
  programs_.select(call.options, stage);
  if (call.isToValues()) {
    reduceToValues(*this, call);
  } else if (storesBeside(call) || gathersInGroups(*this, call)) {
    foldInGroups(*this, call);
  } else {
    reduceToStreams(*this, call);
  }
}

}  // namespace sk
