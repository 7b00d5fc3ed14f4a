// SPDX-License-Identifier: MIT
//
// Fewer and longer rows for native loops: dimensions that lie one behind the other in all streams of a call become one, where the
// kernel does not ask where it is. It changes how elements are counted, never their order.
#pragma once

#include <span>

#include "native/call.hpp"
#include "sk/program.hpp"

namespace sk {

/// `domain`, and `block` of a reduction (of a kernel, all of the domain), and the operands of its parameters, which match.
void coalesce(const program::Kernel& kernel, std::span<native::Operand> operands, native::Extents& domain,
              native::Extents& block);

}  // namespace sk
