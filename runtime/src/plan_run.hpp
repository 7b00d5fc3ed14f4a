// SPDX-License-Identifier: MIT
//
// Running a kernel that is too large for one pass, by the plan that the compiler made: which plan a
// device needs, and its passes one after the other. Where the outputs belong is run.cpp's business.
#pragma once

#include <span>

#include "assemble/placement.hpp"
#include "layout.hpp"
#include "sk/device.hpp"
#include "sk/program.hpp"
#include "surface.hpp"
#include "variant.hpp"

namespace sk {

class GlDevice;

/// The plan by which a device runs a kernel; null where one pass will do, or no plan fits.
const program::Plan* planFor(const program::Kernel& kernel, const DeviceLimits& limits);

/// What all passes share: the call, its arguments checked.
struct PlannedCall {
  std::span<const Operand> operands;            ///< one a parameter of the whole kernel
  std::span<const std::span<Surface>> outputs;  ///< likewise: the planes that outputs are drawn to
  const assemble::Placement& domain;
  const Layout& layout;                         ///< of what is drawn to
  std::span<const assemble::Rect> rects;
};

/// No output is drawn to planes that an operand reads. Throws sk::Error where there is no memory for the
/// temporaries or bundles.
void runPlan(GlDevice& device, const program::Plan& plan, const PlannedCall& call);

}  // namespace sk
