// SPDX-License-Identifier: MIT
#include "gl_device/pass/pass.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "assemble/elements/planes.hpp"
#include "gl/commands.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/memory/layout.hpp"
#include "gl_device/pass/pass_trace.hpp"
#include "gl_device/transfer/copy_kernel.hpp"
#include "gl_device/transfer/copy_regions.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

using assemble::Rect;
using assemble::RegionLayout;

void blit(GlDevice& device, RenderTarget& from, const RegionLayout& source, RenderTarget& to,
          const RegionLayout& target) {
  const GLuint read = from.framebufferIn(device.bound()).name();
  const GLuint draw = to.framebufferIn(device.bound()).name();
  device.passes().blit(read, {source.origin[0], source.origin[1]}, draw, {target.origin[0], target.origin[1]},
                       target.extent[0], target.extent[1]);
}

/// An image binds all layers of a texture: the rows of `rects` are numbered across layers.
void dispatchRects(GlDevice& device, KernelProgram& program, std::span<RenderTarget* const> planes,
                   std::span<const Rect> rects) {
  bindImages(device.bound(), planes);
  const auto groups = [&](GLsizei texels, GLint group) {
    return program.isGrouped ? texels : (texels + group - 1) / group;
  };
  constexpr GLsizei mostGroups = 65535;  // per dimension; guaranteed by GL 4.3
  for (const Rect& rect : rects) {
    const GLint rows = program.isGrouped ? mostGroups : mostGroups * program.workGroup[1];
    for (std::int32_t done = 0; done < rect.height; done += rows) {
      const std::int32_t height = std::min(rows, rect.height - done);
      program.rect.set(device.bound(), {rect.x, rect.y + done, rect.width, height});
      device.passes().dispatch(groups(rect.width, program.workGroup[0]),
                               groups(height, program.workGroup[1]));
    }
  }
}

/// Binds the planes of a parameter that are not in a stack. Returns the next unit.
int bindOwnPlanes(GlDevice& device, const program::Parameter& parameter, std::span<RenderTarget> planes,
                  int unit) {
  if (parameter.layers.empty()) {
    return bindPlanes(device, planes, unit);
  }
  for (std::size_t plane = 0; plane < planes.size(); ++plane) {
    if (parameter.layers[plane].stack < 0) {
      unit = bindPlanes(device, planes.subspan(plane, 1), unit);
    }
  }
  return unit;
}

}  // namespace

int bindPlanes(GlDevice& device, std::span<RenderTarget> planes, int unit) {
  for (const RenderTarget& plane : planes) {
    device.bound().texture(unit, plane.texture.name(), plane.texture.isLayered());
    device.bound().sampler(unit++, device.passes().samplers().nearest());
  }
  return unit;
}

DrawTarget targetOf(gl::BoundState& bound, RenderTarget& plane) {
  const gl::Texture& texture = plane.texture;
  return {&plane.framebufferIn(bound), texture.isLayered() ? texture.size().height : 0};
}

DrawTarget targetOf(GlDevice& device, std::span<RenderTarget* const> planes) {
  RenderTarget& first = *planes[0];
  if (planes.size() == 1) {
    return targetOf(device.bound(), first);
  }
  return {&device.memory().framebufferOf(planes),
          first.texture.isLayered() ? first.texture.size().height : 0};
}

void bindImages(gl::BoundState& bound, std::span<RenderTarget* const> planes) {
  int unit = 0;
  for (const RenderTarget* plane : planes) {
    bound.image(unit++, plane->texture.name(), plane->texture.format().internalFormat);
  }
}

PreparedPass preparedPass(GlDevice& device, KernelProgram& program, std::span<RenderTarget* const> planes) {
  const bool isDrawn = program.stage == assemble::Stage::Fragment;
  return {program, isDrawn ? targetOf(device, planes) : DrawTarget{}};
}

void drawRects(GlDevice& device, const DrawTarget& target, std::span<const Rect> rects, gl::IntUniform& row) {
  device.passes().beginDraw();
  for (const Rect& rect : rects) {
    forEachLayer(rect, target.layerRows, [&](const Rect& part, std::int32_t layer, std::int32_t) {
      selectLayer(device.bound(), target, layer, row);
      device.bound().viewport(part.x, part.y, part.width, part.height);
      gl::drawViewport(device.bound());
    });
  }
}

void writeRects(GlDevice& device, const PreparedPass& pass, std::span<RenderTarget* const> planes,
                std::span<const Rect> rects) {
  switch (pass.program.stage) {
    case assemble::Stage::Fragment: drawRects(device, pass.target, rects, pass.program.domainRow); return;
    case assemble::Stage::Compute: dispatchRects(device, pass.program, planes, rects); return;
  }
}

void selectLayer(gl::BoundState& bound, const DrawTarget& target, std::int32_t layer, gl::IntUniform& row) {
  if (target.layerRows == 0) {
    bound.framebuffer(target.framebuffer->name());
    row.set(bound, 0);
    return;
  }
  target.framebuffer->selectLayer(bound, layer);
  row.set(bound, layer * target.layerRows);
}

void bindOperands(GlDevice& device, KernelProgram& program, const program::Kernel& kernel,
                  std::span<const Operand> operands, std::span<const gl::Texture> stacks) {
  if (program.loopNumber > 0) {
    device.passes().loopReports().begin(device.context());
    program.loopNumberUniform.set(device.bound(), program.loopNumber);
  }
  int unit = 0;
  for (KernelProgram::Read& read : program.reads) {
    const Operand& operand = operands[read.parameter];
    const int next = bindOwnPlanes(device, kernel.parameters[read.parameter], operand.planes, unit);
    if (read.sampler != 0) {
      device.bound().sampler(unit, read.sampler);
    }
    unit = next;
    read.uniforms.set(device.bound(), operand.regionLayout);
    read.ratio.set(device.bound(), operand.ratio);
  }
  for (const std::size_t stack : program.stacks) {
    device.bound().texture(unit, stacks[stack].name(), true);
    device.bound().sampler(unit++, 0);
  }
  for (KernelProgram::Table& table : program.tables) {
    device.bound().texture(unit, table.texture, false);
    device.bound().sampler(unit++, 0);
    table.range.set(device.bound(), table.values.data());
  }
  for (KernelProgram::Value& value : program.values) {
    value.uniform.set(device.bound(), operands[value.parameter].value);
  }
  for (KernelProgram::Wide& value : program.wide) {
    value.uniform.set(device.bound(), operands[value.parameter].value);
  }
  for (KernelProgram::Value& step : program.steps) {
    step.uniform.set(device.bound(), operands[step.parameter].step.data());
  }
}

void runKernel(GlDevice& device, const program::Kernel& kernel, std::span<const Operand> operands,
               const RegionLayout& domain, std::span<const Rect> rects,
               std::span<RenderTarget* const> targets, std::span<const gl::Texture> stacks,
               const assemble::Task& task) {
  KernelProgram& program =
      device.programs().selectedFor(kernel, targets).kernelProgram(kernel, operands, domain, task);
  runKernel(device, preparedPass(device, program, targets), kernel, operands, domain, rects, targets, stacks,
            task);
}

void runKernel(GlDevice& device, const PreparedPass& pass, const program::Kernel& kernel,
               std::span<const Operand> operands, const RegionLayout& domain, std::span<const Rect> rects,
               std::span<RenderTarget* const> targets, std::span<const gl::Texture> stacks,
               const assemble::Task& task) {
  KernelProgram& program = pass.program;
  const PassScope traced(device, nameOf(kernel.name, stepOf(task), program), program, operands, rects,
                         texelBytesOf(targets));
  device.bound().program(program.program.name());
  bindOperands(device, program, kernel, operands, stacks);
  program.domain.set(device.bound(), domain);
  for (KernelProgram::Target& target : program.targets)
    target.uniforms.set(device.bound(), operands[target.parameter].regionLayout);
  const Rect elements{0, 0, domain.extent[0], domain.extent[1]};
  const bool runsByElement =
      program.stage == assemble::Stage::Compute && assemble::domainOf(domain) == assemble::Domain::Strided;
  writeRects(device, pass, targets, runsByElement ? std::span(&elements, 1) : rects);
}

namespace {

/// Whether a blit copies a region: source and target are planes with the same elements per texel. A loop repeats no
/// blits: it could not leave them out on the device. Where programs are dispatched, blits are as slow as draws.
bool isBlit(GlDevice& device, const RegionLayout& source, const RegionLayout& target) {
  return !device.bound().isLogged() && !device.programs().areDispatched() && !source.linear &&
         !target.linear && source.packed == target.packed && !source.strided && !target.strided;
}

/// Whether whole texels are copied.
bool areTexelsCopied(const RegionLayout& source, const RegionLayout& target) {
  return source.packed && target.packed && !source.strided;
}

}  // namespace

void prepareCopy(GlDevice& device, const program::Element& element, const RegionLayout& source,
                 const RegionLayout& target, bool byKernel) {
  if (areTexelsCopied(source, target)) {
    prepareCopy(device, assemble::fourOf(element.fields.front().scalar), assemble::texelsOf(source),
                assemble::texelsOf(target), byKernel);
    return;
  }
  if (!byKernel && isBlit(device, source, target)) return;
  for (const program::Field& field : element.fields) {
    const Operand operands[] = {{nullptr, source, {}}, {}};
    const program::Kernel& kernel = copyKernel(field);
    device.programs().selectedFor(kernel, gl::formatOf(field)).kernelProgram(kernel, operands, target);
  }
}

void copyRegion(GlDevice& device, const program::Element& element, std::span<RenderTarget> from,
                const RegionLayout& source, std::span<RenderTarget> to, const RegionLayout& target) {
  if (areTexelsCopied(source, target)) {
    copyRegion(device, assemble::fourOf(element.fields.front().scalar), from, assemble::texelsOf(source), to,
               assemble::texelsOf(target));
    return;
  }
  for (std::size_t plane = 0; plane < from.size(); ++plane) {
    if (isBlit(device, source, target)) {
      const assemble::Rect rect{target.origin[0], target.origin[1], target.extent[0], target.extent[1]};
      const PassScope traced(device, {"copy", {}, "blit"}, rect, to[plane].texture.format().texelBytes());
      blit(device, from[plane], source, to[plane], target);
      continue;
    }
    const Operand operands[] = {{nullptr, source, from.subspan(plane, 1)}, {}};
    RenderTarget* const targets[] = {&to[plane]};
    runKernel(device, copyKernel(element.fields[plane]), operands, target, assemble::drawnTexels(target),
              targets);
  }
}

}  // namespace sk
