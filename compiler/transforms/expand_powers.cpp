// SPDX-License-Identifier: MIT
#include "ir/build.hpp"
#include "ir/evaluate.hpp"
#include "ir/walk.hpp"
#include "transforms/passes.hpp"

namespace skc {

using namespace ir;

namespace {

/// Whether an exponent is 2, in all of its components.
bool isTwo(const Module& module, const Expr& exponent) {
  if (const auto* splat = std::get_if<Construct>(&exponent.node); splat && splat->args.size() == 1)
    return isTwo(module, *splat->args[0]);
  if (exponent.type == Type::of(Scalar::Double)) {
    const auto* literal = std::get_if<Literal>(&exponent.node);
    const auto two = literalOf(exponent.type, 2);
    const auto& wanted = std::get<Literal>(two->node);
    return literal != nullptr && literal->bits == wanted.bits && literal->high == wanted.high;
  }
  return exponent.type == Type::of(Scalar::Float) &&
         evaluate(module, exponent, Constants::LookThrough) ==
             evaluate(module, *literalOf(exponent.type, 2), Constants::Keep);
}

/// Whether compilers notice, without much work, that two copies of an expression are one value.
bool mayStandTwice(const Expr& expr) {
  constexpr int most = 16;
  int nodes = 0;
  bool calls = false;
  walkExprs(expr, [&](const Expr& inner) {
    ++nodes;
    calls = calls || std::holds_alternative<Call>(inner.node);
  });
  return nodes <= most && !calls;
}

}  // namespace

void expandPowers(Module& module, Diagnostics&) {
  for (Function& function : module.functions) {
    rewriteExprs(function.body, [&](ExprPtr& slot) {
      auto* power = std::get_if<IntrinsicCall>(&slot->node);
      if (power == nullptr || power->intrinsic != Intrinsic::Pow) return;
      ExprPtr& base = power->args[0];
      if (base->type != slot->type || !isTwo(module, *power->args[1]) || !mayStandTwice(*base)) return;
      ExprPtr again = clone(*base);
      slot = binary(BinaryOp::Mul, std::move(again), std::move(base), slot->loc);
    });
  }
}

}  // namespace skc
