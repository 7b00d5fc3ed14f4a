// SPDX-License-Identifier: MIT
//
// Brings the list of a scatter output to where it belongs, in the steps of assemble/point_program.hpp.
#pragma once

#include <cstdint>
#include <span>

#include "assemble/placement.hpp"
#include "sk/program.hpp"
#include "surface.hpp"

namespace sk {

class DeviceState;

/// Draws `length` entries: the planes of `list` are the texels that they belong to, then their values,
/// linearised by `listShift`. `placement` and `planes`: of the region that is written.
void scatterPoints(DeviceState& device, const program::Parameter& sink, std::span<Surface> list,
                   std::int32_t listShift, std::int32_t length, const assemble::Placement& placement,
                   std::span<Surface> planes);

}  // namespace sk
