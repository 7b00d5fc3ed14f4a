// SPDX-License-Identifier: MIT
#include "glsl/legalize.hpp"

#include <algorithm>
#include <utility>

#include "glsl/known_values.hpp"
#include "ir/build.hpp"
#include "ir/walk.hpp"

namespace skc::emit {
namespace {

using namespace ir;

class Legalizer {
 public:
  Legalizer(const Module& module, const Capabilities& target) : module_(module), target_(target) {}

  void block(Block& statements) const {
    walkStmts(statements, [&](Stmt& stmt) {
      if (auto* n = std::get_if<Assign>(&stmt.node)) expandShift(*n);
      forEachOperand(stmt, [&](ExprPtr& operand) { value(operand); });
      if (auto* n = std::get_if<Assign>(&stmt.node)) lvalue(*n->place);
      if (auto* n = std::get_if<CallStmt>(&stmt.node); n != nullptr && n->result) lvalue(*n->result);
    });
  }

  void value(ExprPtr& slot) const {
    rewriteExprs(slot, [&](ExprPtr& expr) {
      if (auto* n = std::get_if<Binary>(&expr->node); n != nullptr && mayShift(n->op, *n->rhs)) mask(n->rhs);
      if (auto* n = std::get_if<Index>(&expr->node); n != nullptr && !choosesComponent(*n)) clamp(*n);
    });
  }

 private:
  bool mayShift(BinaryOp op, const Expr& count) const {
    return !target_.shiftsByAnyCount && mayShiftTooFar(module_, op, count);
  }

  /// The count modulo 32.
  static void mask(ExprPtr& count) {
    const Loc loc = count->loc;
    const bool isUint = arithmeticScalar(count->type.scalar) == Scalar::Uint;
    count = binary(BinaryOp::BitAnd, std::move(count),
                   isUint ? literal(31u, loc) : literal(std::int32_t{31}, loc), loc);
  }

  /// `x <<= n` becomes `x = x << n`, whose count is a part of an expression.
  void expandShift(Assign& n) const {
    if (!n.op || !mayShift(*n.op, *n.value)) return;
    n.value = binary(*n.op, clone(*n.place), std::move(n.value), n.place->loc);
    n.op.reset();
  }

  /// True for a component of a vector at a computed index, which a function of any index chooses.
  static bool choosesComponent(const Index& n) {
    return n.base->type.isVector() && !n.base->type.isDouble() &&
           !std::holds_alternative<Literal>(n.index->node);
  }

  /// The component of a vector that is assigned to: no function chooses that.
  void lvalue(Expr& place) const {
    if (auto* n = std::get_if<Index>(&place.node); n != nullptr && choosesComponent(*n)) clamp(*n);
  }

  void clamp(Index& n) const {
    if (target_.clampsIndices) return;
    const Type base = n.base->type;
    const bool isArray = base.kind == Type::Kind::Array;
    const std::uint32_t last = (isArray ? module_.arrays[base.index].length : base.width) - 1;
    const bool isUint = n.index->type.scalar == Scalar::Uint;
    const Loc loc = n.index->loc;
    if (auto* known = std::get_if<Literal>(&n.index->node)) {  // one outside is an error in GLSL
      const bool isBelow = !isUint && static_cast<std::int32_t>(known->bits) < 0;
      known->bits = isBelow ? 0 : std::min(known->bits, last);
    } else if (isUint) {
      n.index = intrinsic(Intrinsic::Min, exprs(std::move(n.index), literal(last, loc)), loc);
    } else {
      n.index = intrinsic(Intrinsic::Clamp,
                          exprs(std::move(n.index), literal(std::int32_t{0}, loc),
                                literal(static_cast<std::int32_t>(last), loc)),
                          loc);
    }
  }

  const Module& module_;
  const Capabilities& target_;
};

}  // namespace

void legalize(Module& module, const Capabilities& target) {
  const Legalizer legalizer(module, target);
  for (Constant& constant : module.constants) legalizer.value(constant.value);
  for (Function& function : module.functions) legalizer.block(function.body);
  for (Kernel& kernel : module.kernels) {
    for (KernelParam& param : kernel.params) {
      if (param.border) legalizer.value(param.border);
      if (param.identity) legalizer.value(param.identity);
    }
  }
}

void legalize(const Module& module, const Capabilities& target, ExprPtr& expr) {
  Legalizer(module, target).value(expr);
}

}  // namespace skc::emit
