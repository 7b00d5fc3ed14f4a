// SPDX-License-Identifier: MIT
//
// One component of a vector as an expression of its own: for transforms that want to know `int2(dx, dy + 1).y` without
// knowing vectors.
#pragma once

#include <cstdint>

#include "ir/ir.hpp"

namespace skc::ir {

/// The scalar that component `number` of `expr` holds, taken out of constructors, swizzles and operators that work by
/// component; a swizzle of a copy where it is none of these. A scalar is its own component, whatever the number.
ExprPtr componentOf(const Expr& expr, std::uint8_t number);

}  // namespace skc::ir
