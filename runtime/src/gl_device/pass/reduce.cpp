// SPDX-License-Identifier: MIT
//
// sk::reduce: runs the assembler's schedule, from the inputs' planes through temporary ones to the
// results'.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "assemble/glsl/program_text.hpp"
#include "assemble/reduce/reduce_plan.hpp"
#include "call/check_argument.hpp"
#include "call/check_reduction.hpp"
#include "call/fold_check_setting.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/memory/element_packing.hpp"
#include "gl_device/pass/output_targets.hpp"
#include "gl_device/pass/pass.hpp"
#include "gl_device/pass/pass_trace.hpp"
#include "gl_device/transfer/buffered_transfer.hpp"
#include "gl_device/transfer/transfer.hpp"
#include "sk/call.hpp"

namespace sk {

namespace {

using assemble::Addressing;
using assemble::Index4;
using assemble::ReducePass;
using assemble::RegionLayout;
using assemble::StreamAccess;
using assemble::Walk;
using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;

/// Folds are tried natively alone; nobody should think that this one was.
void refuseFoldCheck(const Reduction& reduction) {
  if (!checksFolds() || reduction.commutative) return;
  fail(reduction.fold, "SK_CHECK=folds tries reduces natively; set SK_DEVICE=native, too");
}

/// fn(element, its planes) for each accumulator, given the planes of all of them.
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

/// Those of all accumulators.
std::size_t planesOf(const Kernel& fold) {
  std::size_t planes = 0;
  for (const Parameter& parameter : fold.parameters) {
    if (parameter.role == Role::Accumulator) planes += parameter.element->fields.size();
  }
  return planes;
}

/// New planes of all accumulators, in their order.
void takeAccumulators(GlDevice& device, const Kernel& fold, const assemble::TextureShape& shape,
                      std::string_view whatFor, PlanesLease& lease) {
  for (const Parameter& parameter : fold.parameters) {
    if (parameter.role == Role::Accumulator) {
      for (RenderTarget& plane : device.takePlanes(*parameter.element, shape, whatFor)) {
        lease.planes.push_back(std::move(plane));
      }
    }
  }
}

std::vector<RenderTarget*> pointersTo(std::span<RenderTarget> planes) {
  std::vector<RenderTarget*> pointers;
  for (RenderTarget& plane : planes) {
    pointers.push_back(&plane);
  }
  return pointers;
}

/// What the trace calls a pass.
std::string_view stepOf(Walk walk) {
  switch (walk) {
    case Walk::Partials:
    case Walk::PartialRows:
    case Walk::GroupedPartials: return "combine";
    case Walk::Nothing: return "identity";
    case Walk::Line:
    case Walk::Plane:
    case Walk::Box:
    case Walk::Rows:
    case Walk::Index: break;
  }
  return "fold";
}

/// One call, its arguments checked.
class ReduceCall {
 public:
  ReduceCall(GlDevice& device, const Reduction& reduction, std::span<const Argument> arguments,
             const Shape& domain, const Index4& blocks)
      : device_(device), reduction_(reduction), specs_(specsOf(reduction.fold, arguments)) {
    findOperands(arguments, domain);
    byTexel_ = foldsByTexel(blocks);
    if (!byTexel_ && domain.size() > 0) {
      for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (isRead(i)) glStream(arguments[i].region).unpack();
      }
      findOperands(arguments, domain);
    }
  }

  std::span<const Operand> operands() const { return operands_; }

  /// Whether the value that is left of some elements may stay in the device's buffer of values.
  bool mayEndInBuffer() const {
    return device_.programs().stage() == assemble::Stage::Compute && assemble::mayEndInBuffer(reduction_);
  }

  /// Folds the elements, of which there are some, to the planes of all results. Without targets, there is a value, which goes
  /// to the device's buffer of values.
  void fold(const Index4& blocks, const RegionLayout& result, std::span<RenderTarget* const> targets) {
    assemble::ReduceLimits limits = limitsOfPasses();
    limits.toBuffer = targets.empty();
    PlanesLease partials(device_);
    const assemble::Division division{.blocks = blocks,
                                      .byIndex = foldsByIndex(),
                                      .byTexel = byTexel_,
                                      .inAnyOrder = reduction_.commutative,
                                      .inGroups = assemble::foldsInGroups(reduction_)};
    const std::vector<ReducePass> passes = assemble::planReduction(elements_, result, limits, division);
    for (const ReducePass& pass : passes) {
      if (!start(pass)) break;  // nor are the others new
    }
    for (const ReducePass& pass : passes) {
      if (pass.toResult) {
        draw(pass, partials.planes, targets);
        continue;
      }
      PlanesLease next(device_);
      takeAccumulators(device_, reduction_.fold, pass.texture, "partial results", next);
      draw(pass, partials.planes, pointersTo(next.planes));
      std::swap(partials.planes, next.planes);
    }
  }

  /// Fills the planes of all results with the identities.
  void fill(const RegionLayout& result, std::span<RenderTarget* const> targets) {
    draw(assemble::planIdentities(result), {}, targets);
  }

 private:
  void findOperands(std::span<const Argument> arguments, const Shape& domain) {
    operands_.clear();
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      operands_.push_back(operandOf(i, arguments[i], domain));
    }
    elements_ = layoutOfElements(xFirst(domain));
  }

  /// In software a pass costs as much as some thousand texels, and a few threads have enough to do with few invocations.
  assemble::ReduceLimits limitsOfPasses() const {
    assemble::ReduceLimits limits{.texture = device_.textureLimits(), .grouped = mayGroup()};
    if (device_.programs().stage() == assemble::Stage::Compute) {
      limits.longRun = longRunOfGroups();
    } else if (device_.capabilities.isSoftware) {
      limits.longRun = 64;
    }
    return limits;
  }

  /// Of so many texels that a large GPU has enough work groups anyway, longer runs leave less to the passes behind.
  std::int32_t longRunOfGroups() const {
    const std::int64_t texels = assemble::elements(elements_.extent) / (byTexel_ ? assemble::lanes : 1);
    return texels >= 1 << 26 ? 32 : texels >= 1 << 24 ? 16 : 0;
  }

  /// Whether work groups may fold partial results together: they share an element of each accumulator an invocation.
  bool mayGroup() const {
    constexpr std::size_t planeBytes = 4 * sizeof(float);  // at most: four components, or two doubles
    const std::size_t planes = planesOf(reduction_.fold);
    return device_.programs().stage() == assemble::Stage::Compute &&
           planes * planeBytes * assemble::groupSize <= assemble::groupBytes &&
           planes <= static_cast<std::size_t>(device_.limits.drawBuffers);
  }

  /// Whether all inputs are packed and blocks made of whole texels, which are then read as such.
  bool foldsByTexel(const Index4& blocks) const {
    return elements_.packed && !foldsByIndex() && assemble::isWholeTexels(elements_) &&
           elements_.extent[0] / blocks[0] % assemble::lanes == 0;
  }

  Operand operandOf(std::size_t i, const Argument& argument, const Shape& domain) const {
    const Parameter& parameter = reduction_.fold.parameters[i];
    switch (parameter.role) {
      case Role::Uniform:
      case Role::Spec: return {.value = argument.value};
      case Role::Iterator:
        return domain.size() == 0 ? Operand{} : iteration(parameter, argument.value, domain);
      case Role::Input:
      case Role::Gather:
      case Role::Accumulator: break;
      case Role::Output:
      case Role::VariableOutput:
      case Role::Scatter: return {};
    }
    if (argument.region.stream == nullptr || !assemble::isNeeded(parameter, specs_)) {
      return {};
    }
    return regionOperand(argument, domain);
  }

  /// That of the first input which does not repeat. Where all do, each in another dimension, there is no
  /// such place, and elements are found by their index.
  RegionLayout layoutOfElements(const Index4& shape) const {
    for (std::size_t i = 0; i < operands_.size(); ++i) {
      if (isRead(i) && operands_[i].regionLayout.extent == shape) {
        return operands_[i].regionLayout;
      }
    }
    return {.extent = shape};
  }

  bool isRead(std::size_t i) const {
    const Parameter& parameter = reduction_.fold.parameters[i];
    return parameter.role == Role::Input && assemble::isNeeded(parameter, specs_);
  }

  /// Whether a run has to know where each of its elements is.
  bool foldsByIndex() const {
    bool byIndex = assemble::asksForPlace(reduction_.fold);
    for (std::size_t i = 0; i < operands_.size(); ++i) {
      byIndex = byIndex || (isRead(i) && !haveSameTexels(operands_[i].regionLayout, elements_));
    }
    return byIndex;
  }

  /// The operands of the combining kernel: planes of partial results, where there are some by now, and arguments
  /// of the fold.
  std::vector<Operand> operandsOfCombine(std::span<RenderTarget> partials) const {
    std::vector<Operand> operands;
    const Kernel& combine = reduction_.combine;
    for (std::size_t i = 0; i < combine.parameters.size(); ++i) {
      const Parameter& parameter = combine.parameters[i];
      if (parameter.role == Role::Input) {
        const std::size_t count = std::min(parameter.element->fields.size(), partials.size());
        operands.push_back({.regionLayout = elements_, .planes = partials.first(count)});
        partials = partials.subspan(count);
      } else if (parameter.role == Role::Accumulator) {
        operands.emplace_back();
      } else {
        operands.push_back(operands_[reduction_.combineOperands[i]]);
      }
    }
    return operands;
  }

  /// Draws a pass, for as many of the targets at a time as the device draws to.
  void draw(const ReducePass& pass, std::span<RenderTarget> partials,
            std::span<RenderTarget* const> targets) {
    const bool isPartial = assemble::isOfPartials(pass.variant.walk);
    const Kernel& kernel = isPartial ? reduction_.combine : reduction_.fold;
    const std::vector<Operand> operands = isPartial ? operandsOfCombine(partials) : operands_;
    if (pass.variant.toBuffer) device_.values.bind(device_.bound);
    forEachPart(
        pass, operands, [&](const assemble::ReduceVariant& variant, std::size_t first, std::size_t count) {
          ReduceProgram& program = device_.programs().reduceProgram(reduction_, variant);
          const bool isInBuffer = variant.toBuffer;
          const auto planes = isInBuffer ? targets : targets.subspan(first, count);
          const std::size_t bytes = isInBuffer ? count * gl::ValueBuffer::planeBytes : texelBytesOf(planes);
          const PassScope traced(device_, nameOf(reduction_.fold.name, stepOf(variant.walk), program.kernel),
                                 program.kernel, operands, pass.draws, bytes);
          device_.bound.program(program.kernel.program.name());
          bindOperands(device_, program.kernel, kernel, operands);
          for (const assemble::UniformValue& value : pass.uniforms) {
            program.uniform(value).set(value.value);
          }
          writeRects(device_, program.kernel, planes, pass.draws);
        });
  }

  /// Lets the driver begin with the programs of a pass. False where they are there already.
  bool start(const ReducePass& pass) {
    bool isNew = false;
    const bool isPartial = assemble::isOfPartials(pass.variant.walk);
    forEachPart(pass, isPartial ? operandsOfCombine({}) : operands_,
                [&](const assemble::ReduceVariant& variant, std::size_t, std::size_t) {
                  isNew = device_.programs().startReduceProgram(reduction_, variant) || isNew;
                });
    return isNew;
  }

  /// visit(variant, first, count) for as many of the planes at a time as the device draws to.
  template <class Visit>
  void forEachPart(const ReducePass& pass, std::span<const Operand> operands, Visit&& visit) const {
    assemble::ReduceVariant variant = pass.variant;
    if (variant.walk != Walk::Nothing) {
      addAccess(variant, assemble::isOfPartials(variant.walk) ? reduction_.combine : reduction_.fold,
                operands);
    }
    const auto most = static_cast<std::size_t>(device_.limits.drawBuffers);
    const std::size_t planes = planesOf(reduction_.fold);
    for (std::size_t first = 0; first < planes; first += most) {
      const std::size_t count = std::min(most, planes - first);
      if (planes > most) {
        variant.firstPlane = static_cast<std::uint8_t>(first);
        variant.planeCount = static_cast<std::uint8_t>(count);
      }
      visit(variant, first, count);
    }
  }

  /// Adds the choices that depend on the operands.
  void addAccess(assemble::ReduceVariant& variant, const Kernel& kernel,
                 std::span<const Operand> operands) const {
    assemble::Variant chosen = chooseVariant(kernel, operands, elements_);
    variant.specs = chosen.specs;
    for (std::size_t i = 0; i < operands.size(); ++i) {
      StreamAccess& access = chosen.access[i];
      if (variant.walk == Walk::Index && kernel.parameters[i].role == Role::Input) {
        const RegionLayout& regionLayout = operands[i].regionLayout;
        access.addressing = addressingOf(regionLayout);
        access.fit = operands[i].fit;
        access.view = regionLayout.origin != Index4{};
      }
    }
    variant.access = std::move(chosen.access);
  }

  GlDevice& device_;
  const Reduction& reduction_;
  const assemble::SpecValues specs_;
  std::vector<Operand> operands_;  ///< of the fold
  RegionLayout elements_;
  bool byTexel_ = false;
};

/// Waits for the device once, whatever the number of planes: on a GPU all of them come through one buffer. Software has
/// nothing left to do after the first, and a buffer takes it some microseconds more.
void readValues(GlDevice& device, const Kernel& fold, std::span<RenderTarget> values,
                const RegionLayout& regionLayout, std::span<void* const> results) {
  auto result = results.begin();
  if (values.size() == 1 || device.capabilities.isSoftware) {
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

/// Takes what a fold has left in the device's buffer of values, whose texels are wide.
void takeValues(GlDevice& device, const Kernel& fold, std::span<void* const> results) {
  std::array<std::byte, gl::ValueBuffer::bytes> texels;
  device.values.read(device.bound, std::span(texels).first(planesOf(fold) * gl::ValueBuffer::planeBytes));
  device.throwPendingError();
  const std::byte* texel = texels.data();
  auto result = results.begin();
  for (const Parameter& parameter : fold.parameters) {
    if (parameter.role != Role::Accumulator) continue;
    auto* const value = static_cast<std::byte*>(*result++);
    for (const program::Field& field : parameter.element->fields) {
      unpackTexels(*parameter.element, field, texel, 1, value);
      texel += gl::ValueBuffer::planeBytes;
    }
  }
}

}  // namespace

void GlDevice::reduce(const Reduction& reduction, std::span<const Argument> arguments, const Shape& domain,
                      std::span<void* const> results, const CallOptions& options) {
  checkOptions(reduction.fold, options);
  refuseFoldCheck(reduction);
  checkStorages(reduction.fold, arguments);
  const assemble::Stage stage = stageOf(reduction.fold, KernelClass::Reduces, options);
  const DeviceScope scope(*this);
  const gl::LabelGroup group(labels, reduction.fold.name);
  choose(options, stage);
  const RegionLayout regionLayout = assemble::valueLayout();
  ReduceCall call(*this, reduction, arguments, domain, regionLayout.extent);
  if (domain.size() > 0 && call.mayEndInBuffer()) {
    call.fold(regionLayout.extent, regionLayout, {});
    const TraceScope traced(trace.get(), "transfer", "read value");
    return takeValues(*this, reduction.fold, results);
  }
  PlanesLease value(*this);
  takeAccumulators(*this, reduction.fold, {1, 1}, "the result of a reduction", value);
  if (domain.size() == 0) {
    call.fill(regionLayout, pointersTo(value.planes));
  } else {
    call.fold(regionLayout.extent, regionLayout, pointersTo(value.planes));
  }
  const TraceScope traced(trace.get(), "transfer", "read value");
  readValues(*this, reduction.fold, value.planes, regionLayout, results);
}

void GlDevice::reduce(const Reduction& reduction, std::span<const Argument> arguments, const Shape& domain,
                      const Shape& blocks, const CallOptions& options) {
  checkOptions(reduction.fold, options);
  refuseFoldCheck(reduction);
  checkStorages(reduction.fold, arguments);
  const assemble::Stage stage = stageOf(reduction.fold, KernelClass::Reduces, options);
  const DeviceScope scope(*this);
  const gl::LabelGroup group(labels, reduction.fold.name);
  choose(options, stage);
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (reduction.fold.parameters[i].role == Role::Accumulator) glStream(arguments[i].region).unpack();
  }
  ReduceCall call(*this, reduction, arguments, domain, xFirst(blocks));
  const Kernel& fold = reduction.fold;
  const auto first = static_cast<std::size_t>(
      std::ranges::find(fold.parameters, Role::Accumulator, &Parameter::role) - fold.parameters.begin());
  const RegionLayout& regionLayout = call.operands()[first].regionLayout;
  OutputTargets targets(*this, fold, arguments, specsOf(fold, arguments), call.operands(), regionLayout,
                        glStream(arguments[first].region).layout);
  std::vector<RenderTarget*> drawn;
  for (const std::span<RenderTarget> planes : targets.planesOfOutputs()) {
    for (RenderTarget& plane : planes) {
      drawn.push_back(&plane);
    }
  }
  if (domain.size() == 0) {
    call.fill(regionLayout, drawn);
  } else {
    call.fold(xFirst(blocks), regionLayout, drawn);
  }
  targets.putInPlace();
}

}  // namespace sk
