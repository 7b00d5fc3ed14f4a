// SPDX-License-Identifier: MIT
//
// sk::reduce: runs the assembler's schedule, from the input's planes through temporary ones to the
// result's.
#include <array>
#include <utility>
#include <vector>

#include "assemble/reduce_plan.hpp"
#include "check.hpp"
#include "device_state.hpp"
#include "pass.hpp"
#include "sk/call.hpp"
#include "stream_state.hpp"
#include "transfer.hpp"

namespace sk {

namespace {

using assemble::Placement;
using assemble::ReducePass;
using program::Element;
using program::Reduction;

const Element& accumulatorOf(const Reduction& reduction) { return *reduction.fold.parameters[1].element; }

GLuint framebufferOf(DeviceState& device, std::span<Surface> planes) {
  std::array<Surface*, gl::maxDrawBuffers> targets{};
  for (std::size_t i = 0; i < planes.size(); ++i) {
    targets[i] = &planes[i];
  }
  return framebufferOf(device, std::span<Surface* const>(targets.data(), planes.size()));
}

void drawPass(DeviceState& device, const Reduction& reduction, const ReducePass& pass,
              std::span<Surface> source, std::span<Surface> target) {
  ReduceProgram& program = device.programs.reduceProgram(reduction, pass.variant);
  device.bound.program(program.program.name());
  device.bound.framebuffer(framebufferOf(device, target));
  bindPlanes(device, source, 0);
  for (const assemble::UniformValue& value : pass.uniforms) {
    program.uniform(value).set(value.value);
  }
  drawRects(device, pass.draws);
}

/// Folds the elements of a region, which is not empty, to the planes of a result.
void fold(DeviceState& device, const Reduction& reduction, const StreamRegion& input,
          std::span<Surface> result, const Placement& placement, bool aliased) {
  StreamState& stream = *input.stream;
  const assemble::ReduceLimits limits{.textureSize = device.limits.textureSize};
  PlanesLease partials(device);
  std::span<Surface> source = stream.planes;
  for (const ReducePass& pass :
       assemble::planReduction(placementOf(input, stream.layout), placement, limits, aliased)) {
    if (pass.toResult) {
      drawPass(device, reduction, pass, source, result);
      continue;
    }
    PlanesLease target(device);
    target.planes = device.takePlanes(accumulatorOf(reduction), pass.width, pass.height, "partial results");
    drawPass(device, reduction, pass, source, target.planes);
    std::swap(partials.planes, target.planes);
    source = partials.planes;
  }
}

/// Fills a region with the identity.
void fill(DeviceState& device, const Reduction& reduction, std::span<Surface> planes,
          const Placement& placement) {
  const Operand operands[] = {{nullptr, placement, planes}};
  drawKernel(device, device.programs.identityKernel(reduction), operands, placement,
             assemble::drawnTexels(placement), framebufferOf(device, planes));
}

}  // namespace

void reduce(const Reduction& reduction, const StreamRegion& input, void* result) {
  DeviceState& device = checkReduction(reduction, input);
  const DeviceScope scope(device);
  const Placement placement = assemble::valuePlacement();
  PlanesLease value(device);
  value.planes = device.takePlanes(accumulatorOf(reduction), placement.extent[0], placement.extent[1],
                                   "the result of a reduction");
  if (input.shape.size() == 0) {
    fill(device, reduction, value.planes, placement);
  } else {
    fold(device, reduction, input, value.planes, placement, false);
  }
  download(device, accumulatorOf(reduction), value.planes, placement, static_cast<std::byte*>(result));
}

void reduce(const Reduction& reduction, const StreamRegion& input, const StreamRegion& output) {
  DeviceState& device = checkReduction(reduction, input, output);
  if (output.shape.size() == 0) {
    return;
  }
  const DeviceScope scope(device);
  StreamState& result = *output.stream;
  const Placement placement = placementOf(output, result.layout);
  if (input.shape.size() == 0) {
    fill(device, reduction, result.planes, placement);
  } else {
    fold(device, reduction, input, result.planes, placement, input.stream == output.stream);
  }
}

}  // namespace sk
