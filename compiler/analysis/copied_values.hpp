// SPDX-License-Identifier: MIT
//
// Finds the float values of a kernel that are only copied, to its outputs in the end. A driver's compiler cannot change their
// bits, so that they need no barrier:
//
//   float p = a * b;    p needs one: it is added
//   float q = p + c;    q needs none
//   r = float2(q, 0);   neither do the vector and its 0
//
// The proof: each rewriting of + - * / that changes bits joins two operations, one of which uses the value of the other
// ((a * b) * c, a * b + c, (a + b) - a), or knows an operand, which is a literal or a copy of the other operand. An operation whose
// value no other operation uses takes part in none of the first kind; its operands have barriers of their own. Comparisons
// count as operations, because a + b < c may become a < c - b, and so do negation (-(a - b) may become b - a), functions and
// conversions. Copies are assignments, members, components, vectors, structs, `?:`, pushes, and the stores of scatter outputs.
#pragma once

#include <unordered_set>

#include "ir/ir.hpp"

namespace skc::analysis {

/// The expressions of the kernel's entry whose values are only copied. Other functions have none, since their callers may
/// compute with what they return.
using CopiedValues = std::unordered_set<const ir::Expr*>;
CopiedValues copiedValues(const ir::Module& module, const ir::Kernel& kernel);

}  // namespace skc::analysis
