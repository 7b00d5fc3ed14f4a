// SPDX-License-Identifier: MIT
//
// The table of binary operators (operators.def) as rows. Precedence is the same in C, C++ and GLSL; the printers
// use it to write no more brackets than a person would.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "ir/intrinsics.hpp"
#include "ir/ir.hpp"

namespace skc::ir {

enum class Precedence : std::uint8_t {
  Lowest,  ///< arguments, initialisers, conditions
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
  Primary,  ///< names, calls, members
};

struct OperatorRow {
  std::string_view spelling;
  Precedence precedence;
  bool isAssociative;
  std::optional<Intrinsic> vectors;
  std::string_view wide;
  bool isInConditions;
};
const OperatorRow& row(BinaryOp op);

/// True for < <= > >= == !=.
bool isComparison(BinaryOp op);

/// True if a binary operand gets brackets that are not needed, because few readers know the precedence: && in
/// ||, arithmetic in shifts and in bit operations.
bool bracketsForClarity(BinaryOp outer, BinaryOp inner);

}  // namespace skc::ir
