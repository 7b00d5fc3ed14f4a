// SPDX-License-Identifier: MIT
//
// Contraction fuses a product and the sum that it feeds into one multiply-add, which rounds once. A kernel
// may be called with or without contraction, which takes two entries; this file decides for which kernels the
// second entry is worth compiling.
#pragma once

#include "ir/ir.hpp"

namespace skc::native {

/// True if contraction may change what the kernel computes: it has products and sums of real numbers. False
/// for kernels that compute rounding errors or exact sums, where each rounding counts. The module must not
/// have library functions yet.
bool canContract(const ir::Module& module, const ir::Kernel& kernel);

}  // namespace skc::native
