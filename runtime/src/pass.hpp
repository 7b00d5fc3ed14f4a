// SPDX-License-Identifier: MIT
//
// One pass of a kernel over surfaces, with everything checked and chosen before. A scope of the
// device must be open.
#pragma once

#include <span>

#include "assemble/placement.hpp"
#include "gl/array_texture.hpp"
#include "sk/program.hpp"
#include "surface.hpp"
#include "variant.hpp"

namespace sk {

class DeviceState;
struct KernelProgram;

/// Binds the planes of an operand to consecutive texture units from `unit` on; the unit after them.
int bindPlanes(DeviceState& device, std::span<Surface> planes, int unit);

/// The framebuffer that draws to these planes, 1 to gl::maxDrawBuffers.
GLuint framebufferOf(DeviceState& device, std::span<Surface* const> planes);

/// Draws each rectangle with what is bound.
void drawRects(DeviceState& device, std::span<const assemble::Rect> rects);

/// Binds the planes that a kernel's program reads, and sets the uniforms of its parameters; the program is
/// bound. `operands` and `bundles`: as for drawKernel().
void bindOperands(DeviceState& device, KernelProgram& program, const program::Kernel& kernel,
                  std::span<const Operand> operands, std::span<const gl::ArrayTexture> bundles = {});

/// Draws `rects` of `framebuffer` with a kernel. `operands`: one a parameter; those of outputs are not
/// looked at, since `framebuffer` has their planes. No operand is a texture of the framebuffer. `bundles`:
/// the array textures of the plan that the kernel is a pass of. The tree of a list is bound by the caller.
void drawKernel(DeviceState& device, const program::Kernel& kernel, std::span<const Operand> operands,
                const assemble::Placement& domain, std::span<const assemble::Rect> rects, GLuint framebuffer,
                std::span<const gl::ArrayTexture> bundles = {}, const assemble::Task& task = {});

/// Copies one region to another of the same shape, plane by plane, wherever each lies. They are not of
/// the same surface.
void copyRegion(DeviceState& device, const program::Element& element, std::span<Surface> from,
                const assemble::Placement& source, std::span<Surface> to, const assemble::Placement& target);

}  // namespace sk
