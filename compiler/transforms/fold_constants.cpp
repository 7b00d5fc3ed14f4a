// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "ir/build.hpp"
#include "ir/evaluate.hpp"
#include "ir/lvalue.hpp"
#include "ir/walk.hpp"

namespace skc {
namespace {

using namespace ir;

/// True if an integer is known, and small enough for a float to hold it exactly.
bool isExactAsFloat(const Expr& integer) {
  constexpr std::uint32_t largest = 1U << 24;
  const auto* n = std::get_if<Literal>(&integer.node);
  return n != nullptr &&
         (n->bits <= largest || (integer.type.scalar == Scalar::Int && 0 - n->bits <= largest));
}

/// True if evaluating an expression may round a float.
bool roundsFloats(const Expr& expr) {
  bool rounds = false;
  walkExprs(expr, [&](const Expr& inner) {
    const auto* n = std::get_if<Convert>(&inner.node);
    const bool isRounded = n != nullptr && n->operand->type.isInteger() && !isExactAsFloat(*n->operand);
    rounds = rounds || (inner.type.isFloat() && (isRounded || std::holds_alternative<Binary>(inner.node)));
  });
  return rounds;
}

enum class Floats : std::uint8_t { Compute, Leave };

class ConstantFolder {
 public:
  ConstantFolder(const Module& module, Floats floats) : module_(module), floats_(floats) {}

  void expression(ExprPtr& expr) {
    rewriteExprs(expr, [&](ExprPtr& slot) { fold(slot); });
  }
  void block(Block& statements) {
    rewriteExprs(statements, [&](ExprPtr& slot) { fold(slot); });
    decide(statements);
  }

 private:
  void fold(ExprPtr& slot) {
    if (std::holds_alternative<Literal>(slot->node)) return;
    if (const auto bits = known(*slot, Constants::Keep)) {
      slot = makeExpr(slot->type, Literal{*bits}, slot->loc);
      return;
    }
    if (auto* n = std::get_if<Select>(&slot->node); n != nullptr && n->cond->type.isScalar()) {
      if (const auto cond = known(*n->cond, Constants::LookThrough)) {
        replace(slot, *cond != 0 ? n->yes : n->no);
      }
      return;
    }
    if (auto* n = std::get_if<Unary>(&slot->node)) return negate(slot, *n);
    if (auto* n = std::get_if<Binary>(&slot->node)) dropNeutral(slot, *n);
    if (std::holds_alternative<Index>(slot->node)) nameComponent(slot);
  }

  /// Negates a float literal, which may have another value in each precision.
  static void negate(ExprPtr& slot, const Unary& n) {
    const auto* literal = std::get_if<Literal>(&n.operand->node);
    if (n.op != UnaryOp::Negate || literal == nullptr || !slot->type.isFloat()) return;
    slot = makeExpr(slot->type, Literal{literal->bits ^ 0x80000000U, 0, literal->text}, slot->loc);
  }

  /// Rewrites `v[1]` of a vector to `v.y`, which later transforms recognise.
  void nameComponent(ExprPtr& slot) {
    auto& n = std::get<Index>(slot->node);
    const Type vector = n.base->type;
    const auto component = known(*n.index, Constants::LookThrough);
    if (!vector.isVector() || !component || *component >= vector.width) return;
    ExprPtr base = std::move(n.base);
    slot = makeExpr(slot->type, Swizzle{std::move(base), {static_cast<std::uint8_t>(*component)}}, slot->loc);
  }

  /// Reduces `true && x` and `false || x` to x, in either order of operands.
  void dropNeutral(ExprPtr& slot, Binary& n) {
    if ((n.op != BinaryOp::LogicalAnd && n.op != BinaryOp::LogicalOr) || !slot->type.isScalar()) return;
    const std::uint32_t neutral = n.op == BinaryOp::LogicalAnd ? 1 : 0;
    if (known(*n.lhs, Constants::Keep) == neutral) return replace(slot, n.rhs);
    if (known(*n.rhs, Constants::Keep) == neutral) return replace(slot, n.lhs);
  }

  static void replace(ExprPtr& slot, ExprPtr& part) {
    ExprPtr kept = std::move(part);
    slot = std::move(kept);
  }

  /// Replaces statements with a known condition by the branch taken.
  void decide(Block& block) {
    Block result;
    for (Stmt& stmt : block) {
      forEachBlock(stmt, [&](Block& inner) { decide(inner); });
      if (auto* n = std::get_if<If>(&stmt.node)) {
        if (const auto cond = known(*n->cond, Constants::LookThrough)) {
          append(result, std::move(*cond != 0 ? n->then : n->otherwise), stmt.loc);
          continue;
        }
      }
      auto* loop = std::get_if<Loop>(&stmt.node);
      if (loop != nullptr && neverRuns(*loop)) {
        append(result, std::move(loop->init), stmt.loc);
        continue;
      }
      result.push_back(std::move(stmt));
    }
    block = std::move(result);
  }

  bool neverRuns(const Loop& loop) const {
    return loop.kind != LoopKind::DoWhile && loop.cond && known(*loop.cond, Constants::LookThrough) == 0U;
  }

  /// Appends statements, in a scope if they declare anything.
  static void append(Block& block, Block&& inner, Loc loc) {
    const bool declares = std::any_of(inner.begin(), inner.end(), [](const Stmt& stmt) {
      return std::holds_alternative<Declare>(stmt.node);
    });
    if (declares) {
      block.push_back(scope(std::move(inner), loc));
    } else {
      std::move(inner.begin(), inner.end(), std::back_inserter(block));
    }
  }

  std::optional<std::uint32_t> known(const Expr& expr, Constants constants) const {
    if (floats_ == Floats::Leave && roundsFloats(expr)) return std::nullopt;
    return evaluate(module_, expr, constants);
  }

  const Module& module_;
  Floats floats_;
};

bool isInteger(Type type) { return type.isInteger() || type.isBool(); }

/// A literal, a formula of float literals that has another value in each precision, or a vector or an array of those.
bool isLiteral(const Expr& expr) {
  if (std::holds_alternative<Literal>(expr.node)) return true;
  if (expr.type.isFloat() && expr.type.isScalar()) {
    if (const auto* n = std::get_if<Unary>(&expr.node)) return isLiteral(*n->operand);
    if (const auto* n = std::get_if<Binary>(&expr.node)) return isLiteral(*n->lhs) && isLiteral(*n->rhs);
  }
  const auto* n = std::get_if<Construct>(&expr.node);
  return n != nullptr && (expr.type.isVector() || expr.type.kind == Type::Kind::Array) &&
         std::ranges::all_of(n->args, [](const ExprPtr& arg) { return isLiteral(*arg); });
}

/// Substitutes the values of variables that never change, of vectors, and of array elements.
class Propagation {
 public:
  Propagation(const Module& module, Function& function)
      : module_(module),
        function_(function),
        assigned_(assignedVariables(module, function)),
        values_(function.variables.size()) {}

  void run() { block(function_.body); }

 private:
  /// Declarations precede the uses of their variables.
  void block(Block& statements) {
    for (Stmt& stmt : statements) {
      forEachOperand(stmt, [&](ExprPtr& slot) { expression(slot); });
      if (auto* n = std::get_if<Declare>(&stmt.node); n != nullptr && n->init && !assigned_[n->var]) {
        values_[n->var] = known(*n->init);
      }
      forEachBlock(stmt, [&](Block& inner) { block(inner); });
    }
  }

  /// The value of an expression if it is known, or null.
  ExprPtr known(const Expr& expr) const {
    if (isLiteral(expr)) return clone(expr);
    const bool mayBe = isInteger(expr.type) && expr.type.isScalar() && !roundsFloats(expr);
    const auto bits = mayBe ? evaluate(module_, expr, Constants::LookThrough) : std::nullopt;
    return bits ? makeExpr(expr.type, Literal{*bits}, expr.loc) : nullptr;
  }

  void expression(ExprPtr& expr) {
    rewriteExprs(expr, [&](ExprPtr& slot) { propagate(slot); });
  }

  void propagate(ExprPtr& slot) const {
    if (std::holds_alternative<Index>(slot->node)) return element(slot);
    if (!isInteger(slot->type) || isLiteral(*slot)) return;
    if (const auto* n = std::get_if<VarRef>(&slot->node)) {
      if (values_[n->var]) slot = clone(values_[n->var]);
    } else if (const auto* part = std::get_if<Swizzle>(&slot->node);
               part != nullptr && slot->type.isScalar()) {
      slot = componentOf(*part->base, part->components.front());
    } else if (slot->type.isVector()) {
      vector(slot);
    }
  }

  /// Replaces an integer vector whose components are all known.
  void vector(ExprPtr& slot) const {
    std::vector<ExprPtr> components;
    for (std::uint8_t i = 0; i < slot->type.width; ++i) {
      components.push_back(known(*componentOf(*slot, i)));
      if (!components.back()) return;
    }
    slot = construct(slot->type, std::move(components), slot->loc);
  }

  /// Replaces a known element of a constant array; an index outside is clamped.
  void element(ExprPtr& slot) const {
    const auto& n = std::get<Index>(slot->node);
    const auto* value = arrayOf(*n.base);
    const auto number = value == nullptr ? std::nullopt : evaluate(module_, *n.index, Constants::LookThrough);
    if (!number) return;
    const auto last = static_cast<std::int64_t>(value->args.size()) - 1;
    const std::int64_t wanted = n.index->type.scalar == Scalar::Int
                                    ? std::int64_t{static_cast<std::int32_t>(*number)}
                                    : std::int64_t{*number};
    const Expr& found = *value->args[static_cast<std::size_t>(std::clamp<std::int64_t>(wanted, 0, last))];
    if (isLiteral(found)) slot = clone(found);
  }

  /// The elements of a constant array; null for any other expression.
  const Construct* arrayOf(const Expr& expr) const {
    if (expr.type.kind != Type::Kind::Array) return nullptr;
    if (const auto* n = std::get_if<ConstantRef>(&expr.node)) {
      return std::get_if<Construct>(&module_.constants[n->constant].value->node);
    }
    const auto* n = std::get_if<VarRef>(&expr.node);
    return n != nullptr && values_[n->var] ? std::get_if<Construct>(&values_[n->var]->node) : nullptr;
  }

  const Module& module_;
  Function& function_;
  const std::vector<bool> assigned_;
  std::vector<ExprPtr> values_;
};

}  // namespace

void foldConstants(Module& module, Diagnostics&) {
  ConstantFolder state(module, Floats::Compute);
  for (Constant& constant : module.constants) state.expression(constant.value);
  for (Function& function : module.functions) state.block(function.body);
}

void foldIntegers(const Module& module, Function& function) {
  Propagation(module, function).run();
  ConstantFolder(module, Floats::Leave).block(function.body);
}

}  // namespace skc
