// SPDX-License-Identifier: MIT
//
// Runs a kernel that is too large for one pass, by the compiler's plan. run_kernel.cpp decides where the
// outputs are drawn.
#pragma once

#include <functional>
#include <span>

#include "assemble/region_layout.hpp"
#include "gl_device/memory/layout.hpp"
#include "gl_device/memory/render_target.hpp"
#include "gl_device/program/variant.hpp"
#include "sk/program.hpp"

namespace sk {

class GlDevice;

/// A call with checked arguments, which all passes of the plan share.
struct PlannedCall {
  std::span<const Operand> operands;  ///< one per parameter of the whole kernel
  std::span<const std::span<RenderTarget>> outputs;  ///< likewise: the planes to draw outputs to
  const assemble::RegionLayout& domain;
  const Layout& layout;  ///< of the stream that the domain is a region of
  std::span<const assemble::Rect> rects;
};

/// Runs the passes. No operand may read the planes of an output. Calls begin() before the first pass draws,
/// after everything that may fail; throws sk::Error before that.
void runPlan(GlDevice& device, const program::Plan& plan, const PlannedCall& call,
             const std::function<void()>& begin);

}  // namespace sk
