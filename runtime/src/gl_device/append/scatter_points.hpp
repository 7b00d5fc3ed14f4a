// SPDX-License-Identifier: MIT
//
// Brings the list of a scatter output to where it belongs, in the steps of assemble/append/point_program.hpp.
#pragma once

#include <span>

#include "assemble/region_layout.hpp"
#include "gl_device/memory/render_target.hpp"
#include "sk/program.hpp"

namespace sk {

class GlDevice;

/// Draws the entries of a list: its planes are the texels that they belong to, then their values. `region layout` and
/// `planes`: of the region that is written.
void scatterPoints(GlDevice& device, const program::Parameter& appendOutput, std::span<RenderTarget> list,
                   const assemble::RegionLayout& listLayout, const assemble::RegionLayout& regionLayout,
                   std::span<RenderTarget> planes);

}  // namespace sk
