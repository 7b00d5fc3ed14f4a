// SPDX-License-Identifier: MIT
#include "gl_device/pass/multipass_plan.hpp"

#include <algorithm>
#include <deque>
#include <vector>

#include <fmt/format.h>

#include "gl/texture.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/pass/pass.hpp"
#include "gl_device/pass/pass_trace.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

using program::Bundle;
using program::Parameter;
using program::Pass;
using program::Plan;
using program::Role;

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

/// Copies the planes of a bundle to one array texture: the first layers of all planes, then the second ones,
/// and so on.
gl::Texture copyBundle(GlDevice& device, const Bundle& bundle, std::span<const Operand> operands) {
  std::vector<RenderTarget*> planes;   // null if a stream is omitted
  const auto count = static_cast<std::int32_t>(bundle.layers.size());
  gl::TextureSize shape{1, 1, 1};
  for (const program::ArgumentPlane& place : bundle.layers) {
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
  gl::Texture texture(device.bound(), gl::formatOf(bundle.scalar, bundle.width), shape);
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
    for (const Bundle& bundle : plan.bundles) {
      bundles_.push_back(copyBundle(device, bundle, call.operands));
    }
  }
  PlanExecution(const PlanExecution&) = delete;
  PlanExecution& operator=(const PlanExecution&) = delete;

  /// Makes the driver start compiling the program of a pass. False if the program exists already.
  bool start(const Pass& pass) {
    selectOperands(pass);
    return targets_.empty() ||
           device_.programs().selected().startKernelProgram(pass.kernel, operands_, call_.domain);
  }

  /// Prepares everything that draw() needs. Throws sk::Error if the driver rejects something.
  void prepare(const Pass& pass) {
    selectOperands(pass);
    if (targets_.empty()) return;
    preparedPass(device_, device_.programs().selected().kernelProgram(pass.kernel, operands_, call_.domain),
                 targets_);
  }

  void draw(const Pass& pass) {
    selectOperands(pass);
    if (targets_.empty()) {   // all of its outputs are omitted
      return;
    }
    runKernel(device_, pass.kernel, operands_, call_.domain, call_.rects, targets_, bundles_);
  }

 private:
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
  std::vector<gl::Texture> bundles_;
  std::vector<Operand> operands_;
  std::vector<RenderTarget*> targets_;
};

}  // namespace

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

}  // namespace sk
