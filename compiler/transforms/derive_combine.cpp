// SPDX-License-Identifier: MIT
#include "transforms/derive_combine.hpp"

#include <bit>
#include <limits>
#include <string>
#include <utility>

#include "ir/build.hpp"
#include "ir/print.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {
namespace {

using namespace ir;

// ---- identities -------------------------------------------------------------------------------

/// The smallest or largest value of a component type.
ExprPtr extreme(Scalar scalar, bool largest) {
  const float infinity = std::numeric_limits<float>::infinity();
  using Int = std::numeric_limits<std::int32_t>;
  if (scalar == Scalar::Int) return literal(largest ? Int::max() : Int::min());
  if (scalar == Scalar::Uint) return literal(largest ? 0xffffffffU : 0U);
  if (scalar == Scalar::Bool) return literal(largest);
  if (scalar == Scalar::Double) return literal(largest ? double{infinity} : -double{infinity});
  return literal(largest ? infinity : -infinity);
}

/// The neutral element of an operator that foldOf lets through and isAssociative holds for.
ExprPtr neutral(FoldOp op, Scalar scalar) {
  if (const auto* intrinsic = std::get_if<Intrinsic>(&op))
    return extreme(scalar, *intrinsic == Intrinsic::Min);
  const Type type = Type::of(scalar);
  const BinaryOp binary = std::get<BinaryOp>(op);
  if (binary == BinaryOp::BitAnd) return literalOf(type, -1);
  if (binary == BinaryOp::Mul || binary == BinaryOp::LogicalAnd) return literalOf(type, 1);
  return literalOf(type, 0);
}

/// The identity of the scalar or vector member at `members`; null where a component is not folded.
ExprPtr leafIdentity(const FoldPattern& pattern, const std::vector<std::uint32_t>& members, Type type) {
  std::vector<ExprPtr> components(type.width);
  for (const FoldPart& part : pattern.parts) {
    if (part.members != members) continue;
    if (part.isWhole()) {
      ExprPtr one = neutral(part.op, type.scalar);
      return type.isScalar() ? std::move(one) : construct(type, exprs(std::move(one)));
    }
    for (unsigned i = 0; i < type.width; ++i) {
      if ((part.components >> i & 1U) != 0) components[i] = neutral(part.op, type.scalar);
    }
  }
  for (const ExprPtr& component : components) {
    if (!component) return nullptr;
  }
  return construct(type, std::move(components));
}

ExprPtr identityOf(const Module& module, const FoldPattern& pattern, std::vector<std::uint32_t> members,
                   Type type) {
  if (type.isArithmetic()) return leafIdentity(pattern, members, type);
  if (type.kind != Type::Kind::Struct) return nullptr;
  std::vector<ExprPtr> fields;
  members.push_back(0);
  for (const StructField& field : module.structs[type.index].fields) {
    fields.push_back(identityOf(module, pattern, members, field.type));
    if (!fields.back()) return nullptr;
    ++members.back();
  }
  return construct(type, std::move(fields));
}

// ---- combining functions ----------------------------------------------------------------------

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

Stmt combinePart(const Module& module, const Function& function, const FoldPart& part) {
  const auto partial = [&] { return access(module, function, 0, part); };
  const auto total = [&] { return access(module, function, 1, part); };
  if (const auto* n = std::get_if<Intrinsic>(&part.op)) {
    return assign(total(), intrinsic(*n, exprs(total(), partial()), part.loc), part.loc);
  }
  const BinaryOp op = std::get<BinaryOp>(part.op);
  if (op == BinaryOp::LogicalAnd || op == BinaryOp::LogicalOr) {
    return assign(total(), binary(op, total(), partial(), part.loc), part.loc);
  }
  return assign(total(), op, partial(), part.loc);
}

FunctionId makeCombine(Module& module, const Kernel& kernel, const FoldPattern& pattern) {
  const Type type = kernel.params[1].type;
  Function function{
      .name = kernel.name + "_combine", .result = {}, .variables = {}, .body = {}, .loc = kernel.loc};
  addVariable(function, kernel.params[0].name, type, VarRole::In, kernel.params[0].loc);
  addVariable(function, kernel.params[1].name, type, VarRole::InOut, kernel.params[1].loc);
  for (const FoldPart& part : pattern.parts) function.body.push_back(combinePart(module, function, part));
  module.functions.push_back(std::move(function));
  return static_cast<FunctionId>(module.functions.size() - 1);
}

// ---- the cases --------------------------------------------------------------------------------

bool isAssociative(FoldOp op) {
  if (std::holds_alternative<Intrinsic>(op)) return true;
  switch (std::get<BinaryOp>(op)) {
    case BinaryOp::Add:
    case BinaryOp::Mul:
    case BinaryOp::BitAnd:
    case BinaryOp::BitOr:
    case BinaryOp::BitXor:
    case BinaryOp::LogicalAnd:
    case BinaryOp::LogicalOr: return true;
    case BinaryOp::Sub:
    case BinaryOp::Div:
    case BinaryOp::Rem:
    case BinaryOp::ShiftLeft:
    case BinaryOp::ShiftRight:
    case BinaryOp::Less:
    case BinaryOp::LessEqual:
    case BinaryOp::Greater:
    case BinaryOp::GreaterEqual:
    case BinaryOp::Equal:
    case BinaryOp::NotEqual: break;
  }
  return false;
}

class State {
 public:
  State(Module& module, Diagnostics& diagnostics) : module_(module), diagnostics_(diagnostics) {}

  void derive(Kernel& kernel) {
    Reduction& reduction = *kernel.reduction;
    KernelParam& accumulator = kernel.params[1];
    const bool given = accumulator.identity != nullptr;
    const bool sameType = kernel.params[0].type == accumulator.type;
    const std::optional<FoldPattern> pattern = recogniseFold(module_.functions[kernel.entry]);
    if (pattern && !reduction.combine && !checkAssociative(*pattern, accumulator)) return;
    if (pattern && !given) accumulator.identity = identityOf(module_, *pattern, {}, accumulator.type);
    if (reduction.combine) {
      reduction.seeded = false;
    } else if (pattern ? pattern->isPlain : sameType) {
      reduction.combine = kernel.entry;
      reduction.seeded = !given;
    } else if (pattern) {
      reduction.combine = makeCombine(module_, kernel, *pattern);
    } else {
      return complain(Diag::ReduceNeedsCombine, kernel);
    }
    if (!reduction.seeded && !accumulator.identity) complain(Diag::ReduceNeedsIdentity, kernel);
  }

 private:
  bool checkAssociative(const FoldPattern& pattern, const KernelParam& accumulator) {
    for (const FoldPart& part : pattern.parts) {
      if (isAssociative(part.op)) continue;
      const BinaryOp op = std::get<BinaryOp>(part.op);
      std::string advice = "fold with '+', '*', '&', '|', '^', min or max";
      if (op == BinaryOp::Sub)
        advice = "write '" + accumulator.name + " += ...' and subtract once, from the result";
      if (op == BinaryOp::Div)
        advice = "write '" + accumulator.name + " *= ...' and divide once, by the result";
      diagnostics_.report(Diag::ReduceNotAssociative, part.loc, {spelling(op), accumulator.name, advice});
      return false;
    }
    return true;
  }

  void complain(Diag diag, const Kernel& kernel) {
    const KernelParam& accumulator = kernel.params[1];
    const std::string type = print(module_, accumulator.type);
    const std::string element = print(module_, kernel.params[0].type);
    if (diag == Diag::ReduceNeedsCombine) {
      diagnostics_.report(diag, kernel.loc, {kernel.name, type, accumulator.name});
    } else {
      diagnostics_.report(diag, accumulator.loc, {kernel.name, element, type, accumulator.name});
    }
  }

  Module& module_;
  Diagnostics& diagnostics_;
};

}  // namespace

void deriveCombine(Module& module, Diagnostics& diagnostics) {
  State state(module, diagnostics);
  for (Kernel& kernel : module.kernels) {
    if (kernel.reduction) state.derive(kernel);
  }
}

}  // namespace skc
