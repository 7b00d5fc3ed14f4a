// SPDX-License-Identifier: MIT
#include "ir/precedence.hpp"

namespace skc::ir {

Precedence precedenceOf(BinaryOp op) {
  switch (op) {
    case BinaryOp::Mul:
    case BinaryOp::Div:
    case BinaryOp::Rem: return Precedence::Multiplicative;
    case BinaryOp::Add:
    case BinaryOp::Sub: return Precedence::Additive;
    case BinaryOp::ShiftLeft:
    case BinaryOp::ShiftRight: return Precedence::Shift;
    case BinaryOp::Less:
    case BinaryOp::LessEqual:
    case BinaryOp::Greater:
    case BinaryOp::GreaterEqual: return Precedence::Relational;
    case BinaryOp::Equal:
    case BinaryOp::NotEqual: return Precedence::Equality;
    case BinaryOp::BitAnd: return Precedence::BitAnd;
    case BinaryOp::BitXor: return Precedence::BitXor;
    case BinaryOp::BitOr: return Precedence::BitOr;
    case BinaryOp::LogicalAnd: return Precedence::LogicalAnd;
    case BinaryOp::LogicalOr: break;
  }
  return Precedence::LogicalOr;
}

bool bracketsForClarity(BinaryOp outer, BinaryOp inner) {
  if (outer == inner) return false;
  const Precedence around = precedenceOf(outer);
  const bool isUnfamiliar =
      around == Precedence::Shift || (around >= Precedence::BitOr && around <= Precedence::BitAnd);
  return isUnfamiliar || (outer == BinaryOp::LogicalOr && inner == BinaryOp::LogicalAnd);
}

}  // namespace skc::ir
