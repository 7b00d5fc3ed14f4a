// SPDX-License-Identifier: MIT
//
// GlDevice::run: runs a kernel over the domain that its outputs determine. A repeated call allocates no host
// memory, unless an output cannot be drawn in place.
#include <algorithm>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "assemble/region_layout.hpp"
#include "call/resolved_call.hpp"
#include "gl/texture.hpp"
#include "gl_device/append/append_call.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/memory/layout.hpp"
#include "gl_device/memory/render_target.hpp"
#include "gl_device/pass/kernel_operands.hpp"
#include "gl_device/pass/output_targets.hpp"
#include "gl_device/pass/pass.hpp"
#include "gl_device/pass/pass_trace.hpp"
#include "gl_device/program/variant.hpp"
#include "sk/error.hpp"
#include "sk/program.hpp"

namespace sk {

namespace {

// Runs a kernel that is too large for one pass, by the compiler's plan. run_kernel.cpp decides where the
// outputs are drawn.

/// A call with checked arguments, which all passes of the plan share.
struct PlannedCall {
  std::span<const Operand> operands;  ///< one per parameter of the whole kernel
  std::span<const std::span<RenderTarget>> outputs;  ///< likewise: the planes to draw outputs to
  const assemble::RegionLayout& domain;
  const Layout& layout;  ///< of the stream that the domain is a region of
  std::span<const assemble::Rect> rects;
};

using program::Parameter;
using program::Pass;
using program::Plan;
using program::Role;
using program::Stack;

/// Copies all layers of a plane (one if it is not layered) to the layers first, first + step, ... of a
/// texture.
void copyLayers(GlDevice& device, RenderTarget& plane, gl::Texture& to, std::int32_t first,
                std::int32_t step) {
  const gl::TextureSize& shape = plane.texture.size();
  gl::Framebuffer& framebuffer = plane.framebufferIn(device.bound());
  device.passes().beginCopy();
  for (std::int32_t layer = 0; layer < std::max(shape.layers, 1); ++layer) {
    if (shape.layers > 0) {
      framebuffer.selectLayer(device.bound(), layer);
    }
    to.copyLayer(device.bound(), framebuffer.name(), first + layer * step, shape.width, shape.height);
  }
}

/// Copies the planes of a stack to one array texture: the first layers of all planes, then the second ones,
/// and so on.
gl::Texture copyStack(GlDevice& device, const Stack& stack, std::span<const Operand> operands) {
  std::vector<RenderTarget*> planes;   // null if a stream is omitted
  const auto count = static_cast<std::int32_t>(stack.layers.size());
  gl::TextureSize shape{1, 1, 1};
  for (const program::ArgumentPlane& place : stack.layers) {
    const std::span<RenderTarget> renderTargets = operands[place.argument].planes;
    planes.push_back(renderTargets.empty() ? nullptr : &renderTargets[place.plane]);
    if (!renderTargets.empty()) {
      const gl::TextureSize& plane = renderTargets[place.plane].texture.size();
      shape.width = std::max(shape.width, plane.width);
      shape.height = std::max(shape.height, plane.height);
      shape.layers = std::max(shape.layers, plane.layers);
    }
  }
  shape.layers *= count;
  gl::Texture texture(device.bound(), gl::formatOf(stack.scalar, stack.width), shape);
  if (texture.name() == 0) {
    device.context().throwIfLost();
    throw Error(fmt::format("'{}' has no room for inputs that share a texture: {} layers of {} x {} texels",
                            device.capabilities.renderer, shape.layers, shape.width, shape.height),
                Error::Kind::Memory);
  }
  const assemble::Rect texels{0, 0, shape.width, shape.height * shape.layers};
  const PassScope traced(device, {"copy", "to layers", "blit"}, texels, texture.format().texelBytes());
  for (std::int32_t i = 0; i < count; ++i) {
    if (RenderTarget* plane = planes[static_cast<std::size_t>(i)]) {
      copyLayers(device, *plane, texture, i, count);
    }
  }
  return texture;
}

class PlanExecution {
 public:
  PlanExecution(GlDevice& device, const Plan& plan, const PlannedCall& call) : device_(device), call_(call) {
    for (const program::Element* element : plan.temporaries) {
      temporaries_.emplace_back(device.memory())
          .add(*element, call.layout.texture, "a value saved between passes");
    }
    for (const Stack& stack : plan.stacks) {
      stacks_.push_back(copyStack(device, stack, call.operands));
    }
  }
  PlanExecution(const PlanExecution&) = delete;
  PlanExecution& operator=(const PlanExecution&) = delete;

  /// Makes the driver start compiling the program of a pass. False if the program exists already.
  bool start(const Pass& pass) {
    selectOperands(pass);
    return targets_.empty() || programs(pass).startKernelProgram(pass.kernel, operands_, call_.domain);
  }

  /// Prepares everything that draw() needs. Throws sk::Error if the driver rejects something.
  void prepare(const Pass& pass) {
    selectOperands(pass);
    if (targets_.empty()) return;
    preparedPass(device_, programs(pass).kernelProgram(pass.kernel, operands_, call_.domain), targets_);
  }

  void draw(const Pass& pass) {
    selectOperands(pass);
    if (targets_.empty()) {   // all of its outputs are omitted
      return;
    }
    runKernel(device_, pass.kernel, operands_, call_.domain, call_.rects, targets_, stacks_);
  }

 private:
  ProgramCache& programs(const Pass& pass) const {
    return device_.programs().selectedFor(pass.kernel, targets_);
  }
  void selectOperands(const Pass& pass) {
    operands_.clear();
    targets_.clear();
    for (std::size_t i = 0; i < pass.operands.size(); ++i) {
      const Parameter& parameter = pass.kernel.parameters[i];
      operands_.push_back(operandOf(pass.operands[i]));
      if (parameter.role == Role::Output) {
        addTargets(parameter, planesOf(pass.operands[i]));
      }
    }
  }

  /// Temporaries have the layout of the domain.
  Operand operandOf(const program::PassOperand& operand) {
    return operand.isTemporary
               ? Operand{.regionLayout = call_.domain, .planes = temporaries_[operand.index].planes}
               : call_.operands[operand.index];
  }
  std::span<RenderTarget> planesOf(const program::PassOperand& operand) {
    return operand.isTemporary ? std::span<RenderTarget>(temporaries_[operand.index].planes)
                               : call_.outputs[operand.index];
  }
  void addTargets(const Parameter& parameter, std::span<RenderTarget> planes) {
    if (planes.empty()) {
      return;
    }
    const std::size_t count = parameter.planeCount == 0 ? planes.size() : parameter.planeCount;
    for (RenderTarget& plane : planes.subspan(parameter.firstPlane, count)) {
      targets_.push_back(&plane);
    }
  }

  GlDevice& device_;
  const PlannedCall& call_;
  std::deque<PlanesLease> temporaries_;
  std::vector<gl::Texture> stacks_;
  std::vector<Operand> operands_;
  std::vector<RenderTarget*> targets_;
};

/// Runs the passes. No operand may read the planes of an output. Calls begin() before the first pass draws,
/// after everything that may fail; throws sk::Error before that.
void runPlan(GlDevice& device, const Plan& plan, const PlannedCall& call,
             const std::function<void()>& begin) {
  PlanExecution execution(device, plan, call);
  for (const Pass& pass : plan.passes) {
    if (!execution.start(pass)) break;   // then the other programs exist, too
  }
  for (const Pass& pass : plan.passes) execution.prepare(pass);
  begin();
  for (const Pass& pass : plan.passes) {
    execution.draw(pass);
  }
}

using program::Kernel;

/// Runs one call with checked arguments and a nonempty domain; by tiles if they are given.
void runOverOutputs(GlDevice& device, const ResolvedCall& call, const assemble::TilePlan* tiles = nullptr) {
  const Kernel& kernel = call.kernel;
  const KernelOperands operands(device, kernel, call.arguments, call.specs, call.plan, {}, call.options.box,
                                call.place);
  OutputTargets targets(device, kernel, call.arguments, call.specs, operands.get(), operands.domain(),
                        operands.layout(), call.options.box);
  const DrawnRects rects(partOf(operands.domain(), call.domain.rank(), call.options.box), operands.layout());
  if (call.plan != nullptr) {
    const std::vector<std::span<RenderTarget>> drawn = targets.planesOfOutputs();
    runPlan(device, *call.plan, {operands.get(), drawn, operands.domain(), operands.layout(), rects.get()},
            [&] { targets.begin(); });
  } else {
    ProgramCache& programs = tiles == nullptr ? device.programs().selectedFor(kernel, targets.planes())
                                              : device.programs().selected();
    if (call.options.target == Target::Compute && programs.stage() == assemble::Stage::Fragment)
      device.programs().failForImages(kernel);
    KernelProgram& program = tiles == nullptr
                                 ? programs.kernelProgram(kernel, operands.get(), operands.domain())
                                 : programs.tileProgram(kernel, *tiles, operands.get(), operands.domain());
    const PreparedPass pass = preparedPass(device, program, targets.planes());
    const assemble::Task task{.work = tiles == nullptr ? assemble::Work::Elements : assemble::Work::Tiles};
    targets.begin();
    runKernel(device, pass, kernel, operands.get(), operands.domain(), rects.get(), targets.planes(), {},
              task);
  }
  targets.putInPlace();
}

}  // namespace

void GlDevice::run(const ResolvedCall& call) {
  programs_.checkOptions(call.kernel, call.options);
  runUnchecked(call);
}

void GlDevice::runTiles(const ResolvedCall& call, const assemble::TilePlan& plan) {
  programs_.checkOptions(call.kernel, call.options);
  const DeviceScope scope(*this);
  const gl::LabelGroup group(context().labels(), call.kernel.name);
  programs_.select(call.options, assemble::Stage::Compute);
  runOverOutputs(*this, call, &plan);
}

void GlDevice::runUnchecked(const Kernel& kernel, std::span<const Argument> arguments,
                            const CallOptions& options) {
  runUnchecked(resolveCall(kernel, arguments, limits, options));
}

void GlDevice::runUnchecked(const ResolvedCall& called) {
  const ResolvedCall call = called.of(precisionVariant(called.kernel, called.options), limits);
  const assemble::Stage stage = programs_.stageOf(call.kernel, classOf(call.kernel, call.options.order),
                                                  call.options, call.domain.size());
  const DeviceScope scope(*this);
  const gl::LabelGroup group(context().labels(), called.kernel.name);
  programs_.select(call.options, stage);
  checkStorages(call.kernel, call.arguments, call.specs, call.plan);
  if (!hasAppendOutputs(call.kernel)) {
    runOverOutputs(*this, call);
  } else if (call.domain.size() == 0) {
    runOverNothing(call);
  } else {
    runWithAppendOutputs(*this, call);
  }
}

}  // namespace sk
