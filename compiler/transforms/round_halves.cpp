// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <bit>
#include <optional>
#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/evaluate.hpp"
#include "ir/scalar_operations.hpp"
#include "ir/walk.hpp"
#include "support/overloaded.hpp"
#include "transforms/fold_copy.hpp"

namespace skc {
namespace {

using namespace ir;

ExprPtr rounded(ExprPtr value) {
  const Loc loc = value->loc;
  if (const auto* n = std::get_if<Literal>(&value->node)) {
    return literal(std::bit_cast<float>(quantize(Scalar::Half, *n)), loc);
  }
  return convert(Scalar::Float, convert(Scalar::Half, std::move(value), loc), loc);
}

/// The expression at the root of an lvalue or of a read's parts.
const Expr& rootOfRead(const Expr& expr) {
  if (const auto* n = std::get_if<Member>(&expr.node)) return rootOfRead(*n->base);
  if (const auto* n = std::get_if<Index>(&expr.node)) return rootOfRead(*n->base);
  if (const auto* n = std::get_if<Swizzle>(&expr.node)) return rootOfRead(*n->base);
  return expr;
}

bool isReadOfStream(const Expr& expr) {
  return std::holds_alternative<GatherRead>(expr.node) || std::holds_alternative<NeighborRead>(expr.node) ||
         std::holds_alternative<Sample>(expr.node);
}

/// Rewrites one function of a half variant.
class Rounder {
 public:
  /// `kernel`: the kernel if this is its entry, whose arguments are rounded when read; else null.
  Rounder(Module& module, const Kernel* kernel, ConstantCopies& constants)
      : module_(module), kernel_(kernel), constants_(constants) {}

  void run(FunctionId id) {
    walkStmts(module_.functions[id].body, [&](Stmt& stmt) { statement(stmt); });
  }

 private:
  void statement(Stmt& stmt) {
    forEachOperand(stmt, [&](ExprPtr& slot) { isPlace(stmt, slot) ? place(*slot) : value(slot); });
    auto* n = std::get_if<Assign>(&stmt.node);
    if (n == nullptr || !n->op || !n->place->type.isFloat()) return;
    n->value = rounded(binary(*n->op, clone(n->place), std::move(n->value), stmt.loc));
    n->op.reset();
  }

  /// True if an operand of the statement is an lvalue that it writes.
  bool isPlace(const Stmt& stmt, const ExprPtr& operand) const {
    if (const auto* n = std::get_if<Assign>(&stmt.node)) return &operand == &n->place;
    const auto* n = std::get_if<CallStmt>(&stmt.node);
    if (n == nullptr || &operand == &n->result) return n != nullptr;
    const Function& callee = module_.functions[n->callee];
    return callee.variables[&operand - n->args.data()].role == VarRole::InOut;
  }

  /// An lvalue itself is not rounded; its indices are expressions.
  void place(Expr& expr) {
    const auto* index = std::get_if<Index>(&expr.node);
    forEachOperand(expr, [&](ExprPtr& operand) {
      index != nullptr && &operand == &index->index ? value(operand) : place(*operand);
    });
  }

  void value(ExprPtr& slot) {
    Expr& expr = *slot;
    if (auto* n = std::get_if<ConstantRef>(&expr.node)) {
      n->constant = halfOf(n->constant);
      return;
    }
    const bool isPart = &rootOfRead(expr) != &expr;
    if (isPart) {
      partOf(expr);
    } else {
      forEachOperand(expr, [&](ExprPtr& operand) { value(operand); });
    }
    if (expr.type.isFloat() && isRounded(expr)) slot = rounded(std::move(slot));
  }

  ConstantId halfOf(ConstantId id) {
    return copyConstant(module_, id, constants_, "_half", [&](Constant& half) {
      Rounder(module_, nullptr, constants_).value(half.value);
      rewriteExprs(half.value, [&](ExprPtr& slot) {  // drivers want constants of literals
        const auto bits =
            slot->type.isFloat() ? evaluateInFloat(module_, *slot, Constants::Keep) : std::nullopt;
        if (bits) slot = makeExpr(slot->type, Literal{*bits}, slot->loc);
      });
    });
  }

  /// Rounds the part taken of a read, not the read itself, which may be a struct; indices are expressions.
  void partOf(Expr& expr) {
    forEachOperand(expr, [&](ExprPtr& operand) {
      const bool isBase =
          !std::holds_alternative<Index>(expr.node) || operand.get() == std::get<Index>(expr.node).base.get();
      if (!isBase || !isUnrounded(*operand)) return value(operand);
      if (&rootOfRead(*operand) != operand.get()) return partOf(*operand);
      forEachOperand(*operand, [&](ExprPtr& inner) { value(inner); });
    });
  }

  /// True if an expression's value comes from outside the half variant.
  bool isUnrounded(const Expr& expr) const {
    const Expr& root = rootOfRead(expr);
    if (const auto* n = std::get_if<VarRef>(&root.node)) return isArgument(n->var);
    return isReadOfStream(root);
  }

  bool isArgument(VarId var) const {
    if (kernel_ == nullptr || var >= kernel_->params.size()) return false;
    const ParamRole role = kernel_->params[var].role;
    return role != ParamRole::Output;
  }

  bool isRounded(const Expr& expr) const {
    if (&rootOfRead(expr) != &expr) return isUnrounded(expr);
    return match(
        expr.node, [](const Literal&) { return true; }, [&](const VarRef& n) { return isArgument(n.var); },
        [](const ConstantRef&) { return false; }, [](const Unary&) { return false; },
        [](const Binary&) { return true; }, [](const Select&) { return false; },
        [](const Convert& n) { return n.operand->type.scalar != Scalar::Half; },
        [](const Construct&) { return false; }, [](const Swizzle&) { return false; },
        [](const Member&) { return false; }, [](const Index&) { return false; },
        [](const Call&) { return false; }, [](const IntrinsicCall&) { return true; },
        [](const GatherRead&) { return true; }, [](const NeighborRead&) { return true; },
        [](const Sample&) { return true; }, [](const IndexOf&) { return false; },
        [](const ExtentOf&) { return false; });
  }

  Module& module_;
  const Kernel* kernel_;
  ConstantCopies& constants_;
};

KernelId roundKernel(Module& module, KernelId id, ConstantCopies& constants) {
  FunctionCopies copies;
  Kernel variant = variantOf(module, id, copies);
  dropTables(module, copies);
  if (variant.reduction) variant.reduction->commutative = module.kernels[id].reduction->commutative;
  for (const auto& [from, to] : copies)
    Rounder(module, to == variant.entry ? &variant : nullptr, constants).run(to);
  module.kernels.push_back(std::move(variant));
  return static_cast<KernelId>(module.kernels.size() - 1);
}

bool computesFloats(const Module& module, const Kernel& kernel) {
  for (const FunctionId id : functionsOf(module, kernel)) {
    bool found = false;
    walkExprs(module.functions[id].body, [&](const Expr& expr) { found = found || expr.type.isFloat(); });
    if (found) return true;
  }
  return false;
}

}  // namespace

void roundHalves(Module& module, Diagnostics&) {
  ConstantCopies constants;
  forEachDeclaredKernel(module, [&](KernelId id) {
    const bool readsOutputs = module.kernels[id].isPart && module.kernels[id].reduction;
    if (module.kernels[id].isSynthesized || readsOutputs || !computesFloats(module, module.kernels[id]))
      return;
    const std::optional<KernelId> combine =
        module.kernels[id].reduction ? module.kernels[id].reduction->combine : std::nullopt;
    const KernelId half = roundKernel(module, id, constants);
    module.kernels[id].variants.half = half;
    if (!combine) return;
    const KernelId halfCombine = *combine == id ? half : roundKernel(module, *combine, constants);
    module.kernels[half].reduction->combine = halfCombine;
    module.kernels[halfCombine].reduction->combine = halfCombine;
  });
}

}  // namespace skc
