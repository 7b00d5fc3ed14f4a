// SPDX-License-Identifier: MIT
//
// For tests: kernels of ints with all kinds of control flow, nested at random, which end for every element.
#pragma once

#include <cstdint>

#include "ir/ir.hpp"

namespace skc {

/// A kernel with a uniform `u`, an input `x`, an output `r` and a variable output, and functions that it calls.
ir::Module randomKernel(std::uint32_t seed);

}  // namespace skc
