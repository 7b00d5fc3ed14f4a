// SPDX-License-Identifier: MIT
//
// Visits every expression or statement below a node, const or not, so that transforms need not
// repeat the IR's shape. What a node's operands and blocks are is said here, once.
#pragma once

#include <type_traits>

#include "ir/ir.hpp"
#include "support/overloaded.hpp"

namespace skc::ir {

/// `Node`, const where `Root` is.
template <class Root, class Node>
using Like = std::conditional_t<std::is_const_v<Root>, const Node, Node>;

// clang-format off: one node a line

/// fn(slot) for every direct operand of an expression, in order; a slot is an ExprPtr.
template <class E, class Fn>
  requires std::is_same_v<std::remove_const_t<E>, Expr>
void forEachOperand(E& expr, Fn&& fn) {
  const auto each = [&](auto& list) {
    for (auto& slot : list) fn(slot);
  };
  match(
      expr.node, [](const Literal&) {}, [](const VarRef&) {}, [](const ConstantRef&) {},
      [&](Like<E, Unary>& n) { fn(n.operand); },
      [&](Like<E, Binary>& n) { fn(n.lhs), fn(n.rhs); },
      [&](Like<E, Select>& n) { fn(n.cond), fn(n.yes), fn(n.no); },
      [&](Like<E, Convert>& n) { fn(n.operand); },
      [&](Like<E, Construct>& n) { each(n.args); },
      [&](Like<E, Swizzle>& n) { fn(n.base); },
      [&](Like<E, Member>& n) { fn(n.base); },
      [&](Like<E, Index>& n) { fn(n.base), fn(n.index); },
      [&](Like<E, Call>& n) { each(n.args); },
      [&](Like<E, IntrinsicCall>& n) { each(n.args); },
      [&](Like<E, GatherRead>& n) { fn(n.index); },
      [&](Like<E, NeighborRead>& n) { fn(n.offset); },
      [&](Like<E, Sample>& n) { fn(n.position); },
      [](const IndexOf&) {}, [](const ExtentOf&) {});
}

/// fn(slot) for every expression that a statement itself holds (not those of its blocks); none is null.
template <class S, class Fn>
  requires std::is_same_v<std::remove_const_t<S>, Stmt>
void forEachOperand(S& stmt, Fn&& fn) {
  const auto optional = [&](auto& slot) {
    if (slot) fn(slot);
  };
  match(
      stmt.node, [&](Like<S, Declare>& n) { optional(n.init); },
      [&](Like<S, Assign>& n) { fn(n.place), fn(n.value); },
      [&](Like<S, CallStmt>& n) {
        for (auto& arg : n.args) fn(arg);
        optional(n.result);
      },
      [&](Like<S, If>& n) { fn(n.cond); },
      [&](Like<S, Loop>& n) { optional(n.cond); },
      [&](Like<S, Switch>& n) { fn(n.value); },
      [](const Break&) {}, [](const Continue&) {},
      [&](Like<S, Return>& n) { optional(n.value); },
      [](const Scope&) {},
      [&](Like<S, Push>& n) { fn(n.value), optional(n.mask); },
      [&](Like<S, Scatter>& n) { fn(n.index), fn(n.value), optional(n.mask); });
}

/// fn(block) for every block of a statement, in order.
template <class S, class Fn>
void forEachBlock(S& stmt, Fn&& fn) {
  match(
      stmt.node, [](const Declare&) {}, [](const Assign&) {}, [](const CallStmt&) {},
      [&](Like<S, If>& n) { fn(n.then), fn(n.otherwise); },
      [&](Like<S, Loop>& n) { fn(n.init), fn(n.step), fn(n.body); },
      [&](Like<S, Switch>& n) {
        for (auto& one : n.cases) fn(one.body);
      },
      [](const Break&) {}, [](const Continue&) {}, [](const Return&) {},
      [&](Like<S, Scope>& n) { fn(n.body); },
      [](const Push&) {}, [](const Scatter&) {});
}

// clang-format on

/// fn(stmt) for every statement of a block and its inner blocks, outer ones first.
template <class B, class Fn>
  requires std::is_same_v<std::remove_const_t<B>, Block>
void walkStmts(B& block, Fn&& fn) {
  for (auto& stmt : block) {
    fn(stmt);
    forEachBlock(stmt, [&](auto& inner) { walkStmts(inner, fn); });
  }
}

/// fn(expr) for an expression and all below it, outer ones first.
template <class E, class Fn>
  requires std::is_same_v<std::remove_const_t<E>, Expr>
void walkExprs(E& expr, Fn&& fn) {
  fn(expr);
  forEachOperand(expr, [&](auto& slot) { walkExprs(static_cast<Like<E, Expr>&>(*slot), fn); });
}

/// The same for every expression in a block.
template <class B, class Fn>
  requires std::is_same_v<std::remove_const_t<B>, Block>
void walkExprs(B& block, Fn&& fn) {
  walkStmts(block, [&](auto& stmt) {
    forEachOperand(stmt, [&](auto& slot) { walkExprs(static_cast<Like<B, Expr>&>(*slot), fn); });
  });
}

/// fn(slot) for an expression and all below it, inner ones first; it may put another expression there.
template <class Fn>
void rewriteExprs(ExprPtr& slot, Fn&& fn) {
  forEachOperand(*slot, [&](ExprPtr& operand) { rewriteExprs(operand, fn); });
  fn(slot);
}

/// The same for every expression in a block.
template <class Fn>
void rewriteExprs(Block& block, Fn&& fn) {
  walkStmts(block, [&](Stmt& stmt) { forEachOperand(stmt, [&](ExprPtr& slot) { rewriteExprs(slot, fn); }); });
}

}  // namespace skc::ir
