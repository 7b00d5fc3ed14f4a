// SPDX-License-Identifier: MIT
//
// Rejects kernels with more parameters or planes than their descriptors and the runtime's keys can number
// (sk/program.hpp, runtime/src/gl_device/program/variant.hpp), and warns of uniforms that exceed some
// devices' space. Kernels that exceed what a device can do in one pass are left to split-kernels.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void checkLimits(const ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
