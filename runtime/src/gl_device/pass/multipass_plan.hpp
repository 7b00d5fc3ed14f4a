// SPDX-License-Identifier: MIT
//
// Runs a kernel that is too large for one pass, by the plan that the compiler has made. Where the outputs belong is
// run_kernel.cpp's business.
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

/// What all passes share: the call, its arguments checked.
struct PlannedCall {
  std::span<const Operand> operands;  ///< one a parameter of the whole kernel
  std::span<const std::span<RenderTarget>> outputs;  ///< likewise: the planes that outputs are drawn to
  const assemble::RegionLayout& domain;
  const Layout& layout;  ///< of what is drawn to
  std::span<const assemble::Rect> rects;
};

/// No output is drawn to planes that an operand reads. `begin` is called before the first pass, when everything is there that a driver
/// may refuse; without it this throws sk::Error.
void runPlan(GlDevice& device, const program::Plan& plan, const PlannedCall& call,
             const std::function<void()>& begin);

}  // namespace sk
