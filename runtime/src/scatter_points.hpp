// SPDX-License-Identifier: MIT
//
// Brings the list of a scatter output to where it belongs, in the steps of assemble/point_program.hpp.
#pragma once

#include <span>

#include "assemble/placement.hpp"
#include "sk/program.hpp"
#include "surface.hpp"

namespace sk {

class GlDevice;

/// Draws the entries of a list: its planes are the texels that they belong to, then their values. `placement` and
/// `planes`: of the region that is written.
void scatterPoints(GlDevice& device, const program::Parameter& sink, std::span<Surface> list,
                   const assemble::Placement& listPlacement, const assemble::Placement& placement,
                   std::span<Surface> planes);

}  // namespace sk
