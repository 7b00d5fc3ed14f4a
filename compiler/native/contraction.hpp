// SPDX-License-Identifier: MIT
//
// Contraction: a product and the sum that it feeds become one fused multiply-add, which rounds once. A kernel may be called
// with and without, so that it gets two entries; this says for which kernels the second is worth compiling.
#pragma once

#include "ir/ir.hpp"

namespace skc::native {

/// Whether contraction may change what the kernel computes: it has products of reals and sums of reals. False for kernels
/// that compute what sums lose or sum exactly, where each rounding counts. The module must not have library functions yet.
bool canContract(const ir::Module& module, const ir::Kernel& kernel);

}  // namespace skc::native
