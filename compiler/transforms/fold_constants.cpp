// SPDX-License-Identifier: MIT
#include "transforms/fold_constants.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "ir/build.hpp"
#include "ir/evaluate.hpp"
#include "ir/walk.hpp"

namespace skc {
namespace {

using namespace ir;

class State {
 public:
  explicit State(Module& module) : module_(module) {}

  void run() {
    for (Constant& constant : module_.constants) {
      rewriteExprs(constant.value, [&](ExprPtr& slot) { fold(slot); });
    }
    for (Function& function : module_.functions) {
      rewriteExprs(function.body, [&](ExprPtr& slot) { fold(slot); });
      decide(function.body);
    }
  }

 private:
  void fold(ExprPtr& slot) {
    if (std::holds_alternative<Literal>(slot->node)) return;
    if (const auto bits = evaluate(module_, *slot, Constants::Keep)) {
      slot = makeExpr(slot->type, Literal{*bits}, slot->loc);
      return;
    }
    if (auto* n = std::get_if<Select>(&slot->node); n != nullptr && n->cond->type.isScalar()) {
      if (const auto cond = evaluate(module_, *n->cond, Constants::LookThrough)) {
        replace(slot, *cond != 0 ? n->yes : n->no);
      }
      return;
    }
    if (auto* n = std::get_if<Binary>(&slot->node)) dropNeutral(slot, *n);
    if (std::holds_alternative<Index>(slot->node)) nameComponent(slot);
  }

  /// `v[1]` of a vector is `v.y`, which later transforms know by its place.
  void nameComponent(ExprPtr& slot) {
    auto& n = std::get<Index>(slot->node);
    const Type vector = n.base->type;
    const auto component = evaluate(module_, *n.index, Constants::LookThrough);
    if (!vector.isVector() || !component || *component >= vector.width) return;
    ExprPtr base = std::move(n.base);
    slot = makeExpr(slot->type, Swizzle{std::move(base), {static_cast<std::uint8_t>(*component)}}, slot->loc);
  }

  /// `true && x` and `false || x`, either way round, are x.
  void dropNeutral(ExprPtr& slot, Binary& n) {
    if ((n.op != BinaryOp::LogicalAnd && n.op != BinaryOp::LogicalOr) || !slot->type.isScalar()) return;
    const std::uint32_t neutral = n.op == BinaryOp::LogicalAnd ? 1 : 0;
    if (evaluate(module_, *n.lhs, Constants::Keep) == neutral) return replace(slot, n.rhs);
    if (evaluate(module_, *n.rhs, Constants::Keep) == neutral) return replace(slot, n.lhs);
  }

  static void replace(ExprPtr& slot, ExprPtr& part) {
    ExprPtr kept = std::move(part);
    slot = std::move(kept);
  }

  /// Replaces statements whose condition is known by what they come to.
  void decide(Block& block) {
    Block result;
    for (Stmt& stmt : block) {
      forEachBlock(stmt, [&](Block& inner) { decide(inner); });
      if (auto* n = std::get_if<If>(&stmt.node)) {
        if (const auto cond = evaluate(module_, *n->cond, Constants::LookThrough)) {
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
    return loop.kind != LoopKind::DoWhile && loop.cond &&
           evaluate(module_, *loop.cond, Constants::LookThrough) == 0U;
  }

  /// In place where it declares nothing, else as a scope.
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

  Module& module_;
};

}  // namespace

void foldConstants(Module& module, Diagnostics&) { State(module).run(); }

}  // namespace skc
