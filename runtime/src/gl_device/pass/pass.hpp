// SPDX-License-Identifier: MIT
//
// Runs one pass of a kernel over render targets. The caller has checked the arguments and chosen the layouts.
// A DeviceScope must be open.
#pragma once

#include <span>

#include "assemble/region_layout.hpp"
#include "gl/texture.hpp"
#include "gl/program.hpp"
#include "gl_device/memory/render_target.hpp"
#include "gl_device/program/variant.hpp"
#include "sk/program.hpp"

namespace sk {

class GlDevice;
struct KernelProgram;

/// Binds the planes of an operand to consecutive texture units from `unit` on. Returns the next unit.
int bindPlanes(GlDevice& device, std::span<RenderTarget> planes, int unit);

/// What a pass draws to: one or more planes of the same shape.
struct DrawTarget {
  gl::Framebuffer* framebuffer = nullptr;
  std::int32_t layerRows = 0;  ///< rows per layer; 0 if the planes have no layers
};

/// The target that draws to these planes, 1 to gl::maxDrawBuffers. Valid until the next call. Throws
/// sk::Error if the driver cannot draw to them together.
DrawTarget targetOf(GlDevice& device, std::span<RenderTarget* const> planes);
DrawTarget targetOf(gl::BoundState& bound, RenderTarget& plane);

/// Binds the framebuffer with a layer of its planes attached, and sets `row`, a uniform of the bound program,
/// to the layer's first row.
void selectLayer(gl::BoundState& bound, const DrawTarget& target, std::int32_t layer, gl::IntUniform& row);

/// Draws each rectangle of a target with the bound program, whose uniform `sk_domain_row` is `row`.
void drawRects(GlDevice& device, const DrawTarget& target, std::span<const assemble::Rect> rects,
               gl::IntUniform& row);

/// A kernel's program and what it draws to. Valid until the next pass is prepared.
struct PreparedPass {
  KernelProgram& program;
  DrawTarget target;  ///< empty for a compute program
};
PreparedPass preparedPass(GlDevice& device, KernelProgram& program, std::span<RenderTarget* const> planes);

/// Binds the planes that a dispatch writes.
void bindImages(gl::BoundState& bound, std::span<RenderTarget* const> planes);

/// Draws or dispatches the pass's program, which must be bound, for each rectangle of planes of the same
/// shape.
void writeRects(GlDevice& device, const PreparedPass& pass, std::span<RenderTarget* const> planes,
                std::span<const assemble::Rect> rects);

/// Binds the planes that a kernel's program reads, and sets the uniforms of its parameters. The program must
/// be bound. `operands` and `stacks` are those of runKernel().
void bindOperands(GlDevice& device, KernelProgram& program, const program::Kernel& kernel,
                  std::span<const Operand> operands, std::span<const gl::Texture> stacks = {});

/// Runs a kernel on the rectangles `rects` of `targets`, which are planes of the same shape. There is one
/// operand per parameter; the planes of output operands are ignored in favour of `targets`. No operand may
/// read a target. `stacks` are the array textures of the plan that the kernel is a pass of. For Work::List,
/// the caller binds the pyramid. Throws sk::Error if the driver rejects the program or the targets.
void runKernel(GlDevice& device, const program::Kernel& kernel, std::span<const Operand> operands,
               const assemble::RegionLayout& domain, std::span<const assemble::Rect> rects,
               std::span<RenderTarget* const> targets, std::span<const gl::Texture> stacks = {},
               const assemble::Task& task = {});
/// Like the other runKernel(), for a prepared pass: the driver has accepted its program and its targets.
void runKernel(GlDevice& device, const PreparedPass& pass, const program::Kernel& kernel,
               std::span<const Operand> operands, const assemble::RegionLayout& domain,
               std::span<const assemble::Rect> rects, std::span<RenderTarget* const> targets,
               std::span<const gl::Texture> stacks = {}, const assemble::Task& task = {});

/// Compiles the programs that copyRegion() needs, so that it cannot fail later. `byKernel`: compiles them
/// even if a blit is enough. Throws sk::Error if the driver rejects one.
void prepareCopy(GlDevice& device, const program::Element& element, const assemble::RegionLayout& source,
                 const assemble::RegionLayout& target, bool byKernel = false);

/// Copies one region to another of the same shape, plane by plane; their layouts may differ. They must not
/// share a render target. Both hold elements of type `element`. A packed target consists of whole texels; if
/// the source is packed as well, so does the source, unless it is strided.
void copyRegion(GlDevice& device, const program::Element& element, std::span<RenderTarget> from,
                const assemble::RegionLayout& source, std::span<RenderTarget> to,
                const assemble::RegionLayout& target);

}  // namespace sk
