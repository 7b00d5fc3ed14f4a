// SPDX-License-Identifier: MIT
//
// The passes of a plan.
#include "plan_run.hpp"

#include <algorithm>
#include <deque>
#include <vector>

#include <fmt/format.h>

#include "assemble/plans.hpp"
#include "device_state.hpp"
#include "gl/array_texture.hpp"
#include "pass.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

using program::Bundle;
using program::Parameter;
using program::Pass;
using program::Plan;
using program::Role;

gl::ArrayTexture copyBundle(DeviceState& device, const Bundle& bundle, std::span<const Operand> operands) {
  const auto isGiven = [&](const program::ArgumentPlane& place) {   // streams may be left out
    return !operands[place.argument].planes.empty();
  };
  const auto planeOf = [&](const program::ArgumentPlane& place) -> Surface& {
    return operands[place.argument].planes[place.plane];
  };
  GLsizei width = 1;
  GLsizei height = 1;
  for (const program::ArgumentPlane& place : bundle.layers) {
    if (!isGiven(place)) {
      continue;
    }
    width = std::max(width, planeOf(place).texture.width());
    height = std::max(height, planeOf(place).texture.height());
  }
  const gl::Format& format = gl::formatOf(bundle.scalar, bundle.width);
  const auto layers = static_cast<GLsizei>(bundle.layers.size());
  gl::ArrayTexture made(device.bound, format, width, height, layers);
  if (made.name() == 0) {
    throw Error(fmt::format("'{}' has no memory for inputs that share a texture: {} layers of {} x {} texels",
                            device.capabilities.renderer, layers, width, height));
  }
  for (GLint layer = 0; layer < layers; ++layer) {
    const program::ArgumentPlane& place = bundle.layers[static_cast<std::size_t>(layer)];
    if (!isGiven(place)) {
      continue;
    }
    Surface& plane = planeOf(place);
    made.copyLayer(device.bound, plane.framebufferName(device.bound), layer, plane.texture.width(),
                   plane.texture.height());
  }
  return made;
}

class PlanRun {
 public:
  PlanRun(DeviceState& device, const Plan& plan, const PlannedCall& call) : device_(device), call_(call) {
    for (const program::Element* element : plan.temporaries) {
      temporaries_.emplace_back(device).planes =
          device.takePlanes(*element, call.layout.width, call.layout.height, "a value saved between passes");
    }
    for (const Bundle& bundle : plan.bundles) {
      bundles_.push_back(copyBundle(device, bundle, call.operands));
    }
  }
  // The pool and the driver may give the names of the bundles out again.
  ~PlanRun() {
    if (!bundles_.empty()) {
      bundles_.clear();
      device_.bound.forget();
    }
  }
  PlanRun(const PlanRun&) = delete;
  PlanRun& operator=(const PlanRun&) = delete;

  void draw(const Pass& pass) {
    operands_.clear();
    targets_.clear();
    for (std::size_t i = 0; i < pass.operands.size(); ++i) {
      const Parameter& parameter = pass.kernel.parameters[i];
      operands_.push_back(operandOf(pass.operands[i]));
      if (parameter.role == Role::Output) {
        addTargets(parameter, planesOf(pass.operands[i]));
      }
    }
    if (targets_.empty()) {   // all of its outputs are left out
      return;
    }
    drawKernel(device_, pass.kernel, operands_, call_.domain, call_.rects, framebufferOf(device_, targets_),
               bundles_);
  }

 private:
  /// Temporaries lie as the domain does.
  Operand operandOf(const program::PassOperand& operand) {
    return operand.isTemporary
               ? Operand{.placement = call_.domain, .planes = temporaries_[operand.index].planes}
               : call_.operands[operand.index];
  }
  std::span<Surface> planesOf(const program::PassOperand& operand) {
    return operand.isTemporary ? std::span<Surface>(temporaries_[operand.index].planes)
                               : call_.outputs[operand.index];
  }
  void addTargets(const Parameter& parameter, std::span<Surface> planes) {
    if (planes.empty()) {
      return;
    }
    const std::size_t count = parameter.planeCount == 0 ? planes.size() : parameter.planeCount;
    for (Surface& plane : planes.subspan(parameter.firstPlane, count)) {
      targets_.push_back(&plane);
    }
  }

  DeviceState& device_;
  const PlannedCall& call_;
  std::deque<PlanesLease> temporaries_;
  std::vector<gl::ArrayTexture> bundles_;
  std::vector<Operand> operands_;
  std::vector<Surface*> targets_;
};

}  // namespace

const Plan* planFor(const program::Kernel& kernel, const DeviceLimits& limits) {
  const assemble::PassLimits pass{limits.drawBuffers, limits.textureUnits};
  const bool isWhole = kernel.planCount == 0 || assemble::fitsOnePass(kernel, pass);
  return isWhole ? nullptr : assemble::planWithin(kernel, pass);
}

void runPlan(DeviceState& device, const Plan& plan, const PlannedCall& call) {
  PlanRun run(device, plan, call);
  for (const Pass& pass : plan.passes) {
    run.draw(pass);
  }
}

}  // namespace sk
