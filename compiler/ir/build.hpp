// SPDX-License-Identifier: MIT
//
// Terse constructors of IR nodes, and copies of them. Constructors derive types from the operands and check nothing; `validate` checks
// what they build.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ir/ir.hpp"

namespace skc::ir {

// ---- expressions ------------------------------------------------------------------------------

ExprPtr makeExpr(Type type, Expr::Node node, Loc loc = {});

/// Literals of scalar type.
ExprPtr literal(float value, Loc loc = {});
ExprPtr literal(double value, Loc loc = {});
ExprPtr literal(std::int32_t value, Loc loc = {});
ExprPtr literal(std::uint32_t value, Loc loc = {});
ExprPtr literal(std::int64_t value, Loc loc = {});
ExprPtr literal(std::uint64_t value, Loc loc = {});
ExprPtr literal(bool value, Loc loc = {});
/// A float literal whose source text stands for the double `text`, of which `value` is the nearest float. A wide variant of
/// the kernel sees `text`, so that a text is rounded once in every precision.
ExprPtr literal(float value, double text, Loc loc = {});
/// The double that a float literal stands for: its text, or its float.
double wideValue(const Literal& literal);
/// `value` in a type that can represent it: a Literal for a scalar, a splat for a vector.
ExprPtr literalOf(Type type, int value, Loc loc = {});

ExprPtr varRef(const Function& function, VarId var, Loc loc = {});
ExprPtr constantRef(const Module& module, ConstantId constant, Loc loc = {});
ExprPtr unary(UnaryOp op, ExprPtr operand, Loc loc = {});
ExprPtr binary(BinaryOp op, ExprPtr lhs, ExprPtr rhs, Loc loc = {});
ExprPtr select(ExprPtr cond, ExprPtr yes, ExprPtr no, Loc loc = {});
/// Returns the operand itself if it has that component type already.
ExprPtr convert(Scalar scalar, ExprPtr operand, Loc loc = {});
ExprPtr construct(Type type, std::vector<ExprPtr> args, Loc loc = {});
/// Components by name: "x", "xyz", "bgr".
ExprPtr swizzle(ExprPtr base, std::string_view components, Loc loc = {});
/// These components, in this order.
ExprPtr swizzle(ExprPtr base, std::vector<std::uint8_t> components, Loc loc = {});
ExprPtr member(const Module& module, ExprPtr base, std::uint32_t field, Loc loc = {});
/// The member at the end of a path; the base itself if the path is empty.
ExprPtr member(const Module& module, ExprPtr base, const std::vector<std::uint32_t>& path, Loc loc = {});
ExprPtr index(const Module& module, ExprPtr base, ExprPtr index, Loc loc = {});
ExprPtr call(const Module& module, FunctionId callee, std::vector<ExprPtr> args, Loc loc = {});
/// The arguments must match one of the row's signatures.
ExprPtr intrinsic(Intrinsic intrinsic, std::vector<ExprPtr> args, Loc loc = {});
ExprPtr gatherRead(Type element, StreamRef stream, ExprPtr index, Loc loc = {});
ExprPtr neighborRead(Type element, StreamRef stream, ExprPtr offset, Loc loc = {});
ExprPtr indexOf(StreamRef stream, Loc loc = {});
ExprPtr extentOf(StreamRef stream, Loc loc = {});

/// The type of a binary operation on operands of these types.
Type binaryType(BinaryOp op, Type lhs, Type rhs);

/// Collects expressions into a list of arguments.
template <class... E>
std::vector<ExprPtr> exprs(E... items) {
  std::vector<ExprPtr> list;
  list.reserve(sizeof...(E));
  (list.push_back(std::move(items)), ...);
  return list;
}

/// The scalar expression for component `number` of `expr`, for transforms that want to inspect `int2(dx, dy + 1).y` without
/// handling vectors. Looks through constructors, swizzles and
/// componentwise operators, and otherwise swizzles a copy. A scalar is its own component, whatever the
/// number.
ExprPtr componentOf(const Expr& expr, std::uint8_t number);

/// The variable at the root of an lvalue.
VarId rootOf(const Expr& place);

ExprPtr clone(const Expr& expr);
ExprPtr clone(const ExprPtr& expr);  ///< null stays null

// ---- statements -------------------------------------------------------------------------------

Stmt declare(VarId var, ExprPtr init = nullptr, Loc loc = {});
Stmt assign(ExprPtr place, ExprPtr value, Loc loc = {});
Stmt assign(ExprPtr place, BinaryOp op, ExprPtr value, Loc loc = {});
Stmt callStmt(FunctionId callee, std::vector<ExprPtr> args, ExprPtr result = nullptr, Loc loc = {});
Stmt ifStmt(ExprPtr cond, Block then, Block otherwise = {}, Loc loc = {});
Stmt forLoop(Block init, ExprPtr cond, Block step, Block body, Loc loc = {});
Stmt whileLoop(ExprPtr cond, Block body, Loc loc = {});
Stmt doWhileLoop(Block body, ExprPtr cond, Loc loc = {});
Stmt switchStmt(ExprPtr value, std::vector<Case> cases, Loc loc = {});
Stmt breakStmt(Loc loc = {});
Stmt continueStmt(Loc loc = {});
Stmt returnStmt(ExprPtr value = nullptr, Loc loc = {});
Stmt scope(Block body, Loc loc = {});
Stmt push(StreamRef stream, ExprPtr value, Loc loc = {});
Stmt scatter(StreamRef stream, ScatterOp op, ExprPtr index, ExprPtr value, Loc loc = {});

/// Collects statements into a block.
template <class... S>
Block block(S... items) {
  Block list;
  list.reserve(sizeof...(S));
  (list.push_back(std::move(items)), ...);
  return list;
}

/// Inserts statements at the beginning of a block.
void prepend(Block& block, Block statements);

Stmt clone(const Stmt& stmt);
Block clone(const Block& block);

// ---- declarations -----------------------------------------------------------------------------

/// Adds a variable. Parameters (every role but Local) come before all locals.
VarId addVariable(Function& function, std::string name, Type type, VarRole role = VarRole::Local,
                  Loc loc = {});
/// The array type with this element and length; adds it to the module if it is not there yet.
Type arrayOf(Module& module, Type element, std::uint32_t length);
/// True if the type is or contains such a scalar, or a vector of them. Matrices do not count.
bool holds(const Module& module, Type type, Scalar scalar);
/// The number of scalars that a value of the type holds: nested arrays multiply.
std::uint64_t scalarCount(const Module& module, Type type);
/// Bytes of the scalars of a value in memory.
std::uint64_t memoryBytes(const Module& module, Type type);
/// The number of scalars before a field of a struct.
std::size_t scalarOffset(const Module& module, Type structType, std::uint32_t field);

Function clone(const Function& function);
KernelParam clone(const KernelParam& param);
/// A deep copy, for a back end that rewrites the module for itself.
Module clone(const Module& module);

}  // namespace skc::ir
