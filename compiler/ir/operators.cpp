// SPDX-License-Identifier: MIT
#include "ir/operators.hpp"

#include <cstddef>

namespace skc::ir {
namespace {

/// An intrinsic, or None.
struct Vectors {
  using enum Intrinsic;
  static constexpr std::nullopt_t None = std::nullopt;
};

constexpr OperatorRow operatorRows[] = {
#define SKC_OPERATOR(Name, spelling, precedence, isAssociative, vectors, wide, condition) \
  {spelling,      Precedence::precedence,                                                 \
   isAssociative, Vectors::vectors,                                                       \
   wide,          std::string_view(#condition) != "None"},
#include "ir/operators.def"
#undef SKC_OPERATOR
};

}  // namespace

const OperatorRow& row(BinaryOp op) { return operatorRows[static_cast<std::size_t>(op)]; }

bool isComparison(BinaryOp op) {
  return row(op).precedence == Precedence::Relational || row(op).precedence == Precedence::Equality;
}

bool bracketsForClarity(BinaryOp outer, BinaryOp inner) {
  if (outer == inner) return false;
  const Precedence around = row(outer).precedence;
  const bool isUnfamiliar =
      around == Precedence::Shift || (around >= Precedence::BitOr && around <= Precedence::BitAnd);
  return isUnfamiliar || (outer == BinaryOp::LogicalOr && inner == BinaryOp::LogicalAnd);
}

}  // namespace skc::ir
