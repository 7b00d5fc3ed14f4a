// SPDX-License-Identifier: MIT
//
// GlDevice::reduce: reduces to values in host memory or to streams. reduce_passes.hpp runs the passes.
#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "assemble/reduce/group_fold.hpp"
#include "call/check_call.hpp"
#include "call/check_reduction.hpp"
#include "call/check_written.hpp"
#include "call/resolved_call.hpp"
#include "device/rows_state.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/memory/element_packing.hpp"
#include "gl_device/memory/layout.hpp"
#include "gl_device/pass/kernel_operands.hpp"
#include "gl_device/pass/output_targets.hpp"
#include "gl_device/pass/pass.hpp"
#include "gl_device/pass/pass_trace.hpp"
#include "gl_device/pass/reduce_passes.hpp"
#include "gl_device/transfer/buffered_transfer.hpp"
#include "gl_device/transfer/transfer.hpp"

namespace sk {

namespace {

// Folds in one dispatch, as a kernel computes its elements: each is read once, its outputs are stored, and what it contributes
// to the accumulators is folded by the work groups (assemble/reduce/group_fold.hpp). For kernels with folded outputs, and for
// reductions that read more than the elements of inputs.

using assemble::Rect;
using assemble::RegionLayout;
using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;

/// The arguments without the streams of parameters of a role.
std::vector<Argument> without(Role role, const ResolvedReduction& call) {
  std::vector<Argument> arguments(call.arguments.begin(), call.arguments.end());
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (call.reduction.fold.parameters[i].role == role) arguments[i].region.stream = nullptr;
  }
  return arguments;
}

Placement placeOf(const ResolvedReduction& call) { return {call.placed.box.begin, call.placed.whole}; }

/// The planes that one dispatch of a fold writes, with those of its accumulators.
std::size_t planesWritten(const Reduction& reduction, std::span<const Argument> arguments,
                          const assemble::SpecValues& specs) {
  std::size_t planes = assemble::accumulatorPlanes(reduction.fold);
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const Parameter& parameter = reduction.fold.parameters[i];
    if (parameter.role == Role::Output && assemble::isNeeded(parameter, specs) &&
        arguments[i].region.stream != nullptr)
      planes += glStream(arguments[i].region).held().fields.size();
  }
  return planes;
}

/// How the tiles of a call are divided among work groups.
class FoldedTiles {
 public:
  FoldedTiles(const KernelProgram& program, std::span<const Rect> rects)
      : width_(program.workGroup[0]), height_(program.workGroup[1]) {
    std::int64_t tiles = 0;
    for (const Rect& rect : rects) tiles += std::int64_t{across(rect)} * down(rect);
    tilesOfGroup_ = static_cast<std::int32_t>(assemble::tilesOfFoldingGroup(tiles));
    for (const Rect& rect : rects) groups_ += across(rect) * rowsOfGroups(rect);
  }

  std::int32_t groups() const { return groups_; }
  std::int32_t tilesOfGroup() const { return tilesOfGroup_; }
  std::int32_t across(const Rect& rect) const { return (rect.width + width_ - 1) / width_; }
  std::int32_t rowsOfGroups(const Rect& rect) const {
    return (down(rect) + tilesOfGroup_ - 1) / tilesOfGroup_;
  }

 private:
  std::int32_t down(const Rect& rect) const { return (rect.height + height_ - 1) / height_; }

  std::int32_t width_, height_;
  std::int32_t tilesOfGroup_ = 1;
  std::int32_t groups_ = 0;
};

/// The operands of the accumulators, which results are drawn to; all others are empty.
std::vector<Operand> operandsOfResults(const ResolvedReduction& call) {
  std::vector<Operand> operands(call.arguments.size());
  for (std::size_t i = 0; i < operands.size(); ++i) {
    if (call.reduction.fold.parameters[i].role == Role::Accumulator)
      operands[i] = regionOperand(call.arguments[i], call.domain);
  }
  return operands;
}

void bindList(GlDevice& device, const Kernel& fold, std::int32_t groups) {
  const std::size_t entry = assemble::accumulatorPlanes(fold) * assemble::foldPlaneBytes;
  device.passes().bind(PassBuffer::Folded, assemble::foldListStart + static_cast<std::size_t>(groups) * entry,
                       fold, "what its work groups fold");
}

void dispatchTiles(GlDevice& device, KernelProgram& program, const FoldedTiles& tiles,
                   std::span<const Rect> rects) {
  std::int32_t first = 0;
  for (const Rect& rect : rects) {
    const std::int32_t across = tiles.across(rect), rows = tiles.rowsOfGroups(rect);
    program.rect.set(device.bound(), {rect.x, rect.y, rect.width, rect.height});
    program.foldGroups.set(device.bound(), {tiles.groups(), tiles.tilesOfGroup(), across, first});
    device.passes().dispatch(across, rows);
    first += across * rows;
  }
}

/// Whether compute programs of a device have images of the formats of all that a reduction writes: partial results, and the elements
/// of streams, packed or not. The reduction may have more accumulators than the call.
bool mayStoreAll(const GlDevice& device, const ResolvedReduction& call, const Reduction& reduction) {
  const Kernel& fold = reduction.fold;
  for (std::size_t i = 0; i < fold.parameters.size(); ++i) {
    const Parameter& parameter = fold.parameters[i];
    if (parameter.role != Role::Accumulator && parameter.role != Role::Output) continue;
    const bool isStream = i < call.arguments.size() && call.arguments[i].region.stream != nullptr;
    if (isStream && !device.programs().mayStore(glStream(call.arguments[i].region).held())) return false;
    if (parameter.role == Role::Accumulator && !device.programs().mayStore(*parameter.element)) return false;
  }
  return true;
}

/// Whether a device has images and texture units for a fold, and the streams that it writes have no layers.
bool fits(const GlDevice& device, const Reduction& reduction, const ResolvedReduction& call) {
  const Kernel& fold = reduction.fold;
  const assemble::SpecValues specs = specsOf(fold, call.arguments);
  const std::size_t written = planesWritten(reduction, call.arguments, specs);
  const std::size_t read =
      assemble::textureUnits(fold, specs, {.uniforms = uniformPlanes(fold, call.arguments)});
  constexpr std::size_t buffers = 2;  // partial results, and the check of loops
  if (written > static_cast<std::size_t>(device.limits.images) ||
      written + buffers > static_cast<std::size_t>(device.capabilities.outputResources) ||
      read > static_cast<std::size_t>(device.limits.textureUnits) || !mayStoreAll(device, call, reduction))
    return false;
  const auto hasLayers = [&](const Shape& shape) {
    return layoutOf(shape, device.textureLimits()).whole.layered;
  };
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const Role role = call.reduction.fold.parameters[i].role;
    const StreamState* const stream = call.arguments[i].region.stream;
    if ((role == Role::Output || role == Role::Accumulator) && stream != nullptr && hasLayers(stream->shape))
      return false;
  }
  return !hasLayers(call.domain);
}

/// Whether another call writes outputs of the fold, which has no texels for them then.
bool omitsOutputs(const ResolvedReduction& call) {
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const bool isOutput = call.reduction.fold.parameters[i].role == Role::Output;
    if (isOutput && call.arguments[i].region.stream == nullptr) return true;
  }
  return false;
}

/// Where a dispatch stores the accumulators: a texel of planes of their own.
struct FoldTarget {
  std::span<RenderTarget* const> planes;
  RegionLayout element;
};

/// Dispatches a fold whose outputs have these planes, in order. Calls begin() after everything that may fail.
template <class Begin>
void dispatchFold(GlDevice& device, const ResolvedReduction& call, const KernelOperands& operands,
                  std::span<RenderTarget* const> outputs, const FoldTarget& target, Begin&& begin) {
  const Kernel& fold = call.reduction.fold;
  std::vector<RenderTarget*> planes(outputs.begin(), outputs.end());
  planes.insert(planes.end(), target.planes.begin(), target.planes.end());
  KernelProgram& program =
      device.programs().selected().foldProgram(call.reduction, operands.get(), operands.domain());
  const DrawnRects rects(operands.domain(), operands.layout());
  const FoldedTiles tiles(program, rects.get());
  bindList(device, fold, tiles.groups());
  begin();
  const PassScope traced(device, nameOf(fold.name, stepOf({.work = assemble::Work::Folds}), program), program,
                         operands.get(), rects.get(), texelBytesOf(outputs));
  device.bound().program(program.program.name());
  bindOperands(device, program, fold, operands.get());
  program.domain.set(device.bound(), operands.domain());
  const RegionLayout texel = texelOf(target.element);
  program.foldResult.set(device.bound(), {texel.origin[0], texel.origin[1], 0, 0});
  bindImages(device.bound(), planes);
  dispatchTiles(device, program, tiles, rects.get());
}

/// Writes the outputs and the accumulators, which are streams, of a call for which GlDevice::foldsBesideOutputs() or
/// gathersInGroups() is true, or of the compensated variant of such a call. A DeviceScope must be open, and compute programs
/// selected.
void foldInGroups(GlDevice& device, const ResolvedReduction& call) {
  const Kernel& fold = call.reduction.fold;
  const assemble::SpecValues specs = specsOf(fold, call.arguments);
  std::size_t firstResult = fold.parameters.size();
  for (std::size_t i = fold.parameters.size(); i-- > 0;) {
    if (fold.parameters[i].role != Role::Accumulator) continue;
    glStream(call.arguments[i].region).unpack();
    firstResult = i;
  }
  const std::vector<Argument> elements = without(Role::Accumulator, call),
                              folded = without(Role::Output, call);
  const KernelOperands operands(device, fold, elements, specs, nullptr, call.domain, {}, placeOf(call));
  OutputTargets outputs(device, fold, elements, specs, operands.get(), operands.domain(), operands.layout());
  const std::vector<Operand> results = operandsOfResults(call);
  const RegionLayout& result = results[firstResult].regionLayout;
  OutputTargets sums(device, fold, folded, specs, results, result,
                     glStream(call.arguments[firstResult].region).layout);
  dispatchFold(device, call, operands, outputs.planes(), {sums.planes(), result}, [&] {
    outputs.begin();
    sums.begin();
  });
  outputs.copy();
  sums.copy();
  outputs.exchange();
  sums.exchange();
}

/// The same, of a reduction to values, which `values` gets: one texel of each plane of its accumulators.
void foldInGroups(GlDevice& device, const ResolvedReduction& call, std::span<RenderTarget> values) {
  const Kernel& fold = call.reduction.fold;
  const assemble::SpecValues specs = specsOf(fold, call.arguments);
  const KernelOperands operands(device, fold, call.arguments, specs, nullptr, call.domain, {}, placeOf(call));
  dispatchFold(device, call, operands, {}, {pointersTo(values), assemble::valueLayout()}, [] {});
}

/// Whether foldInGroups() can fold a reduction without outputs, and is the faster way.
bool gathersInGroups(GlDevice& device, const ResolvedReduction& call) {
  const std::int64_t fewest = call.isToValues() ? device.traits.foldedInGroupsFrom : 1;
  const Kernel& fold = call.reduction.fold;
  const bool isGathered = assemble::readsElementIndex(fold) ||
                          std::ranges::any_of(fold.parameters, [](const Parameter& parameter) {
                            return parameter.role == Role::Gather;
                          });
  return device.programs().areDispatched() && isGathered && !omitsOutputs(call) && !call.scan &&
         call.rows == nullptr && call.blocks.size() == 1 && call.domain.size() >= fewest &&
         assemble::mayFoldInGroups(call.reduction) && fits(device, call.reduction, call);
}

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

bool GlDevice::foldsBesideOutputs(const ResolvedReduction& call) {
  const Reduction& plain = call.reduction;
  const program::CompensatedReduction* const second = plain.compensated;
  const bool mayFold = call.blocks.size() == 1 && call.domain.size() > 0 && !call.isToValues() &&
                       assemble::mayFoldInGroups(plain) &&
                       (second == nullptr || assemble::mayFoldInGroups(second->reduction));
  return mayFold &&
         programs_.stageOf(plain.fold, KernelClass::Reduces, call.options) == assemble::Stage::Compute &&
         fits(*this, second == nullptr ? plain : second->reduction, call);
}

void GlDevice::reduce(const ResolvedReduction& call) {
  const Kernel& fold = call.reduction.fold;
  programs_.checkOptions(fold, call.options);
  refuseFoldCheck(call.reduction);
  checkStorages(fold, call.arguments, specsOf(fold, call.arguments));
  assemble::Stage stage = programs_.stageOf(fold, KernelClass::Reduces, call.options);
  if (stage == assemble::Stage::Compute && !mayStoreAll(*this, call, call.reduction)) {
    if (!fold.drawn || call.options.target == Target::Compute) programs_.failForImages(fold);
    stage = assemble::Stage::Fragment;
  }
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
