// SPDX-License-Identifier: MIT
//
// Visits every expression or statement below a node, const or not, so that transforms need not repeat the
// IR's structure. Only walk.cpp knows the operands and blocks of each node.
//
// Visits every type and every expression of a module, wherever one is stored. Transforms that renumber types,
// functions or constants use these functions, so that no reference keeps an old number. walk.cpp names
// all members of each declaration that holds any: a new member of such a struct does not compile until it is
// named there, too.
#pragma once

#include <cstddef>
#include <type_traits>

#include "ir/ir.hpp"
#include "support/function_ref.hpp"

namespace skc::ir {

/// `Node`, const if `Root` is.
template <class Root, class Node>
using Like = std::conditional_t<std::is_const_v<Root>, const Node, Node>;

/// A callback for each `Node` below a `Root`.
template <class Root, class Node>
using Visit = std::type_identity_t<FunctionRef<void(Like<Root, Node>&)>>;

/// Each function below takes a `T` or a `const T`.
template <class Root, class T>
concept MaybeConst = std::is_same_v<std::remove_const_t<Root>, T>;

/// The stream that an expression reads or queries, or that a statement writes; null if there is none.
StreamRef* streamOf(Expr& expr);
const StreamRef* streamOf(const Expr& expr);
StreamRef* streamOf(Stmt& stmt);

/// fn(slot) for every direct operand of an expression, in order; a slot is an ExprPtr.
template <MaybeConst<Expr> E>
void forEachOperand(E& expr, Visit<E, ExprPtr> fn);

/// fn(slot) for every expression in the statement itself, not in its blocks; no slot is null.
template <MaybeConst<Stmt> S>
void forEachOperand(S& stmt, Visit<S, ExprPtr> fn);

/// fn(block) for every block of a statement, in order.
template <MaybeConst<Stmt> S>
void forEachBlock(S& stmt, Visit<S, Block> fn);

/// fn(stmt) for every statement of a block and its inner blocks, outer statements first.
template <MaybeConst<Block> B>
void walkStmts(B& block, Visit<B, Stmt> fn);

/// fn(expr) for an expression and all its subexpressions, outer ones first.
template <MaybeConst<Expr> E>
void walkExprs(E& expr, Visit<E, Expr> fn);

/// The same for every expression in a block.
template <MaybeConst<Block> B>
void walkExprs(B& block, Visit<B, Expr> fn);

/// fn(slot) for an expression and all its subexpressions, inner ones first; fn may replace the expression.
void rewriteExprs(ExprPtr& slot, FunctionRef<void(ExprPtr&)> fn);

/// The same for every expression in a block.
void rewriteExprs(Block& block, FunctionRef<void(ExprPtr&)> fn);

/// fn(expr) for every expression: in functions, constants and kernels' parameters.
void walkExprs(Module& module, FunctionRef<void(Expr&)> fn);

/// fn(type) for the type of every expression and declaration, except members of structs and elements of arrays.
void walkTypes(Module& module, FunctionRef<void(Type&)> fn);

/// fn(type) for the types of all members of structs and of all elements of arrays.
void walkTypesInTypes(Module& module, FunctionRef<void(Type&)> fn);

/// Calls visit(id) for each kernel that the module has now, and for none that `visit` adds. Adding kernels invalidates
/// references to others.
template <class Visit>
void forEachDeclaredKernel(const Module& module, const Visit& visit) {
  const std::size_t declared = module.kernels.size();
  for (KernelId id = 0; id < declared; ++id) visit(id);
}

}  // namespace skc::ir
