// SPDX-License-Identifier: MIT
//
// How tightly operators bind in C, C++ and GLSL alike: what the printers need to write no more
// brackets than a person would.
#pragma once

#include <cstdint>

#include "ir/ir.hpp"

namespace skc::ir {

enum class Precedence : std::uint8_t {
  Lowest,       ///< arguments, initialisers, conditions
  Conditional,
  LogicalOr,
  LogicalAnd,
  BitOr,
  BitXor,
  BitAnd,
  Equality,
  Relational,
  Shift,
  Additive,
  Multiplicative,
  Unary,
  Primary,      ///< names, calls, members
};

Precedence precedenceOf(BinaryOp op);

/// True if an operand that is itself a binary operation gets brackets although none are needed,
/// because few people know who binds tighter: && in ||, arithmetic in shifts and in bit operations.
bool bracketsForClarity(BinaryOp outer, BinaryOp inner);

}  // namespace skc::ir
