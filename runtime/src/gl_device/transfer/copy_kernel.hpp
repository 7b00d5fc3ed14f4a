// SPDX-License-Identifier: MIT
//
// The runtime's own kernels, which copy one plane of a region. They are used if no blit can do it, because
// the layouts of source and target differ.
#pragma once

#include "sk/program.hpp"

namespace sk {

/// The kernel that copies `from`, an element input, to `to`, an output. Both hold the field's texels.
const program::Kernel& copyKernel(const program::Field& field);

}  // namespace sk
