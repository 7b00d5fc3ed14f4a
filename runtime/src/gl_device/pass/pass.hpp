// SPDX-License-Identifier: MIT
//
// One pass of a kernel over render targets, with everything checked and chosen before. A scope of the
// device must be open.
#pragma once

#include <span>

#include "assemble/region_layout.hpp"
#include "gl/framebuffer.hpp"
#include "gl/texture.hpp"
#include "gl/uniform.hpp"
#include "gl_device/memory/render_target.hpp"
#include "gl_device/program/variant.hpp"
#include "sk/program.hpp"

namespace sk {

class GlDevice;
struct KernelProgram;

/// Binds the planes of an operand to consecutive texture units from `unit` on; the unit after them.
int bindPlanes(GlDevice& device, std::span<RenderTarget> planes, int unit);

/// What a pass draws to: planes of one shape.
struct DrawTarget {
  gl::Framebuffer* framebuffer = nullptr;
  std::int32_t layerRows = 0;  ///< 0 where the planes have no layers
};

/// Draws to these planes, 1 to gl::maxDrawBuffers. Good until the next one is asked for. Throws sk::Error where the driver cannot.
DrawTarget targetOf(GlDevice& device, std::span<RenderTarget* const> planes);
DrawTarget targetOf(GlDevice& device, RenderTarget& plane);

/// Binds the framebuffer with a layer of its planes, and tells the program that is bound.
void selectLayer(GlDevice& device, const DrawTarget& target, std::int32_t layer, gl::IntUniform& row);

/// Draws each rectangle of a target with the program that is bound, whose `sk_domain_row` is `row`.
void drawRects(GlDevice& device, const DrawTarget& target, std::span<const assemble::Rect> rects,
               gl::IntUniform& row);

/// A kernel's program and what it draws to. Good until the next one is asked for.
struct PreparedPass {
  KernelProgram& program;
  DrawTarget target;  ///< none of a compute program
};
PreparedPass preparedPass(GlDevice& device, KernelProgram& program, std::span<RenderTarget* const> planes);

/// Writes each rectangle of planes of one shape with a program, which is bound: draws or dispatches it.
void writeRects(GlDevice& device, const PreparedPass& pass, std::span<RenderTarget* const> planes,
                std::span<const assemble::Rect> rects);

/// Binds the planes that a kernel's program reads, and sets the uniforms of its parameters; the program is
/// bound. `operands` and `bundles`: as for runKernel().
void bindOperands(GlDevice& device, KernelProgram& program, const program::Kernel& kernel,
                  std::span<const Operand> operands, std::span<const gl::Texture> bundles = {});

/// Writes `rects` of `targets`, planes of one shape, with a kernel. `operands`: one a parameter; those of outputs are
/// not looked at, since `targets` are their planes. No operand is a texture of the targets. `bundles`:
/// the array textures of the plan that the kernel is a pass of. The tree of a list is bound by the caller.
void runKernel(GlDevice& device, const program::Kernel& kernel, std::span<const Operand> operands,
               const assemble::RegionLayout& domain, std::span<const assemble::Rect> rects,
               std::span<RenderTarget* const> targets, std::span<const gl::Texture> bundles = {},
               const assemble::Task& task = {});
/// The same with what was prepared for it: nothing is left that a driver refuses.
void runKernel(GlDevice& device, const PreparedPass& pass, const program::Kernel& kernel,
               std::span<const Operand> operands, const assemble::RegionLayout& domain,
               std::span<const assemble::Rect> rects, std::span<RenderTarget* const> targets,
               std::span<const gl::Texture> bundles = {}, const assemble::Task& task = {});

/// Makes the programs that copyRegion() takes, without which it throws sk::Error. `byKernel`: also where it takes none.
void prepareCopy(GlDevice& device, const program::Element& element, const assemble::RegionLayout& source,
                 const assemble::RegionLayout& target, bool byKernel = false);

/// Copies one region to another of the same shape, plane by plane, wherever each lies. They are not of
/// the same render target. `element`: what both hold. A target that is packed is of whole texels, as its source then is.
void copyRegion(GlDevice& device, const program::Element& element, std::span<RenderTarget> from,
                const assemble::RegionLayout& source, std::span<RenderTarget> to,
                const assemble::RegionLayout& target);

}  // namespace sk
