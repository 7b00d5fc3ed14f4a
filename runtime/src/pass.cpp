// SPDX-License-Identifier: MIT
//
// Binding and drawing.
#include "pass.hpp"

#include <array>

#include "copy_kernel.hpp"
#include "device_state.hpp"
#include "gl/commands.hpp"

namespace sk {

namespace {

using assemble::Placement;
using assemble::Rect;

void blit(DeviceState& device, Surface& from, const Placement& source, Surface& to, const Placement& target) {
  const GLuint read = from.framebufferName(device.bound);
  const GLuint draw = to.framebufferName(device.bound);
  gl::blit(device.bound, read, {source.origin[0], source.origin[1]}, draw,
           {target.origin[0], target.origin[1]}, target.extent[0], target.extent[1]);
}

}  // namespace

namespace {

/// Those planes of a parameter that are not in a bundle.
int bindOwnPlanes(DeviceState& device, const program::Parameter& parameter, std::span<Surface> planes,
                  int unit) {
  if (parameter.layers.empty()) {
    return bindPlanes(device, planes, unit);
  }
  for (std::size_t plane = 0; plane < planes.size(); ++plane) {
    if (parameter.layers[plane].bundle < 0) {
      unit = bindPlanes(device, planes.subspan(plane, 1), unit);
    }
  }
  return unit;
}

}  // namespace

int bindPlanes(DeviceState& device, std::span<Surface> planes, int unit) {
  for (const Surface& plane : planes) {
    device.bound.texture(unit++, plane.texture.name());
  }
  return unit;
}

GLuint framebufferOf(DeviceState& device, std::span<Surface* const> planes) {
  if (planes.size() == 1) {
    return planes[0]->framebufferName(device.bound);
  }
  std::array<GLuint, gl::maxDrawBuffers> names{};
  for (std::size_t i = 0; i < planes.size(); ++i) {
    names[i] = planes[i]->texture.name();
  }
  return device.framebuffers.framebufferName(std::span(names).first(planes.size()));
}

void drawRects(DeviceState& device, std::span<const Rect> rects) {
  device.bound.vertexArray(device.vertexArray.name());
  for (const Rect& rect : rects) {
    device.bound.viewport(rect.x, rect.y, rect.width, rect.height);
    gl::drawTriangle();
  }
}

void bindOperands(DeviceState& device, KernelProgram& program, const program::Kernel& kernel,
                  std::span<const Operand> operands, std::span<const gl::ArrayTexture> bundles) {
  int unit = 0;
  std::array<int, gl::maxTextureUnits> filtered{};
  std::size_t filteredCount = 0;
  for (KernelProgram::Read& read : program.reads) {
    const Operand& operand = operands[read.parameter];
    if (read.sampler != 0) {
      device.bound.sampler(unit, read.sampler);
      filtered[filteredCount++] = unit;
    }
    unit = bindOwnPlanes(device, kernel.parameters[read.parameter], operand.planes, unit);
    read.uniforms.set(operand.placement);
  }
  for (const std::size_t bundle : program.bundles) {
    device.bound.arrayTexture(unit++, bundles[bundle].name());
  }
  for (KernelProgram::Value& value : program.values) {
    value.uniform.set(operands[value.parameter].value);
  }
  for (KernelProgram::Pair& pair : program.pairs) {
    pair.uniform.set(operands[pair.parameter].value);
  }
  for (KernelProgram::Value& step : program.steps) {
    step.uniform.set(operands[step.parameter].step.data());
  }
}

void drawKernel(DeviceState& device, const program::Kernel& kernel, std::span<const Operand> operands,
                const Placement& domain, std::span<const Rect> rects, GLuint framebuffer,
                std::span<const gl::ArrayTexture> bundles, const assemble::Task& task) {
  KernelProgram& program = device.programs.kernelProgram(kernel, operands, domain, task);
  device.bound.program(program.program.name());
  device.bound.framebuffer(framebuffer);
  bindOperands(device, program, kernel, operands, bundles);
  program.domain.set(domain);
  if (task.work == assemble::Work::List) {
    program.target.set(operands[task.sink].placement);
  }
  drawRects(device, rects);
  for (std::size_t i = 0; i < filteredCount; ++i) {
    device.bound.sampler(filtered[i], 0);
  }
}

void copyRegion(DeviceState& device, const program::Element& element, std::span<Surface> from,
                const Placement& source, std::span<Surface> to, const Placement& target) {
  for (std::size_t plane = 0; plane < from.size(); ++plane) {
    if (!source.linear && !target.linear) {
      blit(device, from[plane], source, to[plane], target);
      continue;
    }
    const Operand operands[] = {{nullptr, source, from.subspan(plane, 1)}, {}};
    drawKernel(device, copyKernel(element.fields[plane]), operands, target, assemble::drawnTexels(target),
               to[plane].framebufferName(device.bound));
  }
}

}  // namespace sk
