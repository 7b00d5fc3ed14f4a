// SPDX-License-Identifier: MIT
//
// For tests: random kernels of ints with all kinds of nested control flow, which end for every element. The
// kernel for a seed depends on the C++ compiler, which chooses the order of evaluation of arguments.
#pragma once

#include <cstdint>

#include "ir/ir.hpp"

namespace skc {

/// A kernel of a uniform `u`, an input `x`, an output `r` and a variable output, and the functions it calls.
ir::Module randomKernel(std::uint32_t seed);

}  // namespace skc
