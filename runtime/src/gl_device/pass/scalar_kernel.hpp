// SPDX-License-Identifier: MIT
//
// Kernels for operations with scalars: written when a sequence of operations is first carried out, and kept as long as
// the process, since programs are identified by their kernels' addresses.
#pragma once

#include "device/scalar_pass.hpp"
#include "sk/program.hpp"

namespace sk {

/// The kernel for the steps of a pass. Its parameters are a Uniform for each read and number, then an Output for each
/// output, in order.
const program::Kernel& scalarKernel(const ScalarPass& pass);

}  // namespace sk
