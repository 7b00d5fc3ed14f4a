// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/evaluate.hpp"
#include "ir/quantize.hpp"
#include "ir/walk.hpp"
#include "ir/walk_module.hpp"
#include "support/overloaded.hpp"
#include "transforms/synthesized_kernel.hpp"

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

bool holdsFloat(const Module& module, Type type) {
  if (type.kind == Type::Kind::Array) return holdsFloat(module, module.arrays[type.index].element);
  if (type.kind != Type::Kind::Struct) return type.isFloat();
  return std::ranges::any_of(module.structs[type.index].fields,
                             [&](const StructField& field) { return holdsFloat(module, field.type); });
}

/// From constants to those with the same value, computed in halves.
using HalfConstants = std::map<ConstantId, ConstantId>;

/// Rewrites one function of a half variant.
class Rounder {
 public:
  /// `kernel`: the kernel if this is its entry, whose arguments are rounded when read; else null.
  Rounder(Module& module, const Kernel* kernel, HalfConstants& constants)
      : module_(module), kernel_(kernel), constants_(constants) {}

  void run(FunctionId id) {
    walkStmts(module_.functions[id].body, [&](Stmt& stmt) { statement(stmt); });
  }

 private:
  void statement(Stmt& stmt) {
    match(
        stmt.node,
        [&](Declare& n) {
          if (n.init) value(n.init);
        },
        [&](Assign& n) {
          place(*n.place);
          value(n.value);
          if (n.op && n.place->type.isFloat()) {
            n.value = rounded(binary(*n.op, clone(n.place), std::move(n.value), stmt.loc));
            n.op.reset();
          }
        },
        [&](CallStmt& n) {
          const Function& callee = module_.functions[n.callee];
          for (std::size_t i = 0; i < n.args.size(); ++i) {
            callee.variables[i].role == VarRole::InOut ? place(*n.args[i]) : value(n.args[i]);
          }
          if (n.result) place(*n.result);
        },
        [&](If& n) { value(n.cond); },
        [&](Loop& n) {
          if (n.cond) value(n.cond);
        },
        [&](Switch& n) { value(n.value); }, [](Break&) {}, [](Continue&) {},
        [&](Return& n) {
          if (n.value) value(n.value);
        },
        [](Scope&) {}, [&](Push& n) { value(n.value); }, [&](Scatter& n) { value(n.index), value(n.value); });
  }

  /// An lvalue itself is not rounded; its indices are expressions.
  void place(Expr& expr) {
    if (auto* n = std::get_if<Index>(&expr.node)) {
      value(n->index);
      place(*n->base);
    } else if (auto* m = std::get_if<Member>(&expr.node)) {
      place(*m->base);
    } else if (auto* s = std::get_if<Swizzle>(&expr.node)) {
      place(*s->base);
    }
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
    if (!holdsFloat(module_, module_.constants[id].type)) return id;
    if (const auto known = constants_.find(id); known != constants_.end()) return known->second;
    ExprPtr rounded = clone(module_.constants[id].value);
    Rounder(module_, nullptr, constants_).value(rounded);
    rewriteExprs(rounded, [&](ExprPtr& slot) {  // drivers want constants of literals
      const auto bits =
          slot->type.isFloat() ? evaluateInFloat(module_, *slot, Constants::Keep) : std::nullopt;
      if (bits) slot = makeExpr(slot->type, Literal{*bits}, slot->loc);
    });
    const Constant& plain = module_.constants[id];
    Constant half{plain.name + "_half", plain.type, std::move(rounded), plain.loc};
    module_.constants.push_back(std::move(half));
    return constants_[id] = static_cast<ConstantId>(module_.constants.size() - 1);
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
  HalfConstants& constants_;
};

KernelId roundKernel(Module& module, KernelId id, HalfConstants& constants) {
  FunctionCopies copies;
  const FunctionId entry = copyFunction(module, module.kernels[id].entry, copies);
  dropTables(module, copies);
  const Kernel& kernel = module.kernels[id];
  Kernel variant = synthesizedFor(kernel);
  variant.signature = kernel.signature;
  variant.entry = entry;
  for (const KernelParam& param : kernel.params) variant.params.push_back(clone(param));
  if (kernel.reduction) {
    variant.reduction = Reduction{{}, kernel.reduction->operands, kernel.reduction->seeded};
    variant.reduction->commutative = kernel.reduction->commutative;
  }
  for (const auto& [from, to] : copies) Rounder(module, to == entry ? &variant : nullptr, constants).run(to);
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
  HalfConstants constants;
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
