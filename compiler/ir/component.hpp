// SPDX-License-Identifier: MIT
//
// One component of a vector as an expression of its own, for transforms that want to inspect `int2(dx, dy +
// 1).y` without handling vectors.
#pragma once

#include <cstdint>

#include "ir/ir.hpp"

namespace skc::ir {

/// The scalar expression for component `number` of `expr`. Looks through constructors, swizzles and
/// componentwise operators, and otherwise swizzles a copy. A scalar is its own component, whatever the
/// number.
ExprPtr componentOf(const Expr& expr, std::uint8_t number);

}  // namespace skc::ir
