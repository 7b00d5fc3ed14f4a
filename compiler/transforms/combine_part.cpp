// SPDX-License-Identifier: MIT
#include "transforms/combine_part.hpp"

#include <string>
#include <utility>

#include "ir/build.hpp"

namespace skc {

using namespace ir;

namespace {

/// The part's member or components of a variable.
ExprPtr access(const Module& module, const Function& function, VarId var, const FoldPart& part) {
  ExprPtr expr = varRef(function, var, part.loc);
  for (std::uint32_t field : part.members) expr = member(module, std::move(expr), field, part.loc);
  if (part.isWhole()) return expr;
  std::string components;
  for (unsigned i = 0; i < part.type.width; ++i) {
    if ((part.components >> i & 1U) != 0) components += "xyzw"[i];
  }
  return swizzle(std::move(expr), components, part.loc);
}

}  // namespace

Stmt combinePart(const Module& module, const Function& function, const FoldPart& part, VarId partial,
                 VarId total) {
  const auto as = [&](Scalar scalar, ExprPtr value) {
    return value->type.isMatrix() ? std::move(value) : convert(scalar, std::move(value), part.loc);
  };
  const auto read = [&](VarId var) {   // operators take arithmetic types only
    return as(arithmeticScalar(part.type.scalar), access(module, function, var, part));
  };
  ExprPtr place = access(module, function, total, part);
  if (const auto* n = std::get_if<Intrinsic>(&part.op)) {
    ExprPtr value = intrinsic(*n, exprs(read(total), read(partial)), part.loc);
    return assign(std::move(place), as(part.type.scalar, std::move(value)), part.loc);
  }
  const BinaryOp op = std::get<BinaryOp>(part.op);
  const bool isLogical = op == BinaryOp::LogicalAnd || op == BinaryOp::LogicalOr;
  if (!isLogical && !part.type.isNarrow() && !part.type.isMatrix()) {
    return assign(std::move(place), op, access(module, function, partial, part), part.loc);
  }
  ExprPtr value = binary(op, read(total), read(partial), part.loc);
  return assign(std::move(place), as(part.type.scalar, std::move(value)), part.loc);
}

}  // namespace skc
