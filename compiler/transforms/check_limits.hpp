// SPDX-License-Identifier: MIT
//
// Refuses kernels with more parameters and planes than their descriptors and the runtime's keys can number
// (sk/program.hpp, runtime/src/gl_device/program/variant.hpp), and warns of uniforms that some device has no room for. Kernels that exceed what a device can do in a pass are
// split-kernels' business.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void checkLimits(const ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
