// SPDX-License-Identifier: MIT
//
// The runtime's own kernels: those that copy one plane of a stream, for regions that no blit can copy
// because they lie differently.
#pragma once

#include "sk/program.hpp"

namespace sk {

/// `from`, an element input, to `to`, an output; both are the one field, without its path.
const program::Kernel& copyKernel(const program::Field& field);

}  // namespace sk
