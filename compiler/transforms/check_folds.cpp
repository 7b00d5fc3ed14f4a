// SPDX-License-Identifier: MIT
#include "transforms/check_folds.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "ir/build.hpp"
#include "ir/lvalue.hpp"
#include "ir/print.hpp"
#include "ir/walk.hpp"
#include "transforms/fold_pattern.hpp"
#include "transforms/fold_trial.hpp"
#include "transforms/interpreter.hpp"

namespace skc {
namespace {

using namespace ir;

// ---- values that are never negative -------------------------------------------------------------

bool isNonNegative(const Expr& expr);

bool areNonNegative(const std::vector<ExprPtr>& all) {
  return std::ranges::all_of(all, [](const ExprPtr& e) { return isNonNegative(*e); });
}

bool isSameLValue(const Expr& a, const Expr& b) {
  const std::optional<StaticLValue> lvalue = staticLValue(a);
  return lvalue && lvalue == staticLValue(b);
}

bool isNonNegative(const IntrinsicCall& n) {
  switch (n.intrinsic) {
    case Intrinsic::Abs:
    case Intrinsic::Fabs:
    case Intrinsic::Length:
    case Intrinsic::Distance:
    case Intrinsic::Sqrt:
    case Intrinsic::Exp:
    case Intrinsic::Exp2:
    case Intrinsic::Saturate: return true;
    case Intrinsic::Dot: return isSameLValue(*n.args[0], *n.args[1]);
    case Intrinsic::Max:
    case Intrinsic::Fmax: return isNonNegative(*n.args[0]) || isNonNegative(*n.args[1]);
    case Intrinsic::Min:
    case Intrinsic::Fmin: return areNonNegative(n.args);
    default: return false;
  }
}

/// True if the expression alone shows it.
bool isNonNegative(const Expr& expr) {
  if (expr.type.isArithmetic()) {
    const Scalar s = expr.type.scalar;
    if (s == Scalar::Uint || s == Scalar::Ulong || s == Scalar::Uchar || s == Scalar::Ushort ||
        s == Scalar::Unorm8 || s == Scalar::Unorm16 || s == Scalar::Bool) {
      return true;
    }
  }
  if (std::holds_alternative<IndexOf>(expr.node) || std::holds_alternative<ExtentOf>(expr.node)) return true;
  if (const auto* n = std::get_if<Convert>(&expr.node)) return isNonNegative(*n->operand);
  if (const auto* n = std::get_if<Swizzle>(&expr.node)) return isNonNegative(*n->base);
  if (const auto* n = std::get_if<Construct>(&expr.node)) return areNonNegative(n->args);
  if (const auto* n = std::get_if<Select>(&expr.node)) return isNonNegative(*n->yes) && isNonNegative(*n->no);
  if (const auto* n = std::get_if<IntrinsicCall>(&expr.node)) return isNonNegative(*n);
  if (const auto* n = std::get_if<Binary>(&expr.node)) {
    if (n->op == BinaryOp::Mul && isSameLValue(*n->lhs, *n->rhs)) return true;
    const bool keeps = n->op == BinaryOp::Add || n->op == BinaryOp::Mul || n->op == BinaryOp::Div;
    return keeps && isNonNegative(*n->lhs) && isNonNegative(*n->rhs);
  }
  if (const auto* n = std::get_if<Literal>(&expr.node)) return expr.type.isScalar() && n->bits >> 31U == 0;
  return false;
}

/// True if every value that a reduce folds into a target by max is known to be non-negative.
bool foldsNonNegatives(const Module& module, const Kernel& kernel, const FoldTarget& target) {
  bool holds = true;
  walkStmts(module.functions[kernel.entry].body, [&](const Stmt& stmt) {
    const std::optional<FoldTarget> found = foldedBy(kernel, stmt);
    if (!found || !found->isOfMember(target)) return;
    const Expr* value = std::get<Assign>(stmt.node).value.get();
    if (const auto* n = std::get_if<Convert>(&value->node)) value = n->operand.get();
    const auto* max = std::get_if<IntrinsicCall>(&value->node);
    const std::optional<StaticLValue> lvalue = staticLValue(*std::get<Assign>(stmt.node).place);
    if (max == nullptr) return void(holds = false);
    for (const ExprPtr& arg : max->args) {
      const Expr* folded = arg.get();
      if (const auto* n = std::get_if<Convert>(&folded->node)) folded = n->operand.get();
      holds = holds && (staticLValue(*folded) == lvalue || isNonNegative(*folded));
    }
  });
  return holds;
}

// ---- identities of known operators --------------------------------------------------------------

std::string spellingOf(FoldOp op) {
  if (const auto* n = std::get_if<Intrinsic>(&op)) return *n == Intrinsic::Min ? "min" : "max";
  return std::string(spelling(std::get<BinaryOp>(op)));
}

std::string number(double value, Scalar scalar) {
  if (scalar == Scalar::Bool) return value != 0 ? "true" : "false";
  if (std::isinf(value)) return value < 0 ? "-infinity" : "infinity";
  return isReal(arithmeticScalar(scalar)) ? fmt::format("{:.7g}", value) : fmt::format("{:.0f}", value);
}

/// The position of an accumulator's component among its numbers.
std::size_t offsetOf(const Module& module, Type type, const std::vector<std::uint32_t>& members) {
  std::uint64_t offset = 0;
  for (const std::uint32_t member : members) {
    const Struct& entry = module.structs[type.index];
    for (std::uint32_t i = 0; i < member; ++i) offset += scalarCount(module, entry.fields[i].type);
    type = entry.fields[member].type;
  }
  return static_cast<std::size_t>(offset);
}

/// Accepts what people write for infinity: `= 1e30`, `= 3.4e38`, `= 1 << 30`.
bool isAsGoodAs(FoldOp op, double given, double neutral) {
  if (given == neutral) return true;
  if (!std::holds_alternative<Intrinsic>(op) || std::signbit(given) != std::signbit(neutral)) return false;
  return std::fabs(given) >= std::min(std::fabs(neutral), std::isinf(neutral) ? 1e9 : 536870912.0);
}

struct IdentityCheck {
  const Module& module;
  const Kernel& kernel;
  Diagnostics& diagnostics;

  /// Reports the first component of a target whose identity is not the operator's.
  bool check(const FoldTarget& target, const Numbers& identity) const {
    const Scalar scalar = target.type.scalar;
    const std::optional<Numbers> neutral = interpretConstant(module, *neutralOf(target.op, scalar));
    if (!neutral) return true;
    const KernelParam& param = kernel.params[target.accumulator];
    const std::size_t from = offsetOf(module, param.type, target.members);
    const std::size_t count =
        target.type.isMatrix() ? target.type.width * target.type.width : target.type.width;
    for (std::size_t i = 0; i < count; ++i) {
      const bool isFolded = target.type.isMatrix() || (target.components >> i & 1U) != 0;
      const double given = identity.at(from + i);
      if (!isFolded || isAsGoodAs(target.op, given, neutral->at(0))) continue;
      const bool isMax = target.op == FoldOp(Intrinsic::Max);
      if (isMax && given == 0 && foldsNonNegatives(module, kernel, target)) continue;
      return report(target, param, number(given, scalar), number(neutral->at(0), scalar));
    }
    return true;
  }

  bool report(const FoldTarget& target, const KernelParam& param, const std::string& given,
              const std::string& neutral) const {
    const Diag diag = isIdempotent(target.op) ? Diag::ReduceBound : Diag::ReduceIdentity;
    diagnostics.report(diag, param.loc, {param.name, given, spellingOf(target.op), neutral});
    return diag != Diag::ReduceIdentity;
  }
};

}  // namespace

bool checkIdentities(const Module& module, const Kernel& kernel, Diagnostics& diagnostics) {
  bool areIdentities = true;
  for (const FoldTarget& target : kernel.reduction->pattern->targets) {
    const ExprPtr& identity = kernel.params[target.accumulator].identity;
    const std::optional<Numbers> given = identity ? interpretConstant(module, *identity) : std::nullopt;
    if (given && !IdentityCheck{module, kernel, diagnostics}.check(target, *given)) areIdentities = false;
  }
  return areIdentities;
}

bool checkOwnCombination(const Module& module, KernelId id, bool combinesOthers, Diagnostics& diagnostics) {
  const Kernel& kernel = module.kernels[id];
  if (!combinesOthers) {
    const FoldTrial order = tryAssociativity(module, id);
    // no elements make sense of `t += x; t += x;`
    const bool isStrict = foldsElementTwice(kernel, module.functions[kernel.entry]);
    if (order.fails || (isStrict && order.failsOnce)) {
      diagnostics.report(Diag::ReduceOrder, kernel.loc, {kernel.name, order.example});
      return false;
    }
    if (order.mayFail)
      diagnostics.report(Diag::ReduceOrderDoubtful, kernel.loc, {kernel.name, order.example});
  }
  const auto accumulator = std::ranges::find(kernel.params, ParamRole::Accumulator, &KernelParam::role);
  const bool isGiven =
      std::ranges::any_of(kernel.params, [](const KernelParam& param) { return !!param.identity; });
  if (!isGiven) {
    if (!computesWithOthers(module, id)) return true;
    diagnostics.report(
        Diag::ReduceBothReadings, accumulator->loc,
        {kernel.name, print(module, accumulator->type), accumulator->name, accumulatorWordOf(kernel)});
    return false;
  }
  const IdentityTrial start = tryIdentity(module, id);
  if (!start.fails || (combinesOthers && !start.isIdempotent)) return true;
  diagnostics.report(start.isIdempotent ? Diag::ReduceStartBound : Diag::ReduceStart, accumulator->loc,
                     {kernel.name, start.example});
  return start.isIdempotent;
}

bool checkCombination(const Module& module, KernelId id, Diagnostics& diagnostics) {
  const Kernel& kernel = module.kernels[id];
  const FoldTrial order = tryCombination(module, id);
  const std::string advice =
      module.kernels[*kernel.reduction->combine].isSynthesized
          ? "fold by one operator"
          : "the overload that folds accumulators has to join results as the fold would";
  if (order.fails) {
    diagnostics.report(Diag::ReduceCombination, kernel.loc, {kernel.name, order.example, advice});
    return order.runs;
  }
  if (order.mayFail)
    diagnostics.report(Diag::ReduceCombinationDoubtful, kernel.loc, {kernel.name, order.example});
  if (kernel.reduction->seeded) return order.runs;
  const FoldTrial start = tryStart(module, id);
  const auto accumulator = std::ranges::find(kernel.params, ParamRole::Accumulator, &KernelParam::role);
  if (start.fails) diagnostics.report(Diag::ReduceStart, accumulator->loc, {kernel.name, start.example});
  return order.runs;
}

}  // namespace skc
