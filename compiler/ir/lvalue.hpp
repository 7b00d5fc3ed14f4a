// SPDX-License-Identifier: MIT
//
// Lvalues: a variable, or a member, element or component of an lvalue. Answers which part of a variable an
// lvalue names, whether two of them can share a number, and which variables statements change.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ir/ir.hpp"
#include "support/function_ref.hpp"

namespace skc::ir {

/// True for a VarRef, and for a Member, Index or Swizzle of an lvalue.
bool isLValue(const Expr& expr);

/// True unless statements may only read the variable: an input, a uniform, or what is declared const.
bool isAssignable(const Variable& variable);

/// True if the two lvalues certainly share no number. An index that is not a literal may name any element.
bool areDisjoint(const Module& module, const Expr& a, const Expr& b);

/// True if an expression reads one of the variables, which are in ascending order.
bool readsAny(const Expr& expr, const std::vector<VarId>& variables);

/// True if an index within the lvalue reads one of the variables, which are in ascending order. The variable at the
/// lvalue's root does not count.
bool hasIndexOf(const Expr& lvalue, const std::vector<VarId>& variables);

/// True if the function may read a number of the parameter `read` after it has written the same number by way of the
/// parameter `written`. If `sameObject`, the parameters stand for one object or for disjoint ones, as two lvalues of
/// one type do; otherwise they may overlap in any way, and any read after any write counts.
bool readsAfterWriting(const Module& module, const Function& function, VarId read, VarId written,
                       bool sameObject);

/// An lvalue that is known at compile time: members and at most one swizzle of a variable.
struct StaticLValue {
  VarId root;
  std::vector<std::uint32_t> members;  ///< path from the variable
  Type type;  ///< of the variable or member
  std::vector<std::uint8_t> components;  ///< selected components, in order; all if there is no swizzle

  /// Bit i is set for component i.
  unsigned mask() const;
  bool operator==(const StaticLValue&) const = default;
};

std::optional<StaticLValue> staticLValue(const Expr& expr);

// Finds the variables that statements change after their declaration: by assignments, as results of calls,
// and as arguments of InOut parameters.

/// fn(var) for each variable that the statement itself changes, not in its blocks; perhaps more than once.
void forEachAssigned(const Module& module, const Stmt& stmt, FunctionRef<void(VarId)> fn);

/// True if a statement of the block changes the variable.
bool assigns(const Module& module, const Block& block, VarId var);

/// The variables that the block's statements change, each once.
std::vector<VarId> assignedIn(const Module& module, const Block& block);

/// For each variable of the function, whether any of its statements changes it.
std::vector<bool> assignedVariables(const Module& module, const Function& function);

}  // namespace skc::ir
