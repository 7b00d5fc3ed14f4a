// SPDX-License-Identifier: MIT
//
// Operator precedence, which is the same in C, C++ and GLSL. The printers use it to write no more brackets
// than a person would.
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

/// True if a binary operand gets brackets that are not needed, because few readers know the precedence: && in
/// ||, arithmetic in shifts and in bit operations.
bool bracketsForClarity(BinaryOp outer, BinaryOp inner);

}  // namespace skc::ir
